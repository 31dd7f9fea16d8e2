//! The options of several pictures of one scene: cameras, moments and times may be given more than once.

use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches, Args, Command, FromArgMatches};

use super::{OptionValues, OptionsError};

/// Options of which each value is for pictures of its own.
const LISTS: [&str; 3] = ["camera", "moment", "when"];

/// Options of a command line that asks for one picture or several.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SeveralPictures {
    /// The options that all pictures share, and of the others those of the first.
    pub first: OptionValues,
    /// All values of each of [`LISTS`]; empty if it is not given.
    lists: [Vec<String>; LISTS.len()],
}

impl SeveralPictures {
    /// The options of each picture: every camera in every moment.
    ///
    /// # Errors
    /// Several names of moments and several times, which both say when.
    pub fn pictures(&self) -> Result<Vec<OptionValues>, OptionsError> {
        let [cameras, moments, times] = &self.lists;
        if moments.len() > 1 && times.len() > 1 {
            let what = "--moment and --when are both given several times; keep one of them";
            return Err(OptionsError(what.to_owned()));
        }
        let mut all = vec![self.first.clone()];
        for (name, list) in LISTS.iter().zip([cameras, moments, times]) {
            if list.len() > 1 {
                let with = |(text, options): (&String, &OptionValues)| {
                    let mut options = options.clone();
                    options.set(name, text);
                    options
                };
                let pairs = list
                    .iter()
                    .flat_map(|text| all.iter().map(move |o| (text, o)));
                all = pairs.map(with).collect();
            }
        }
        Ok(all)
    }
}

impl Args for SeveralPictures {
    fn augment_args(command: Command) -> Command {
        let command = OptionValues::augment_args(command);
        LISTS.iter().fold(command, |command, name| {
            command.mut_arg(name, |arg| {
                arg.action(ArgAction::Append).value_delimiter(',')
            })
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for SeveralPictures {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let list = |name: &str| {
            let is_given = matches.value_source(name) == Some(ValueSource::CommandLine);
            let texts = matches.get_raw(name).filter(|_| is_given);
            let texts = texts.into_iter().flatten();
            texts.map(|t| t.to_string_lossy().into_owned()).collect()
        };
        Ok(Self {
            first: OptionValues::from_arg_matches(matches)?,
            lists: LISTS.map(list),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> SeveralPictures {
        let command = SeveralPictures::augment_args(Command::new("several").no_binary_name(true));
        let matches = command.try_get_matches_from(line.split_whitespace());
        SeveralPictures::from_arg_matches(&matches.expect(line)).expect(line)
    }

    #[test]
    fn every_camera_is_seen_in_every_moment() {
        let of = |options: &OptionValues| {
            ["camera", "when", "turbidity"].map(|name| options.get(name).unwrap_or("-").to_owned())
        };
        let line = "--camera a,b --when 2026-06-21T12:00Z --camera c --when 2026-06-21T13:00Z";
        let pictures = read(&format!("{line} --turbidity 4")).pictures();
        let pictures: Vec<_> = pictures.expect("pictures").iter().map(of).collect();
        let [noon, one] = ["2026-06-21T12:00Z", "2026-06-21T13:00Z"];
        let expected = [noon, one].map(|when| ["a", "b", "c"].map(|camera| [camera, when, "4"]));
        assert_eq!(pictures, expected.concat());
        let single = read("--turbidity 4").pictures().expect("a picture");
        assert_eq!(single.iter().map(of).collect::<Vec<_>>(), [["-", "-", "4"]]);
    }

    #[test]
    fn names_and_times_of_moments_are_not_mixed() {
        let both = "--moment a,b --when 2026-06-21T12:00Z --when 2026-06-21T13:00Z";
        let error = read(both).pictures().expect_err("both");
        assert!(error.0.contains("keep one of them"), "{error}");
        let one = read("--moment a,b --when 2026-06-21T12:00Z").pictures();
        assert_eq!(one.expect("pictures").len(), 2);
    }
}
