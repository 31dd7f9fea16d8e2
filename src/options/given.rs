//! The options set by one source (command line, scene file or preset), as names and texts.

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::choices::is_visual_range;
use super::{DEFINITION, Options, OptionsError, exclude_each_other, is_flag, one_line};

/// Options of lower sources that an option overrides, besides itself and those that conflict with it.
const REPLACES: [(&str, &[&str]); 3] = [
    ("camera", &["eye", "target", "fov"]),
    ("exposure", &["scale"]),
    ("ev100", &["scale"]),
];

/// Options that are set, by name, each at most once. The text of a flag is `true`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OptionValues {
    pairs: Vec<(String, String)>,
    /// The user's own defaults, which scene and preset override.
    defaults: Vec<(String, String)>,
}

impl From<Vec<(String, String)>> for OptionValues {
    fn from(pairs: Vec<(String, String)>) -> Self {
        Self {
            pairs,
            defaults: Vec::new(),
        }
    }
}

impl OptionValues {
    /// Text of an option, if it is set.
    pub fn get(&self, name: &str) -> Option<&str> {
        let mut pairs = self.pairs.iter();
        pairs
            .find(|(own, _)| own == name)
            .map(|(_, text)| text.as_str())
    }

    /// Sets an option; replaces an earlier value.
    pub fn set(&mut self, name: &str, text: impl ToString) {
        let text = text.to_string();
        let name = if is_visual_range(name, &text) {
            "visual-range"
        } else {
            name
        };
        self.remove(&[name]);
        self.pairs.push((name.to_owned(), text));
    }

    /// Sets an option unless it is already set.
    pub fn set_default(&mut self, name: &str, text: impl ToString) {
        if self.get(name).is_none() {
            self.set(name, text);
        }
    }

    /// Unsets options, which leaves them to the lower sources.
    pub fn remove(&mut self, names: &[&str]) {
        self.pairs
            .retain(|(name, _)| !names.contains(&name.as_str()));
    }

    /// Names and texts, in the order they were set.
    pub fn iter(&self) -> impl Iterator<Item = &(String, String)> {
        self.pairs.iter()
    }

    /// Names and texts, in the order they were set.
    pub fn into_pairs(self) -> Vec<(String, String)> {
        self.pairs
    }

    /// The user's own defaults: what neither these options nor scene and preset say.
    pub fn defaults(&self) -> Self {
        Self::from(self.defaults.clone())
    }

    /// Replaces the user's own defaults.
    #[must_use]
    pub fn with_defaults(self, defaults: Self) -> Self {
        Self {
            defaults: defaults.pairs,
            ..self
        }
    }

    /// These options, and those of `base` that none of these overrides.
    ///
    /// The sun is overridden as a whole: a direction replaces the place and moment of `base`, and vice versa. So is the exposure.
    /// A named camera replaces the camera of `base`.
    #[must_use]
    pub fn over(self, base: Self) -> Self {
        let mut all = base;
        all.pairs
            .retain(|(name, _)| self.pairs.iter().all(|(own, _)| !replaces(own, name)));
        all.pairs.extend(self.pairs);
        if !self.defaults.is_empty() {
            all.defaults = self.defaults;
        }
        all
    }

    /// These options with the defaults of all others, ignoring scene and preset: for settings that are needed before a scene is
    /// loaded. The moment is the default one, since its time zone may depend on the scene's place.
    ///
    /// # Errors
    /// An unknown name, an invalid value, or options that conflict.
    pub fn alone(&self) -> Result<Options, OptionsError> {
        let mut values = self.clone().over(self.defaults());
        values.remove(&["when"]);
        values.parse().map(|(options, _)| options)
    }

    /// Checks each name and value, and that no two options conflict.
    ///
    /// # Errors
    /// The first problem found.
    pub fn check(&self) -> Result<(), OptionsError> {
        self.matches().map(|_| ())
    }

    /// The options, and the source of each value.
    pub(super) fn parse(&self) -> Result<(Options, ArgMatches), OptionsError> {
        let matches = self.matches()?;
        let options = Options::from_arg_matches(&matches);
        let options = options.map_err(|error| OptionsError(one_line(&error)))?;
        Ok((options, matches))
    }

    fn matches(&self) -> Result<ArgMatches, OptionsError> {
        let words =
            self.pairs
                .iter()
                .filter_map(|(name, text)| match (is_flag(name), text.as_str()) {
                    (true, "true") => Some(format!("--{name}")),
                    (true, "false") => None,
                    _ => Some(format!("--{name}={text}")),
                });
        let matches = DEFINITION.clone().try_get_matches_from(words);
        matches.map_err(|error| OptionsError(one_line(&error)))
    }
}

/// Whether setting `name` overrides `other` of a lower source.
pub(super) fn replaces(name: &str, other: &str) -> bool {
    let listed = |(from, list): &(&str, &[&str])| *from == name && list.contains(&other);
    name == other || REPLACES.iter().any(listed) || exclude_each_other(name, other)
}

/// On the command line all options of [`Options`] are accepted and checked; those given by the user are kept.
impl Args for OptionValues {
    fn augment_args(command: Command) -> Command {
        Options::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Options::augment_args_for_update(command)
    }
}

impl FromArgMatches for OptionValues {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut values = Self::default();
        for arg in DEFINITION.get_arguments() {
            let (id, name) = (arg.get_id().as_str(), arg.get_long().unwrap_or_default());
            if matches.value_source(id) == Some(ValueSource::CommandLine) {
                let mut raw = matches.get_raw(id).into_iter().flatten();
                let text = raw.next().map(|text| text.to_string_lossy());
                values.set(name, text.as_deref().unwrap_or("true"));
            }
        }
        Ok(values)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
