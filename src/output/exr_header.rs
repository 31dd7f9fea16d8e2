//! The order of attributes in the head of an EXR file. The library that writes them keeps them in no order, so that the same picture would have
//! other bytes each time.

/// Longest head, bytes: some hundred parameters, among them the command line.
pub(super) const LONGEST: usize = 1 << 20;

/// Magic number and version.
const START: usize = 8;

/// Sorts the attributes by name. The head keeps its length, so that all that follows keeps its place. Bytes that are no head of a file with one part
/// stay as they are.
pub(super) fn sort(bytes: &mut [u8]) {
    let Some((mut attributes, end)) = attributes(bytes) else {
        return;
    };
    attributes.sort();
    let sorted: Vec<u8> = attributes.concat();
    bytes[START..end].copy_from_slice(&sorted);
}

/// The attributes, each with its name, type, size and value; and where they end.
fn attributes(bytes: &[u8]) -> Option<(Vec<Vec<u8>>, usize)> {
    let (mut found, mut at) = (Vec::new(), START);
    while *bytes.get(at)? != 0 {
        let name = at + text(&bytes[at..])?;
        let size_at = name + text(bytes.get(name..)?)?;
        let size = bytes.get(size_at..size_at + 4)?;
        let size = u32::from_le_bytes([size[0], size[1], size[2], size[3]]) as usize;
        let end = (size_at + 4).checked_add(size)?;
        found.push(bytes.get(at..end)?.to_vec());
        at = end;
    }
    Some((found, at))
}

/// Length of a text with the zero at its end.
fn text(bytes: &[u8]) -> Option<usize> {
    Some(bytes.iter().position(|b| *b == 0)? + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_sorted_and_the_rest_stays() {
        let attribute = |name: &str, value: &[u8]| {
            let size = (value.len() as u32).to_le_bytes();
            [name.as_bytes(), b"\0string\0", &size, value].concat()
        };
        let [a, b, c] =
            [("a", &b"1"[..]), ("b", b"two\0"), ("c", b"")].map(|(n, v)| attribute(n, v));
        let file = |list: [&Vec<u8>; 3]| {
            [
                b"12345678".to_vec(),
                list.map(Clone::clone).concat(),
                b"\0rest".to_vec(),
            ]
            .concat()
        };
        let mut bytes = file([&c, &a, &b]);
        sort(&mut bytes);
        assert_eq!(bytes, file([&a, &b, &c]));
        for end in 0..bytes.len() - 5 {
            let mut cut = file([&c, &a, &b])[..end].to_vec();
            let before = cut.clone();
            sort(&mut cut);
            assert_eq!(cut, before, "{end}");
        }
    }
}
