//! What a picture is made with: [`Options`] as the user gave them, on the command line or in a scene file, and
//! [`Settings`] with everything decided.

mod ao_resolution;
mod command;
mod parameters;
mod resolve;
mod sun_input;
mod values;

use clap::{Args, Command, FromArgMatches};

pub use crate::daylight::false_colour::{Quantity, Range};
pub use crate::daylight::{IrradianceMethod, SkyModel, SunPositionMethod, ToneCurve};
pub use crate::frame::{Filter, Visibility};
pub use crate::gpu::Optional;
use crate::passes::dome::gather::MOST_DIRECTIONS;
pub use crate::passes::dome::specular::{Mirrors, Phong, Reflections};
pub use ao_resolution::AoResolution;
pub(crate) use parameters::name;
pub use resolve::{CameraParts, Exposure, Settings};
pub use sun_input::SunInput;
pub use values::{
    Direction, ExposureMode, Fresnel, Limits, Penumbra, Place, Preset, Show, Size, SolarTime,
    Switch, When,
};
pub(crate) use values::{exposure_factor, ratio, sun as direction};

/// A value or a name that makes no sense: one line that names it and the remedy.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct SettingsError(pub String);

/// Every option; none is set unless the user did. The same struct reads the command line and scene files.
#[derive(Debug, Clone, Default, PartialEq, Args)]
pub struct Options {
    /// Size of the picture, pixels [default: 1280x720].
    #[arg(long, value_name = "WxH", value_parser = values::size, help_heading = "Picture")]
    pub size: Option<Size>,
    /// Edge of the tiles in which pictures are drawn that are too large to be drawn at once, pixels, 64 to 16384
    /// [default: 2048 above 36 million pixels or what the device can do; render only].
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(64..=16_384), help_heading = "Picture")]
    pub tile: Option<u32>,
    /// Frames to accumulate: anti-aliasing, soft sun, less noise [default: 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536), help_heading = "Picture")]
    pub samples: Option<u32>,
    /// Stop before --samples when the picture's noise is less: the standard error of its luminance, relative to the mean, as an
    /// estimate from the samples, for instance 0.01 [with it, --samples is 4096 by default; render only].
    #[arg(long, value_name = "R", value_parser = values::noise, allow_hyphen_values = true, help_heading = "Picture")]
    pub noise: Option<f64>,
    /// What hides the sky: ambient occlusion of the screen, or shadow maps from directions of the sky, which converge to the
    /// truth with the samples [default: dome from 16 samples on, else ssao].
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Picture")]
    pub visibility: Option<Visibility>,
    /// Spread of the samples in a pixel [default: box].
    #[arg(long, value_enum, value_name = "FILTER", help_heading = "Picture")]
    pub filter: Option<Filter>,
    /// Start of the sample sequences: the same number, the same picture [default: 0].
    #[arg(long, value_name = "N", help_heading = "Picture")]
    pub seed: Option<u32>,
    /// What to show: the picture, or one quantity of the equation [default: beauty].
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Picture")]
    pub show: Option<Show>,
    /// Write every addend, V, A, normal, depth and albedo as named layers (render to .exr only).
    #[arg(long, help_heading = "Picture")]
    pub layers: bool,
    /// Defaults of the lecture: its sun, sky, sampling and scale; other options still rule.
    #[arg(long, value_enum, value_name = "NAME", help_heading = "Picture")]
    pub preset: Option<Preset>,

    /// Latitude and longitude, degrees, north and east positive (-33.87,151.21 or "33.87 S, 151.21 E"), or the name of a city
    /// [default: 55.79,12.52].
    #[arg(long, value_name = "LAT,LON|CITY", value_parser = Place::parse, allow_hyphen_values = true, help_heading = "Sun and sky")]
    pub place: Option<Place>,
    /// Moment: with a UTC offset (2026-12-21T15:00+01:00), with a time zone ("2026-12-21 15:00 Asia/Tokyo"), or local time of
    /// --place ("2026-12-21 15:00"): of the nearest listed city within 1000 km, else the hour of the longitude. Years -500 to
    /// 3000 [default: 15:00 local time on 2026-06-21].
    #[arg(
        long,
        value_name = "MOMENT",
        allow_hyphen_values = true,
        help_heading = "Sun and sky"
    )]
    pub when: Option<When>,
    /// Where the sun stands, degrees: azimuth clockwise from north, elevation above the horizon.
    #[arg(long, value_name = "AZIMUTH,ELEVATION", value_parser = values::sun, allow_hyphen_values = true,
          conflicts_with_all = ["place", "when", "solar"], help_heading = "Sun and sky")]
    pub sun: Option<Direction>,
    /// Day of the year and solar time in hours, with the latitude of --place.
    #[arg(long, value_name = "J,T", value_parser = values::solar, conflicts_with = "when", help_heading = "Sun and sky")]
    pub solar: Option<SolarTime>,
    /// Formulas of the sun's position [default: spa].
    #[arg(long, value_enum, value_name = "METHOD", help_heading = "Sun and sky")]
    pub sun_position: Option<SunPositionMethod>,
    /// Model of the sky [default: preetham].
    #[arg(long, value_enum, value_name = "MODEL", help_heading = "Sun and sky")]
    pub sky: Option<SkyModel>,
    /// Turbidity: 2 very clear, 3 clear, 6 hazy, 10 murky; clamped to what the model holds for [default: 3].
    #[arg(long, value_name = "T", value_parser = values::turbidity, allow_hyphen_values = true, help_heading = "Sun and sky")]
    pub turbidity: Option<f64>,
    /// Horizontal illuminance of the sky alone, lux: scales the sky to a measured value [default: the model's own].
    #[arg(long, value_name = "LUX", value_parser = values::sky_illuminance, allow_hyphen_values = true, help_heading = "Sun and sky")]
    pub sky_illuminance: Option<f64>,
    /// Whether the air lifts the sun to its apparent elevation (of --place and --solar; --sun is as seen) [default: on].
    #[arg(long, value_enum, value_name = "ON|OFF", help_heading = "Sun and sky")]
    pub refraction: Option<Switch>,
    /// Reflectance of the ground below the horizon, 0 to 1; 0 is black [default: 0.2].
    #[arg(long, value_name = "ALBEDO", value_parser = values::ground_albedo, allow_hyphen_values = true, help_heading = "Sun and sky")]
    pub ground_albedo: Option<f64>,

    /// Name of a moment of the scene file: its sun, sky and exposure.
    #[arg(long, value_name = "NAME", help_heading = "Sun and sky")]
    pub moment: Option<String>,

    /// Name of a camera of the scene file.
    #[arg(long, value_name = "NAME", help_heading = "Camera")]
    pub camera: Option<String>,
    /// Where the eye is, metres: east, up, south [default: the whole model in view].
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true, help_heading = "Camera")]
    pub eye: Option<[f64; 3]>,
    /// What the eye looks at, metres [default: the middle of the model].
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true, help_heading = "Camera")]
    pub target: Option<[f64; 3]>,
    /// Vertical field of view, degrees, 1 to 170 [default: 45].
    #[arg(long, value_name = "DEG", value_parser = values::fov, allow_hyphen_values = true, help_heading = "Camera")]
    pub fov: Option<f64>,

    /// Exposure value at ISO 100; 15 is bright sun.
    #[arg(long, value_name = "EV", value_parser = values::ev100, allow_hyphen_values = true, conflicts_with = "exposure", help_heading = "Tone")]
    pub ev100: Option<f64>,
    /// Exposure from the picture itself [default: auto].
    #[arg(long, value_enum, value_name = "MODE", help_heading = "Tone")]
    pub exposure: Option<ExposureMode>,
    /// Tone curve of .png pictures and the window [default: neutral].
    #[arg(long, value_enum, value_name = "CURVE", help_heading = "Tone")]
    pub tonemap: Option<ToneCurve>,
    /// Gamma instead of the sRGB curve, 0.1 to 10.
    #[arg(long, value_name = "G", value_parser = values::gamma, allow_hyphen_values = true, help_heading = "Tone")]
    pub gamma: Option<f64>,
    /// Factor before the tone curve, instead of an exposure.
    #[arg(long, value_name = "S", value_parser = values::scale, allow_hyphen_values = true, help_heading = "Tone")]
    pub scale: Option<f64>,
    /// False colours with a legend instead of the picture: luminance in cd/m², illuminance of the surfaces in lux.
    #[arg(long, value_enum, value_name = "QUANTITY", help_heading = "Tone")]
    pub false_colour: Option<Quantity>,
    /// Values of the first and the last false colour [default: from the picture; 10,100000 cd/m² or 100,100000 lux in the window].
    #[arg(long, value_name = "MIN,MAX", value_parser = values::colour_range, allow_hyphen_values = true, help_heading = "Tone")]
    pub false_colour_range: Option<Range>,

    /// How the light of the sky is integrated [default: quasi].
    #[arg(long, value_enum, value_name = "METHOD", help_heading = "Light")]
    pub irradiance: Option<IrradianceMethod>,
    /// Most samples of the irradiance cube, 1 to 65536 [default: 1024].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536), help_heading = "Light")]
    pub irradiance_samples: Option<u32>,
    /// Error at which sampling stops, percent of the irradiance from above, 0 to 100 [default: 0.1].
    #[arg(long, value_name = "PERCENT", value_parser = values::irradiance_error, allow_hyphen_values = true, help_heading = "Light")]
    pub irradiance_error: Option<f64>,
    /// Radius of ambient occlusion, metres; 0 turns it off [default: 5].
    #[arg(long, value_name = "METRES", value_parser = values::ao_radius, allow_hyphen_values = true, help_heading = "Light")]
    pub ao_radius: Option<f64>,
    /// Resolution of ambient occlusion [default: auto].
    #[arg(long, value_enum, value_name = "WHICH", help_heading = "Light")]
    pub ao_resolution: Option<AoResolution>,
    /// Multiplies every specular reflectance; 0 turns mirrors off [default: 1].
    #[arg(long, value_name = "SCALE", value_parser = values::specular, allow_hyphen_values = true, help_heading = "Light")]
    pub specular: Option<f64>,
    /// Whether mirrors grow stronger toward grazing angles [default: off].
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Light")]
    pub fresnel: Option<Fresnel>,
    /// Form of mirrors' highlights: the lecture's (r·l)^p beside a perfect mirror of the sky, or one reflectance for both that
    /// keeps the balance of energy [default: lecture].
    #[arg(long, value_enum, value_name = "FORM", help_heading = "Light")]
    pub phong: Option<Phong>,
    /// Whether what stands before the sky hides it from mirrors too (hidden needs --visibility dome) [default: open].
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Light")]
    pub reflections: Option<Reflections>,
    /// Draw the sun's disc darker toward its limb, as it is (same illuminance).
    #[arg(long, help_heading = "Light")]
    pub limb_darkening: bool,
    /// Edge of the shadow map, texels, 64 to 16384 [default: 2048].
    #[arg(long, value_name = "TEXELS", value_parser = clap::value_parser!(u32).range(64..=16_384), help_heading = "Light")]
    pub shadow_size: Option<u32>,
    /// Edges of the sun's shadow in a single frame: a texel of the map, or the penumbra of the sun's disc [default: map].
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Light")]
    pub penumbra: Option<Penumbra>,
    /// Directions of the sky in each sample of --visibility dome, 1 to 16 [default: 12].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_DIRECTIONS)), help_heading = "Light")]
    pub dome_directions: Option<u32>,
    /// Edge of the shadow map of each of them, texels, 64 to 4096 [default: 1024].
    #[arg(long, value_name = "TEXELS", value_parser = clap::value_parser!(u32).range(64..=4096), help_heading = "Light")]
    pub dome_size: Option<u32>,
    /// Smooth models without normals below this angle between faces, degrees, 0 to 180.
    #[arg(long, value_name = "DEGREES", value_parser = values::crease, allow_hyphen_values = true, help_heading = "Light")]
    pub smooth: Option<f64>,

    /// Let a model read libraries and pictures outside of its own folder tree.
    #[arg(long, help_heading = "Limits")]
    pub allow_outside: bool,
    /// Read large models anew instead of keeping them processed in the user's cache folder.
    #[arg(long, help_heading = "Limits")]
    pub no_cache: bool,
    /// Most triangles of a scene, instances counted [default: 67108864].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Limits")]
    pub max_triangles: Option<u32>,
    /// Longest edge of a texture, texels [default: 16384].
    #[arg(long, value_name = "TEXELS", value_parser = clap::value_parser!(u32).range(1..=65_536), help_heading = "Limits")]
    pub max_texture_edge: Option<u32>,
    /// Most memory of all textures together, MiB [default: 1024].
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Limits")]
    pub max_texture_mib: Option<u32>,
    /// Largest file that is read, MiB [default: 4096].
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Limits")]
    pub max_file_mib: Option<u32>,

    /// Vulkan device: part of its name, or its number in `skylight info`.
    #[arg(long, value_name = "NAME|INDEX", help_heading = "Program")]
    pub device: Option<String>,
    /// No progress, no warnings.
    #[arg(long, help_heading = "Program")]
    pub quiet: bool,
    /// Check every Vulkan call with the validation layers; slow.
    #[arg(long, help_heading = "Program")]
    pub validate: bool,
    /// Do without something that the device has, as on a device that lacks it.
    #[arg(long, value_enum, value_name = "FEATURE", help_heading = "Program")]
    pub without: Option<Optional>,
}

/// Takes each named field from the first that has it.
macro_rules! first_of {
    ($over:ident, $base:ident; $($field:ident)*; $($flag:ident)*) => {
        Options { $($field: $over.$field.or($base.$field),)* $($flag: $over.$flag || $base.$flag,)* }
    };
}

impl Options {
    /// Options from pairs such as `("turbidity", "3")`: the same parser as for `--turbidity=3`.
    ///
    /// # Errors
    /// An unknown name, a bad value, or options that exclude each other.
    pub fn from_pairs(pairs: &[(String, String)]) -> Result<Self, SettingsError> {
        let words = pairs
            .iter()
            .map(|(name, value)| format!("--{name}={value}"));
        let command = Self::augment_args(Command::new("scene").no_binary_name(true));
        let matches = command.try_get_matches_from(words);
        let options = matches.and_then(|matches| Self::from_arg_matches(&matches));
        options.map_err(|error| SettingsError(one_line(&error)))
    }

    /// These options where set, else those of `base`.
    ///
    /// The sun is one matter: a direction here replaces place and moment there, and the other way round; so is the
    /// exposure, and a named camera here replaces the camera there.
    #[must_use]
    pub fn over(self, mut base: Self) -> Self {
        if self.sun.is_some() {
            (base.place, base.when, base.solar) = (None, None, None);
        }
        if self.place.is_some() || self.when.is_some() || self.solar.is_some() {
            base.sun = None;
        }
        if self.when.is_some() {
            base.solar = None;
        }
        if self.solar.is_some() {
            base.when = None;
        }
        if self.camera.is_some() {
            (base.eye, base.target, base.fov) = (None, None, None);
        }
        if self.ev100.is_some() || self.exposure.is_some() {
            (base.ev100, base.exposure, base.scale) = (None, None, None);
        }
        first_of!(self, base;
            size tile penumbra samples noise visibility filter seed show preset place when sun solar sun_position sky turbidity sky_illuminance refraction ground_albedo camera eye target fov
            ev100 exposure tonemap gamma scale false_colour false_colour_range irradiance irradiance_samples irradiance_error ao_radius ao_resolution specular shadow_size
            dome_directions dome_size smooth device without max_triangles max_texture_edge max_texture_mib max_file_mib fresnel phong reflections moment;
            layers limb_darkening quiet validate allow_outside no_cache)
    }
}

/// A message of `clap` (several lines with usage and hints) as one line.
pub(crate) fn one_line(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let lines = text
        .lines()
        .map(str::trim)
        .take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    let line = lines
        .filter(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(" ");
    line.trim_start_matches("error: ").to_owned()
}
