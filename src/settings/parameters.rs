//! What decided a picture, in words: the metadata of files.

use clap::ValueEnum;

use super::{Exposure, Settings, SunInput, Visibility};

impl Settings {
    /// What decided the picture, by option name: for the metadata of files.
    pub fn parameters(&self) -> Vec<(&'static str, String)> {
        let mut list = vec![
            ("size", format!("{}x{}", self.size.width, self.size.height)),
            ("samples", self.samples.to_string()),
            ("visibility", visibility(self.visibility)),
            ("filter", name(self.filter)),
            ("seed", self.seed.to_string()),
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
            ("fresnel", name(self.fresnel)),
            ("phong", name(self.mirrors.phong)),
            ("reflections", name(self.mirrors.reflections)),
            ("specular", self.specular.to_string()),
            ("shadow-size", self.shadow_size.to_string()),
            ("penumbra", name(self.penumbra)),
            ("dome-directions", self.dome_directions.to_string()),
            ("dome-size", self.dome_size.to_string()),
            ("tonemap", name(self.tone_curve)),
        ];
        list.extend(sun_parameters(&self.sun));
        list.push(match self.exposure {
            Exposure::Auto => ("exposure", "auto".to_owned()),
            Exposure::Ev100(ev) => ("ev100", ev.to_string()),
        });
        let illuminance = self.sky_illuminance;
        list.extend(illuminance.map(|v| ("sky-illuminance", v.to_string())));
        list.extend(self.noise.map(|v| ("noise", v.to_string())));
        list.extend(self.gamma.map(|v| ("gamma", v.to_string())));
        list.extend(self.scale.map(|v| ("scale", v.to_string())));
        let colours = self.false_colour.filter(|q| self.show.holds(*q));
        list.extend(colours.map(|v| ("false-colour", name(v))));
        let range = self.false_colour_range;
        list.extend(range.map(|r| ("false-colour-range", format!("{},{}", r.min, r.max))));
        list
    }
}

/// The picture at rest is the same by both: only how it gets there differs.
fn visibility(visibility: Visibility) -> String {
    name(match visibility {
        Visibility::Progressive => Visibility::Dome,
        other => other,
    })
}

pub(crate) fn name(value: impl ValueEnum) -> String {
    value
        .to_possible_value()
        .map_or_else(String::new, |v| v.get_name().to_owned())
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
