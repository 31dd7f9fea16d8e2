//! Settings back to the words that give them: the reverse of reading options.

use std::path::Path;

use super::resolve::name;
use super::{CameraParts, Exposure, Options, Settings, SettingsError, SunInput};
use crate::error::Error;
use crate::scene::{Camera, Loaded};

/// Written even where they are the defaults: they say what one looks at, and when.
const ALWAYS: [&str; 9] = [
    "place", "when", "solar", "sun", "camera", "eye", "target", "fov", "preset",
];
/// How bright the picture is: one matter, of which all is written or nothing.
const BRIGHTNESS: [&str; 3] = ["exposure", "ev100", "scale"];

/// The name of an option and its value; none for a flag.
type Word = (&'static str, Option<String>);

impl Settings {
    /// These settings with a camera of which nothing is left open.
    #[must_use]
    pub fn with_camera(&self, camera: &Camera) -> Self {
        let point = |p: glam::Vec3| Some(p.to_array().map(shortest));
        Self {
            camera: CameraParts {
                eye: point(camera.eye),
                target: point(camera.target),
                fov_deg: Some(shortest(camera.fov_deg)),
                name: None,
            },
            ..self.clone()
        }
    }

    /// The line `skylight render ..` that gives these settings again, quoted for a shell: what the scene and the defaults do
    /// not give by themselves, and always sun, camera and preset.
    ///
    /// `scene` is the path that was opened, and `loaded` what was found there (its options and cameras; the model is not
    /// looked at).
    ///
    /// # Errors
    /// A value of the scene that these settings lack and that no option takes back, such as a gamma; a path or name with a
    /// zero byte.
    pub fn command_line(&self, scene: Option<&Path>, loaded: &Loaded) -> Result<String, Error> {
        let by_itself = Self::resolve(
            Options {
                preset: self.preset,
                camera: self.camera.name.clone(),
                ..Options::default()
            },
            loaded,
        )?;
        let words = differences(&self.words(), &by_itself.words())?;
        let scene = scene.map(|path| {
            let text = path.to_string_lossy().into_owned();
            let looks_like_an_option = text.starts_with('-');
            if looks_like_an_option {
                format!("./{text}")
            } else {
                text
            }
        });
        let line = ["skylight".to_owned(), "render".to_owned()];
        let line: Vec<String> = line.into_iter().chain(scene).chain(words).collect();
        let quoted = shlex::try_join(line.iter().map(String::as_str));
        Ok(quoted.map_err(|_| {
            SettingsError("a name holds a zero byte, which no command line can; rename it".into())
        })?)
    }

    /// What decided the picture, by option name: for the metadata of files.
    pub fn parameters(&self) -> Vec<(&'static str, String)> {
        let mut list = vec![
            ("size", format!("{}x{}", self.size.width, self.size.height)),
            ("samples", self.samples.to_string()),
            ("show", name(self.show)),
            ("sun-position", name(self.sun_position)),
            ("sky", name(self.sky)),
            ("turbidity", self.turbidity.to_string()),
            ("refraction", name(self.refraction)),
            ("ground-albedo", self.ground_albedo.to_string()),
            ("irradiance", name(self.irradiance)),
            ("irradiance-samples", self.irradiance_samples.to_string()),
            ("irradiance-error", self.irradiance_error.to_string()),
            ("ao-radius", self.ao_radius.to_string()),
            ("ao-resolution", name(self.ao_resolution)),
            ("specular", self.specular.to_string()),
            ("shadow-size", self.shadow_size.to_string()),
            ("tonemap", name(self.tone_curve)),
        ];
        list.extend(sun_parameters(&self.sun));
        list.push(match self.exposure {
            Exposure::Auto => ("exposure", "auto".to_owned()),
            Exposure::Ev100(ev) => ("ev100", ev.to_string()),
        });
        let illuminance = self.sky_illuminance;
        list.extend(illuminance.map(|v| ("sky-illuminance", v.to_string())));
        list.extend(self.gamma.map(|v| ("gamma", v.to_string())));
        list.extend(self.scale.map(|v| ("scale", v.to_string())));
        list.extend(self.false_colour.map(|v| ("false-colour", name(v))));
        let range = self.false_colour_range;
        list.extend(range.map(|r| ("false-colour-range", format!("{},{}", r.min, r.max))));
        list
    }

    /// Every option that gives a part of these settings.
    fn words(&self) -> Vec<Word> {
        let point = |p: [f64; 3]| format!("{},{},{}", p[0], p[1], p[2]);
        let camera = &self.camera;
        let mut words: Vec<Word> = self
            .parameters()
            .into_iter()
            .map(|(name, value)| (name, Some(value)))
            .collect();
        let optional = [
            ("preset", self.preset.map(name)),
            ("camera", camera.name.clone()),
            ("eye", camera.eye.map(point)),
            ("target", camera.target.map(point)),
            ("fov", camera.fov_deg.map(|fov| fov.to_string())),
            ("smooth", self.smooth.map(|angle| angle.to_string())),
            ("device", self.device.clone()),
        ];
        words.extend(optional.into_iter().filter(|(_, value)| value.is_some()));
        let flags = [
            ("limb-darkening", self.limb_darkening),
            ("layers", self.layers),
            ("quiet", self.quiet),
            ("validate", self.validate),
        ];
        words.extend(flags.into_iter().filter(|f| f.1).map(|f| (f.0, None)));
        words
    }
}

fn sun_parameters(sun: &SunInput) -> Vec<(&'static str, String)> {
    match *sun {
        SunInput::Place {
            latitude,
            longitude,
            when,
        } => {
            vec![
                ("place", format!("{latitude},{longitude}")),
                ("when", when.to_rfc3339()),
            ]
        }
        SunInput::Solar {
            day,
            hours,
            latitude,
        } => {
            vec![
                ("place", format!("{latitude},0")),
                ("solar", format!("{day},{hours}")),
            ]
        }
        SunInput::Direction {
            azimuth_deg,
            elevation_deg,
        } => vec![("sun", format!("{azimuth_deg},{elevation_deg}"))],
    }
}

/// What turns the settings `from` into `to`, as arguments.
fn differences(to: &[Word], from: &[Word]) -> Result<Vec<String>, SettingsError> {
    let of = |name: &str, words: &[Word]| words.iter().find(|word| word.0 == name).cloned();
    let is_brightness = |name: &str| BRIGHTNESS.contains(&name);
    let brightness_changes = BRIGHTNESS.iter().any(|name| of(name, to) != of(name, from));
    let lost = from.iter().find(|(name, _)| {
        let replaced = is_brightness(name) || ["place", "when", "solar", "sun"].contains(name);
        !replaced && of(name, to).is_none()
    });
    if let Some((name, _)) = lost {
        return Err(SettingsError(format!(
            "the scene sets {name}, and no option takes that back; change it in the scene file"
        )));
    }
    let is_written = |word: &&Word| {
        let same = of(word.0, from).as_ref() == Some(*word);
        ALWAYS.contains(&word.0) || !same || (is_brightness(word.0) && brightness_changes)
    };
    Ok(to.iter().filter(is_written).flat_map(arguments).collect())
}

fn arguments((name, value): &Word) -> Vec<String> {
    match value {
        None => vec![format!("--{name}")],
        // Else a negative number, or a name with a dash, might be an option.
        Some(value) if value.starts_with('-') => vec![format!("--{name}={value}")],
        Some(value) => vec![format!("--{name}"), value.clone()],
    }
}

/// The number with the fewest digits that is the same in 32 bits.
fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

#[cfg(test)]
#[path = "command_tests.rs"]
mod tests;
