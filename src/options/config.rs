//! The user's file of defaults: options by name, as on the command line.

use toml::{Table, Value};

use super::{DEFINITION, OptionValues, OptionsError, is_flag};
use crate::scene::option_text;

/// Options that belong to one picture, or that find the file.
const REFUSED: [&str; 6] = ["camera", "config", "eye", "moment", "preset", "target"];

/// Reads the defaults from the text of a file: lines such as `place = "copenhagen"`, `size = "1920x1080"`, `quiet = true`.
///
/// # Errors
/// The line of a key that is none, of a value that its option refuses, or of what is no TOML; two options that conflict.
pub fn read_config(text: &str) -> Result<OptionValues, OptionsError> {
    let table: Table = text.parse().map_err(|error: toml::de::Error| {
        let before = error.span().and_then(|span| text.get(..span.start));
        let line = before.unwrap_or_default().matches('\n').count() + 1;
        let what: Vec<&str> = error.message().split_whitespace().collect();
        OptionsError(format!("line {line} is no TOML: {}", what.join(" ")))
    })?;
    let mut values = OptionValues::default();
    for (key, value) in &table {
        let written = checked(key, value);
        let written = written.map_err(|what| OptionsError(at_line(text, key, &what)))?;
        values.set(key, written);
    }
    values.check()?;
    Ok(values)
}

/// The value as it would be typed, if the option takes it.
fn checked(key: &str, value: &Value) -> Result<String, String> {
    if value.is_table() {
        return Err(format!(
            "[{key}] is a table; write options without tables, as size = \"1920x1080\""
        ));
    }
    if REFUSED.contains(&key) {
        return Err(format!(
            "\"{key}\" has no default of yours; give it on the command line, or in a scene file"
        ));
    }
    let known = || DEFINITION.get_arguments().filter_map(|arg| arg.get_long());
    if !known().any(|name| name == key) {
        let near = known().max_by(|a, b| likeness(a, key).total_cmp(&likeness(b, key)));
        let near = near.filter(|name| likeness(name, key) > 0.75);
        let hint = near.map_or(String::new(), |name| format!("write \"{name}\", or "));
        return Err(format!(
            "unknown option \"{key}\"; {hint}see skylight render --help"
        ));
    }
    let text = match value {
        Value::Boolean(is_set) if is_flag(key) => is_set.to_string(),
        _ if is_flag(key) => return Err(format!("{key} must be true or false")),
        value => option_text(key, value)?,
    };
    let alone = OptionValues::from(vec![(key.to_owned(), text.clone())]);
    alone.check().map_err(|error| error.0)?;
    Ok(text)
}

fn likeness(name: &str, other: &str) -> f64 {
    strsim::jaro_winkler(name, other)
}

/// The message with the line on which the key stands.
fn at_line(text: &str, key: &str, what: &str) -> String {
    let is_key = |line: &str| {
        let line = line.trim_start().trim_start_matches(['[', '"', '\'']);
        let rest = line.strip_prefix(key);
        rest.is_some_and(|rest| rest.starts_with([' ', '=', ']', '"', '\'', '.', '\t']))
    };
    let line = text.lines().position(is_key);
    line.map_or(what.to_owned(), |at| format!("line {}: {what}", at + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::tests::{exposed_scene, scene};
    use crate::options::{Options, SunInput};

    #[test]
    fn defaults_are_below_scene_and_preset() {
        let config = "place = [55.68, 12.57]\nev100 = 14\nturbidity = 4\nquiet = true\n";
        let config = read_config(config).expect("defaults");
        let user = OptionValues::from(vec![("turbidity".to_owned(), "5".to_owned())]);
        let user = user.with_defaults(config);
        let options = Options::resolve(&user, &exposed_scene()).expect("options");
        assert_eq!((options.ev100, options.turbidity), (Some(11.0), Some(5.0)));
        assert!(options.quiet && user.alone().expect("options").quiet);
        let SunInput::Place { latitude, .. } = options.sun else {
            panic!("{:?}", options.sun);
        };
        assert_eq!(latitude, 55.68);
        // The command line has what the program would not take by itself.
        let line = options
            .command_line(None, &exposed_scene())
            .expect("a line");
        assert!(line.contains("--place 55.68,12.57"), "{line}");
        let mut lecture = user.clone();
        lecture.set("preset", "lecture");
        let options = Options::resolve(&lecture, &scene(&[])).expect("options");
        assert!(
            matches!(options.sun, SunInput::Solar { .. }),
            "{:?}",
            options.sun
        );
        // A direction of the sun takes the place of the default place.
        let mut sun = user.clone();
        sun.set("sun", "180,40");
        Options::resolve(&sun, &scene(&[])).expect("options");
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, line, part) in [
            ("# mine\nsiez = \"4x3\"\n", "line 2: ", "write \"size\", or"),
            ("zzz = 1", "line 1: ", "unknown option \"zzz\""),
            ("size = \"4\"", "line 1: ", "WIDTHxHEIGHT"),
            ("quiet = 1", "line 1: ", "true or false"),
            ("\n\ncamera = \"a\"", "line 3: ", "on the command line"),
            ("[sky]\nturbidity = 2", "line 1: ", "without tables"),
            ("size = [", "line 1 is no TOML", ""),
            ("aod = 0.1\nturbidity = 3", "", "cannot be used with"),
        ] {
            let error = read_config(text).expect_err(text).0;
            assert!(
                error.starts_with(line) && error.contains(part),
                "{text}: {error}"
            );
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
