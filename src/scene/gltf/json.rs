//! The container (GLB) and the JSON of a glTF file, read as tolerantly as other viewers do: what is not JSON by the letter but is
//! written by exporters (NaN, trailing commas, comments, raw control characters, bytes that are not UTF-8) is repaired.

use serde_json::Value;

use crate::scene::error::one_line;
use crate::scene::files::text_of;
use crate::scene::number;

/// Nesting from which a value counts as null: nothing that is drawn is nested so deeply, and the parser has a limit.
const MAX_DEPTH: usize = 100;
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;

/// A parsed file.
#[derive(Debug)]
pub struct Container {
    pub json: Value,
    /// The binary chunk of a GLB.
    pub binary: Option<Vec<u8>>,
}

/// Splits and parses a file, whether its name ends with `.gltf` or `.glb`.
pub fn read(bytes: &[u8]) -> Result<Container, String> {
    if !bytes.starts_with(b"glTF") {
        let json = parse(bytes)?;
        return Ok(Container { json, binary: None });
    }
    if word(bytes, 4) == Some(1) {
        return Err(super::OLD_VERSION.to_owned());
    }
    let json = chunk(bytes, JSON_CHUNK).ok_or("a GLB without a JSON chunk; export it again")?;
    Ok(Container {
        json: parse(json)?,
        binary: chunk(bytes, BINARY_CHUNK).map(<[u8]>::to_vec),
    })
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(word.try_into().ok()?))
}

/// The first chunk of a type; one that is cut off ends with the file.
fn chunk(bytes: &[u8], wanted: u32) -> Option<&[u8]> {
    let mut at = 12usize;
    loop {
        let (length, kind) = (word(bytes, at)? as usize, word(bytes, at + 4)?);
        let start = at + 8;
        let end = start.saturating_add(length).min(bytes.len());
        if kind == wanted {
            return Some(&bytes[start..end]);
        }
        at = end;
    }
}

/// Parses JSON; repairs it if that fails.
pub fn parse(bytes: &[u8]) -> Result<Value, String> {
    let padding = |byte: &u8| byte.is_ascii_whitespace() || *byte == 0;
    let end = bytes.iter().rposition(|byte| !padding(byte));
    let plain = &bytes[..end.map_or(0, |end| end + 1)];
    let plain = plain.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(plain);
    if let Ok(value) = serde_json::from_slice(plain) {
        return Ok(value);
    }
    let repaired =
        Repair::of(text_of(bytes).trim_end_matches(|c: char| c.is_whitespace() || c == '\0'));
    serde_json::from_str(&repaired).map_err(|error| {
        let what = one_line(&error.to_string());
        format!("no glTF that can be read ({what}); export it again")
    })
}

/// Copies a text and repairs what is not JSON.
#[derive(Debug, Default)]
struct Repair {
    out: String,
    depth: usize,
    /// Length of `out` where the first value nested too deeply begins.
    too_deep: Option<usize>,
}

impl Repair {
    fn of(text: &str) -> String {
        let mut repair = Self::default();
        let mut rest = text;
        while let Some(letter) = rest.chars().next() {
            rest = match letter {
                '"' => repair.string(&rest[1..]),
                '/' => comment(rest),
                '{' | '[' => repair.open(letter, rest),
                '}' | ']' => repair.close(letter, rest),
                ',' | ':' => {
                    repair.out.push(letter);
                    &rest[1..]
                }
                _ if letter.is_whitespace() => &rest[letter.len_utf8()..],
                _ => repair.literal(rest),
            };
        }
        repair.out
    }

    fn open<'t>(&mut self, letter: char, rest: &'t str) -> &'t str {
        self.depth += 1;
        if self.depth > MAX_DEPTH && self.too_deep.is_none() {
            self.too_deep = Some(self.out.len());
        }
        self.out.push(letter);
        &rest[1..]
    }

    fn close<'t>(&mut self, letter: char, rest: &'t str) -> &'t str {
        if self.out.ends_with(',') {
            self.out.pop();
        }
        self.out.push(letter);
        if let Some(start) = self.too_deep.filter(|_| self.depth == MAX_DEPTH + 1) {
            self.out.truncate(start);
            self.out.push_str("null");
            self.too_deep = None;
        }
        self.depth = self.depth.saturating_sub(1);
        &rest[1..]
    }

    /// A word that is neither a string nor punctuation: a number in any spelling, or null if it is none.
    fn literal<'t>(&mut self, rest: &'t str) -> &'t str {
        let is_end = |c: char| c.is_whitespace() || "{}[],:\"".contains(c);
        let end = rest.find(is_end).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        let is_json = serde_json::from_str::<Value>(word).is_ok();
        let read = number::parse(word).filter(|value| value.is_finite());
        match read {
            _ if is_json => self.out.push_str(word),
            Some(value) => self.out.push_str(&format!("{value:e}")),
            None => self.out.push_str("null"),
        }
        rest
    }

    /// The rest of a string after its opening quotation mark.
    fn string<'t>(&mut self, mut rest: &'t str) -> &'t str {
        self.out.push('"');
        while let Some(letter) = rest.chars().next() {
            let tail = &rest[letter.len_utf8()..];
            rest = match letter {
                '"' => {
                    self.out.push('"');
                    return tail;
                }
                '\\' => self.escape(tail),
                _ if letter.is_control() => {
                    self.out.push_str(&format!("\\u{:04x}", letter as u32));
                    tail
                }
                _ => {
                    self.out.push(letter);
                    tail
                }
            };
        }
        rest
    }

    /// An escape after its backslash: copied if it is one, otherwise the backslash is meant.
    fn escape<'t>(&mut self, rest: &'t str) -> &'t str {
        let code = rest.strip_prefix('u').and_then(|hex| hex.get(..4));
        let code = code.and_then(|hex| u32::from_str_radix(hex, 16).ok());
        match (rest.chars().next(), code) {
            // Half of a pair: whether the other half follows is left to a second look at both.
            (_, Some(0xD800..=0xDFFF)) => {
                let pair = rest.get(..11).filter(|pair| is_pair(pair));
                let length = pair.map_or(5, str::len);
                let text = pair.map_or("\u{FFFD}".to_owned(), |pair| format!("\\{pair}"));
                self.out.push_str(&text);
                &rest[length..]
            }
            (_, Some(_)) => {
                self.out.push('\\');
                self.out.push_str(&rest[..5]);
                &rest[5..]
            }
            (Some(letter), _) if "\"\\/bfnrt".contains(letter) => {
                self.out.push('\\');
                self.out.push(letter);
                &rest[1..]
            }
            _ => {
                self.out.push_str("\\\\");
                rest
            }
        }
    }
}

/// Whether `uD83D\uDE00` and the like is one character.
fn is_pair(text: &str) -> bool {
    serde_json::from_str::<String>(&format!("\"\\{text}\"")).is_ok()
}

/// The text after a comment, or after a stray slash.
fn comment(rest: &str) -> &str {
    if rest.starts_with("//") {
        return rest.find('\n').map_or("", |end| &rest[end..]);
    }
    match rest.strip_prefix("/*") {
        Some(inner) => inner.split_once("*/").map_or("", |(_, tail)| tail),
        None => &rest[1..],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_exporters_write_is_read() {
        for (text, expected) in [
            (r#"{"a":[NaN,-Infinity,1,],}"#, r#"{"a":[null,null,1]}"#),
            ("{\"a\":\"b\tc\"} \0\0", r#"{"a":"b\tc"}"#),
            ("\u{feff}{\"a\": .5, \"b\": 1.}", r#"{"a":0.5,"b":1.0}"#),
            (r#"{"a":"C:\models\x"}"#, r#"{"a":"C:\\models\\x"}"#),
            (r#"{"a":"\ud800 \ud83d\ude00"}"#, r#"{"a":"� 😀"}"#),
            ("{/* who */\"a\":1 // what\n}", r#"{"a":1}"#),
            (r#"{"a":1e999,"b":-nan(ind)}"#, r#"{"a":null,"b":null}"#),
        ] {
            let value = parse(text.as_bytes()).expect(text);
            let wanted: Value = serde_json::from_str(expected).expect(expected);
            assert_eq!(value, wanted, "{text}");
        }
        let latin = parse(b"{\"a\":\"caf\xE9\"}").expect("not UTF-8");
        assert_eq!(latin["a"], "café");
    }

    #[test]
    fn deep_values_become_null_and_nonsense_fails_in_one_line() {
        let deep = format!("{{\"a\":{}1{}}}", "[".repeat(9000), "]".repeat(9000));
        let value = parse(deep.as_bytes()).expect("repaired");
        assert!(value["a"].is_array());
        for bad in ["", "{", "{\"a\"", "]", "{\"a\":<html", "\u{0}\u{0}"] {
            let error = parse(bad.as_bytes()).expect_err(bad);
            assert!(error.len() < 150 && error.lines().count() == 1, "{error}");
        }
    }

    #[test]
    fn chunks_are_found_even_if_cut_off() {
        let mut file = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        for (kind, bytes) in [(b"JUNK", &b"1234"[..]), (b"JSON", b"{}  ")] {
            file.extend((bytes.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(bytes);
        }
        file.extend(99u32.to_le_bytes());
        file.extend(b"BIN\0abc");
        let read = read(&file).expect("a container");
        assert_eq!(read.binary.as_deref(), Some(&b"abc"[..]));
        assert!(super::read(b"glTF\x01\0\0\0").is_err());
    }
}
