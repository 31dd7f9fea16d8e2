//! `--vary`: the same command with other values of some of its options.

use std::ffi::OsString;
use std::str::FromStr;

use crate::options::decides_light;

use super::DaylightArgs;

/// Most variants of a study.
const MOST_VARIANTS: usize = 10_000;

/// An option, or its number for a material (`glass.roof`), and the values that it takes in turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Vary {
    /// Name of the option without dashes, and of the material after a dot.
    pub name: String,
    /// Texts of the values.
    pub values: Vec<String>,
}

impl FromStr for Vary {
    type Err = String;

    /// `turbidity=2,3,4`; values that hold commas are separated by semicolons.
    fn from_str(text: &str) -> Result<Self, String> {
        let form = || "write an option and its values, for instance turbidity=2,3,4".to_owned();
        // The name of a material may hold the sign.
        let (name, list) = text.rsplit_once('=').ok_or_else(form)?;
        let name = name.trim().trim_start_matches('-').to_owned();
        let separator = if list.contains(';') { ';' } else { ',' };
        let values: Vec<String> = list.split(separator).map(|v| v.trim().into()).collect();
        if name.is_empty() || values.iter().any(String::is_empty) {
            return Err(form());
        }
        let mut seen: Vec<&String> = Vec::new();
        for value in &values {
            if seen.contains(&value) {
                return Err(format!("{name} is {value} twice; leave one out"));
            }
            seen.push(value);
        }
        Ok(Self { name, values })
    }
}

impl Vary {
    /// The option whose values these are.
    pub fn option(&self) -> &str {
        self.material().map_or(&self.name, |(option, _)| option)
    }

    /// The option and the material, where it is the number of one.
    fn material(&self) -> Option<(&str, &str)> {
        let parts = self.name.split_once('.')?;
        OF_MATERIALS.contains(&parts.0).then_some(parts)
    }
}

/// Options that take numbers by materials.
const OF_MATERIALS: [&str; 2] = ["glass", "reflectance"];

/// What decides a number in every case.
const ALWAYS: [&str; 12] = [
    "plane",
    "spacing",
    "inset",
    "offset",
    "weather",
    "glass",
    "reflectance",
    "ground-albedo",
    "bounces",
    "seed",
    "up",
    "unit",
];

/// What decides a year besides.
const OF_A_YEAR: [&str; 2] = ["schedule", "blinds"];

/// What decides the hours of sun where no weather file does.
const OF_THE_SUN: [&str; 2] = ["place", "when"];

/// What decides a moment, besides the options of sun and sky.
const OF_A_MOMENT: [&str; 3] = ["hour", "moment", "emission-scale"];

/// Options of sun and sky that decide nothing at sensors.
const OF_PICTURES: [&str; 3] = ["irradiance", "irradiance-samples", "stars"];

/// A variant.
pub(super) struct Chosen {
    /// Its values, in the order of the options.
    pub values: Vec<String>,
    /// The words that it has besides.
    pub words: Vec<String>,
}

/// What `--vary` of the words of `skylight daylight` asks for, in their order. What is no such option and list is left to clap.
pub(super) fn asked(words: &[OsString]) -> Vec<Vary> {
    let texts: Vec<&str> = words.iter().filter_map(|word| word.to_str()).collect();
    if texts.get(1) != Some(&"daylight") {
        return Vec::new();
    }
    let value = |(at, text): (usize, &&str)| match text.strip_prefix("--vary") {
        Some("") => texts.get(at + 1).copied().map(str::to_owned),
        Some(rest) => rest.strip_prefix('=').map(str::to_owned),
        None => None,
    };
    let values = texts.iter().enumerate().filter_map(value);
    values.filter_map(|text| text.parse().ok()).collect()
}

/// Fails if an option decides no number of what these arguments, those of a variant, ask for.
pub(super) fn check(list: &[Vary], args: &DaylightArgs) -> Result<(), String> {
    let is_year = args.asks_for_metrics();
    let has_weather = args.weather.is_some();
    let decides_moment =
        |name| OF_A_MOMENT.contains(&name) || (decides_light(name) && !OF_PICTURES.contains(&name));
    let is_right = |option| {
        ALWAYS.contains(&option)
            || (is_year && has_weather && OF_A_YEAR.contains(&option))
            || (is_year && !has_weather && OF_THE_SUN.contains(&option))
            || (!is_year && decides_moment(option))
    };
    let Some(vary) = list.iter().find(|vary| !is_right(vary.option())) else {
        return Ok(());
    };
    let (what, more) = match (is_year, has_weather) {
        (true, true) => ("over the year of a weather file", OF_A_YEAR.join(", ")),
        (true, false) => ("without a weather file", OF_THE_SUN.join(", ")),
        (false, _) => (
            "at a moment",
            "hour, emission-scale, and the options of sun and sky".to_owned(),
        ),
    };
    Err(format!(
        "--vary {}: it changes no number {what}; choose of {}, {more}",
        vary.name,
        ALWAYS.join(", ")
    ))
}

/// The values of each variant, in their order, the last option changing from one to the next, and the words that it has besides.
///
/// # Errors
/// One line: an option that is there twice or is given besides, or too many variants.
pub(super) fn variants(
    list: &[Vary],
    is_given: impl Fn(&str) -> bool,
) -> Result<Vec<Chosen>, String> {
    for (at, vary) in list.iter().enumerate() {
        let option = vary.option();
        if is_given(option) {
            return Err(format!("--{option} is given and varied; leave one out"));
        }
        let clashes = |other: &Vary| {
            other.name == vary.name
                || (other.option() == option
                    && (other.material().is_none() || vary.material().is_none()))
        };
        if list[..at].iter().any(clashes) {
            return Err(format!("--vary {option} is given twice; leave one out"));
        }
    }
    let counts = list.iter().map(|vary| vary.values.len());
    let count = counts.fold(1_usize, usize::saturating_mul);
    if count > MOST_VARIANTS {
        return Err(format!(
            "--vary asks for {count} variants; {MOST_VARIANTS} are possible"
        ));
    }
    let mut all: Vec<Vec<String>> = vec![Vec::new()];
    for vary in list {
        let with = |chosen: &Vec<String>| {
            let (chosen, values) = (chosen.clone(), vary.values.iter());
            values.map(move |value| [&chosen[..], std::slice::from_ref(value)].concat())
        };
        all = all.iter().flat_map(with).collect();
    }
    let with_words = |values: Vec<String>| Chosen {
        words: words(list, &values),
        values,
    };
    Ok(all.into_iter().map(with_words).collect())
}

/// The words of a variant: the numbers of materials of one option are one word.
fn words(list: &[Vary], values: &[String]) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for (vary, value) in list.iter().zip(values) {
        let Some((option, material)) = vary.material() else {
            words.push(format!("--{}={value}", vary.name));
            continue;
        };
        let start = format!("--{option}=");
        match words.iter_mut().find(|word| word.starts_with(&start)) {
            Some(word) => *word += &format!(",{material}={value}"),
            None => words.push(format!("{start}{material}={value}")),
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::super::{CliExit, Command, parse};
    use super::*;

    /// Values, arguments, options.
    type Read = (Vec<String>, DaylightArgs, String);

    /// Each variant of a line.
    fn read(line: &str) -> Result<Vec<Read>, String> {
        let words = format!("skylight daylight m.obj --plane 0.8 {line}");
        match parse(words.split_whitespace().map(Into::into)) {
            Ok(Command::Daylight { variants, .. }) => Ok(variants
                .into_iter()
                .map(|v| (v.values, v.args, format!("{:?}", v.options)))
                .collect()),
            Err(CliExit::Usage(text)) => Err(text),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn variants_are_the_product_of_the_values() {
        let all = read("--vary turbidity=2,3 --vary glass=.6,.7,.8").expect("variants");
        let values: Vec<String> = all.iter().map(|(values, ..)| values.join(" ")).collect();
        let expected = ["2 .6", "2 .7", "2 .8", "3 .6", "3 .7", "3 .8"];
        assert_eq!(values, expected);
        assert!(all[4].2.contains("(\"turbidity\", \"3\")"), "{}", all[4].2);
        assert!(all.iter().all(|(_, args, _)| args.vary.len() == 2));
        assert!(read("").expect("none").is_empty());
    }

    #[test]
    fn materials_and_arguments_vary_too() {
        let line = "--weather a.epw --vary reflectance.floor=0.2,0.4 --vary reflectance.a=b=0.5 --vary blinds=none,lm83";
        let all = read(line).expect("variants");
        assert_eq!(all.len(), 4);
        let (_, args, options) = &all[3];
        assert!(options.contains("\"floor=0.4,a=b=0.5\""), "{options}");
        assert_eq!(args.blinds, crate::daylight::metrics::Blinds::Lm83);
        let suns = read("--vary sun=180,40;180,50").expect("suns");
        assert_eq!(suns[1].0, ["180,50"]);
        let climates = read("--vary weather=a.epw,b.epw --vary schedule=8-18,9-17 --blinds lm83");
        assert_eq!(climates.expect("climates").len(), 4);
    }

    #[test]
    fn what_cannot_vary_is_one_line() {
        let year = "--weather a.epw";
        let many = (0..101).map(|v| v.to_string()).collect::<Vec<_>>();
        let many = format!("--vary seed={0} --vary spacing={0}", many.join(","));
        for (line, part) in [
            ("--vary turbidity", "for instance turbidity=2,3,4"),
            ("--vary turbidity=2,,3", "for instance turbidity=2,3,4"),
            ("--vary turbidity=2,abc", "\"abc\" is not a number"),
            ("--vary turbidity=2,2", "turbidity is 2 twice"),
            ("--vary turbdity=2", "--turbdity"),
            ("--vary size=2x2", "it changes no number at a moment"),
            ("--vary json=true", "--json"),
            ("--vary glass=0.95", "lets 0.01 to 0.918"),
            ("--turbidity 3 --vary turbidity=2,4", "given and varied"),
            ("--vary seed=1 --vary seed=2", "seed is given twice"),
            (
                "--vary glass=.5 --vary glass.roof=.6",
                "glass is given twice",
            ),
            (
                &format!("{year} --vary turbidity=2"),
                "over the year of a weather file; choose of",
            ),
            (
                &format!("{year} --vary glass=.5 --plan a.svg"),
                "cannot be used with",
            ),
            (
                "--hour 3-21T12 --vary weather=a.epw --vary blinds=lm83",
                "blinds",
            ),
            (&many, "10201 variants; 10000 are possible"),
        ] {
            let error = read(line).expect_err(line);
            assert!(error.contains(part), "{line}: {error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }
}
