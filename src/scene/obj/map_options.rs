//! Options of the `map_..` statements of MTL files.

use crate::scene::number;
use crate::scene::texture::picture::Channel;

/// Options of a `map_..` statement. `-blendu`, `-blendv`, `-t`, `-type` and unknown options are ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapOptions {
    /// `-s`: factor on the texture coordinates.
    pub scale: [f32; 2],
    /// `-o`: offset of the texture coordinates, applied after the scale.
    pub offset: [f32; 2],
    /// `-bm`: factor on the heights of a bump map.
    pub bump: f32,
    /// `-imfchan`: channel used as a mask.
    pub channel: Channel,
    /// `-clamp on`: nothing repeats outside of the picture.
    pub clamp: bool,
    /// `-mm` with another base than 0 or gain than 1: other colours, which are not drawn.
    pub has_gain: bool,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self {
            scale: [1.0; 2],
            offset: [0.0; 2],
            bump: 1.0,
            channel: Channel::Automatic,
            clamp: false,
            has_gain: false,
        }
    }
}

/// Options that may also follow the file name.
const TRAILING_OPTIONS: [&str; 10] = [
    " -bm ",
    " -o ",
    " -s ",
    " -t ",
    " -imfchan ",
    " -clamp ",
    " -blendu ",
    " -blendv ",
    " -mm ",
    " -texres ",
];

/// Splits the arguments into the file name (possibly with spaces) and the options, which exporters write in either order.
pub fn map_options(rest: &str) -> (&str, MapOptions) {
    let mut options = MapOptions::default();
    let rest = options.take_leading(rest.trim());
    let end = TRAILING_OPTIONS.iter().filter_map(|o| rest.find(o)).min();
    let (name, mut trailing) = rest.split_at(end.unwrap_or(rest.len()));
    // Here the arguments of the last option end the line.
    while let Some((option, tail)) = option_word(trailing.trim_start()) {
        trailing = options.take(option, tail, true);
    }
    (name.trim().trim_matches('"'), options)
}

fn option_word(rest: &str) -> Option<(&str, &str)> {
    let (word, tail) = rest.split_once(char::is_whitespace)?;
    let letters = word.strip_prefix('-')?;
    (!letters.is_empty() && letters.chars().all(char::is_alphabetic))
        .then_some((letters, tail.trim_start()))
}

impl MapOptions {
    fn take_leading<'a>(&mut self, mut rest: &'a str) -> &'a str {
        while let Some((option, tail)) = option_word(rest) {
            rest = self.take(option, tail, false);
        }
        rest
    }

    /// Parses the arguments of an option; returns the remaining text. With `last`, the arguments may end the line.
    fn take<'a>(&mut self, option: &str, tail: &'a str, last: bool) -> &'a str {
        let numbers_only = matches!(option, "o" | "s" | "t");
        let most = match option {
            "o" | "s" | "t" => 3,
            "mm" => 2,
            _ => 1,
        };
        let (mut rest, mut arguments) = (tail, [""; 3]);
        for argument in arguments.iter_mut().take(most) {
            let (word, tail) = match rest.split_once(char::is_whitespace) {
                Some(both) => both,
                None if last => (rest, ""),
                // The last word is always the file name.
                None => break,
            };
            if numbers_only && number::parse(word).is_none() {
                break;
            }
            (*argument, rest) = (word, tail.trim_start());
        }
        self.set(option, arguments);
        rest
    }

    fn set(&mut self, option: &str, arguments: [&str; 3]) {
        let number = |i: usize| {
            let value = number::parse(arguments[i]).map(|v| v as f32);
            value.filter(|v| v.is_finite() && v.abs() < 1e6)
        };
        match option {
            // A missing second number defaults to scale 1, offset 0.
            "s" => {
                let u = number(0).unwrap_or(1.0);
                self.scale = [u, number(1).unwrap_or(1.0)];
            }
            "o" => self.offset = [number(0).unwrap_or(0.0), number(1).unwrap_or(0.0)],
            "bm" => self.bump = number(0).unwrap_or(1.0),
            "clamp" => self.clamp = arguments[0].eq_ignore_ascii_case("on"),
            "mm" => self.has_gain = [number(0), number(1)] != [Some(0.0), Some(1.0)],
            "imfchan" => self.channel = channel(arguments[0]),
            _ => {}
        }
    }
}

fn channel(word: &str) -> Channel {
    match word {
        "r" => Channel::Number(0),
        "g" => Channel::Number(1),
        "b" => Channel::Number(2),
        "m" => Channel::Number(3),
        _ => Channel::Automatic,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_are_found_among_options() {
        for (line, name) in [
            ("wood.png", "wood.png"),
            ("texture 01.png", "texture 01.png"),
            ("-s 0.1 0.2 specular.jpg", "specular.jpg"),
            ("-o 0.1 diffuse.jpg", "diffuse.jpg"),
            ("-t 0.1 0.2 0.3 a b.jpg", "a b.jpg"),
            ("-colorspace sRGB -o 0.1 d.jpg", "d.jpg"),
            ("-imfchan r bump.jpg -bm 1.5", "bump.jpg"),
            ("-mm 0.1 0.3 s.jpg", "s.jpg"),
            ("-type cube_top s.jpg", "s.jpg"),
            ("-s 1 1 1 2", "2"),
            ("\"quoted name.png\"", "quoted name.png"),
            ("-bm", "-bm"),
        ] {
            assert_eq!(map_options(line).0, name, "{line}");
        }
    }

    #[test]
    fn options_count_before_and_after_the_name() {
        let options = |line| map_options(line).1;
        assert_eq!(options("-s 2 3 1 -o 0.5 0.25 a.png").scale, [2.0, 3.0]);
        assert_eq!(options("-s 2 3 1 -o 0.5 0.25 a.png").offset, [0.5, 0.25]);
        assert_eq!(options("-imfchan g a b.png -bm 1.5").bump, 1.5);
        assert_eq!(options("-imfchan g a.png").channel, Channel::Number(1));
        assert_eq!(options("-s nan 1e30 a.png").scale, [1.0, 1.0]);
        assert_eq!(options("a.png"), MapOptions::default());
        assert!(options("-clamp on a.png").clamp && !options("-clamp off a.png").clamp);
        assert!(options("-mm 0.1 2 a.png").has_gain && !options("-mm 0 1 a.png").has_gain);
    }
}
