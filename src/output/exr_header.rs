//! The attributes of an EXR file in the order of their names: the crate that writes them has them in another one each time, and the same
//! picture should have the same bytes.
//!
//! OpenEXR, "File Layout": magic number and version, then attributes (name and type, each with a zero byte, the length and the value), a
//! zero byte, and the table of offsets. They stay right, since the header keeps its length.

use std::io::{Read, Seek, SeekFrom, Write};

/// Magic number and version.
const PREFIX: usize = 8;
/// Longest header that is looked at, bytes.
const MOST: u64 = 1 << 24;

/// Sorts the attributes of a file with one part. Bytes that are no such file stay as they are.
pub(super) fn sort_attributes(file: &mut (impl Read + Write + Seek)) -> std::io::Result<()> {
    file.seek(SeekFrom::Start(0))?;
    let (mut start, mut wanted) = (Vec::new(), 1 << 16);
    let sorted = loop {
        let missing = wanted - start.len() as u64;
        let read = Read::take(&mut *file, missing).read_to_end(&mut start)?;
        match sorted(&start) {
            Some(sorted) => break sorted,
            None if read == 0 || wanted >= MOST => return Ok(()),
            None => wanted *= 2,
        }
    };
    file.seek(SeekFrom::Start(PREFIX as u64))?;
    file.write_all(&sorted)
}

/// The attributes in the order of their names; `None` if the header is not all there.
fn sorted(file: &[u8]) -> Option<Vec<u8>> {
    let header = file.get(PREFIX..)?;
    let mut attributes = Vec::new();
    let mut at = 0;
    while *header.get(at)? != 0 {
        let word = |from: usize| Some(from + header.get(from..)?.iter().position(|b| *b == 0)? + 1);
        let end_of_type = word(word(at)?)?;
        let length = header.get(end_of_type..end_of_type + 4)?;
        let length = u32::from_le_bytes(length.try_into().ok()?);
        let end = end_of_type + 4 + length as usize;
        attributes.push(header.get(at..end)?);
        at = end;
    }
    attributes.sort_unstable();
    Some(attributes.concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn attribute(name: &str, value: &[u8]) -> Vec<u8> {
        let length = (value.len() as u32).to_le_bytes();
        [name.as_bytes(), b"\0string\0", &length, value].concat()
    }

    #[test]
    fn attributes_are_sorted_and_nothing_else_moves() {
        let [a, b, c] =
            [("a", &[0; 70_000][..]), ("b", b"2"), ("c", b"")].map(|(n, v)| attribute(n, v));
        let file =
            |list: [&[u8]; 3]| [b"magic..!", list.concat().as_slice(), b"\0offsets"].concat();
        let mut bytes = Cursor::new(file([&c, &a, &b]));
        sort_attributes(&mut bytes).expect("sorted");
        assert!(bytes.into_inner() == file([&a, &b, &c]));
        for cut in [0, 5, 30, 70_010] {
            let part = file([&c, &a, &b])[..cut].to_vec();
            let mut bytes = Cursor::new(part.clone());
            sort_attributes(&mut bytes).expect("left");
            assert!(bytes.into_inner() == part, "{cut}");
        }
    }
}
