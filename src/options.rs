//! The options: names, accepted values, defaults and help texts of the command line and of scene files.
//!
//! [`Options`] holds the settings of a render. They are resolved from four sources, each overriding the ones before it: the
//! preset, the scene file, the camera or moment that is selected from the scene file by name, and the user
//! ([`OptionValues`], [`Options::resolve`]). Below all of them are the user's own defaults ([`read_config`]). [`Options::values`] is the inverse: file metadata, `--resume` and
//! [`Options::command_line`] are made from it.
//!
//! A new option takes three edits:
//!
//! 1. its field in [`Options`] below, with help text, default and parser, in the group with its help heading and the tables
//!    of a scene file in which it may appear;
//! 2. the code that uses the field;
//! 3. if it has a type of its own: in `values.rs` an enum by `choice_enum!` or the text form of another type, or in `choices.rs`
//!    the names of an enum that other modules own.

mod choices;
mod command_line;
mod config;
mod given;
mod materials;
mod resolve;
mod several;
mod sun_input;
mod values;

use std::sync::LazyLock;

use clap::builder::ArgPredicate;
use clap::{ArgAction, Args, Command, value_parser};

pub use crate::daylight::false_colour::{ColourMap, Quantity, Range};
pub use crate::daylight::metrics::Blinds;
pub use crate::daylight::sun_hours::SunDates;
pub use crate::daylight::{IrradianceMethod, SkyModel, SunPositionMethod, ToneCurve};
pub use crate::frame::{AntiAliasing, Filter, Visibility};
pub use crate::gpu::Optional;
pub use crate::passes::bounces::cells::Bounces;
pub use crate::passes::dome::route::DomeBy;
pub use crate::passes::dome::specular::{Mirrors, Phong, Reflections};
pub use crate::passes::light::lighting::{Ambient, Show};
use choices::VisibilityParser;
pub use choices::{Choice, name};
pub(crate) use choices::{choice, choice_enum, choices};
pub use config::read_config;
pub use given::OptionValues;
pub use materials::ByMaterial;
pub use resolve::ResolveError;
pub(crate) use resolve::{in_world, shortest};
pub use several::SeveralPictures;
pub use sun_input::SunInput;
pub use values::{
    AerosolInput, AoResolution, Direction, ExposureMode, Fresnel, Hdr, Penumbra, Place, Preset,
    RouteChoice, Size, SolarTime, Switch, When,
};
pub(crate) use values::{
    elevation, exposure_factor, inset, offset, plan_width, plane_height, ratio, spacing,
    sun as direction, threshold,
};

use crate::daylight::atmosphere::air::Air;
use crate::daylight::hdr::HDR_PEAK;
use crate::daylight::sky::Conditions;
use crate::frame::FrameSettings;
use crate::passes::dome::gather::{DomeSettings, MOST_DIRECTIONS};
use crate::passes::occlusion::ssao::SsaoSettings;
use crate::passes::sky::irradiance::IrradianceSettings;
use crate::scene::{DEFAULT_FOV_DEG, LoadOptions};
pub use crate::scene::{Unit, Up};
use values::Written;

/// An invalid value or name. The message is one line that names it and says how to fix it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct OptionsError(pub String);

/// Metadata of a struct of options.
trait OptionGroup {
    /// Each field's identifier, with the tables of a scene file in which the option may appear.
    const TABLES: &'static [(&'static str, &'static [&'static str])];

    /// Name and text of every option that has a value, in field order.
    fn written(&self) -> Vec<(String, String)>;
}

/// Defines a struct of options in groups: `"help heading" [tables of a scene file] { fields }`.
macro_rules! options {
    (
        $(#[$attribute:meta])*
        $visibility:vis struct $name:ident {
            $($(#[$flat_attribute:meta])* flatten $flat:ident: $flat_type:ty;)*
            $($heading:literal $tables:tt {
                $($(#[$field_attribute:meta])* $field:ident: $type:ty,)*
            })*
        }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, PartialEq, clap::Args)]
        $visibility struct $name {
            $($(#[$flat_attribute])* #[command(flatten)] pub $flat: $flat_type,)*
            $($($(#[$field_attribute])* #[arg(long, help_heading = $heading)] pub $field: $type,)*)*
        }

        impl crate::options::OptionGroup for $name {
            const TABLES: &'static [(&'static str, &'static [&'static str])] =
                &[$($((stringify!($field), &$tables),)*)*];

            fn written(&self) -> Vec<(String, String)> {
                let mut list = Vec::new();
                $($(
                    let text = crate::options::Written::written(&self.$field);
                    list.extend(text.map(|text| (crate::options::long(stringify!($field)), text)));
                )*)*
                list
            }
        }
    };
}
pub(crate) use options;

options! {
    /// Everything that decides a picture besides the scene.
    pub struct Options {
        /// Where the sun comes from.
        flatten sun: SunInput;

        "Sun and sky" ["place", "sun", "moment"] {
            /// Formulas of the sun's position.
            #[arg(value_name = "METHOD", value_parser = choice::<SunPositionMethod>(), default_value_t)]
            sun_position: SunPositionMethod,
        }

        "Sun and sky" ["sky", "moment"] {
            /// Model of the sky.
            #[arg(value_name = "MODEL", value_parser = choice::<SkyModel>(), default_value_t)]
            sky: SkyModel,
            /// Turbidity: 2 very clear, 3 clear (the default), 6 hazy, 10 murky; clamped to what the model holds for. With --sky atmosphere
            /// another word for --aod: 0.1 for 2, 0.2 for 3, 0.4 for 5.
            #[arg(value_name = "T", value_parser = values::turbidity, allow_hyphen_values = true)]
            turbidity: Option<f64>,
            /// Optical depth of the aerosol at 550 nm, 0 to 0.6: 0.05 very clear, 0.1 clear (the default), 0.2 hazy, 0.4 murky
            /// (--sky atmosphere).
            #[arg(value_name = "AOD", value_parser = values::aod, allow_hyphen_values = true, conflicts_with = "turbidity")]
            aod: Option<f64>,
            /// Horizontal visibility at sea level, km, 8 to 300, another word for --aod: 41 for 0.1 (--sky atmosphere).
            #[arg(value_name = "KM", value_parser = values::visual_range, allow_hyphen_values = true,
                  conflicts_with_all = ["turbidity", "aod"])]
            visual_range: Option<f64>,
            /// Ozone, Dobson units, 0 to 600; it makes the blue hour (--sky atmosphere).
            #[arg(value_name = "DU", value_parser = values::ozone, allow_hyphen_values = true,
                  default_value_t = Air::default().ozone_du)]
            ozone: f64,
            /// The aerosol: single-scattering albedo 0.8 to 1, asymmetry 0 to 0.85, scale height 0.5 to 8 km, Ångström exponent 0 to 2.5
            /// (--sky atmosphere).
            #[arg(value_name = "SSA,G,KM,ANGSTROM", value_parser = values::aerosol, allow_hyphen_values = true,
                  default_value_t = Air::default().aerosol.into())]
            aerosol: AerosolInput,
            /// Horizontal illuminance of the sky alone, lux: scales the sky to a measured value; by default the model's own.
            #[arg(value_name = "LUX", value_parser = values::sky_illuminance, allow_hyphen_values = true)]
            sky_illuminance: Option<f64>,
            /// Share of a clear sky that clouds cover, 0 to 1: dims the sun and evens out the sky as Kasten and Czeplak measured in the
            /// mean; no cloud is drawn. Not for skies that have clouds of their own (perez, overcast, cie-1 to cie-10, cie-16).
            #[arg(value_name = "COVER", value_parser = values::cloud_cover, allow_hyphen_values = true,
                  default_value_t = Conditions::default().cloud_cover)]
            cloud_cover: f64,
            /// Measured irradiance by the sun at normal incidence, W/m², 0 to 1500 (--sky perez).
            #[arg(value_name = "W", value_parser = values::irradiance_w, allow_hyphen_values = true)]
            dni: Option<f64>,
            /// Measured irradiance by the sky on a horizontal plane, W/m², 0 to 1500 (--sky perez).
            #[arg(value_name = "W", value_parser = values::irradiance_w, allow_hyphen_values = true)]
            dhi: Option<f64>,
            /// Dew point at the ground, °C, -90 to 40: the water in the air for the luminous efficacies (--sky perez); by default that
            /// of 2 cm of precipitable water, 11 °C.
            #[arg(value_name = "CELSIUS", value_parser = values::dew_point, allow_hyphen_values = true)]
            dew_point: Option<f64>,
            /// Whether the air lifts the sun to its apparent elevation (of --place and --solar). With --sky atmosphere the air is lit by the true
            /// sun, and the disc stands and shines at its apparent elevation. --sun is taken as given for both.
            #[arg(value_name = "ON|OFF", value_parser = choice::<Switch>(), default_value_t)]
            refraction: Switch,
            /// Whether the moon shines: its disc in the sky, its light when the sun gives none, and the air that it lights with --sky atmosphere (of
            /// --place and --when).
            #[arg(value_name = "ON|OFF", value_parser = choice::<Switch>(), default_value_t)]
            moon: Switch,
            /// Whether the brightest stars are drawn, as points of light, where --sky atmosphere is dark enough (of --place and --when).
            #[arg(value_name = "ON|OFF", value_parser = choice::<Switch>(), default_value_t)]
            stars: Switch,
            /// Whether the air between surfaces and the eye dims them and adds its light: on by default with --sky atmosphere, which alone
            /// has air to draw. Scenes less than 200 m across have too little of it to see, and are drawn without.
            #[arg(value_name = "ON|OFF", value_parser = choice::<Switch>())]
            aerial: Option<Switch>,
            /// Reflectance of the ground below the horizon, 0 to 1; 0 is black.
            #[arg(value_name = "ALBEDO", value_parser = values::ground_albedo, allow_hyphen_values = true,
                  default_value_t = Conditions::default().ground_albedo)]
            ground_albedo: f64,
        }

        "Sun and sky" ["place", "sky", "moment"] {
            /// Altitude of the place above the sea, metres, 0 to 10000 (--sky atmosphere).
            #[arg(value_name = "M", value_parser = values::altitude, allow_hyphen_values = true,
                  default_value_t = Air::default().altitude_m)]
            altitude: f64,
        }

        "Sun and sky" [] {
            /// Name of a moment of the scene file: its sun, sky and exposure.
            #[arg(value_name = "NAME")]
            moment: Option<String>,
        }

        "Picture" [] {
            /// Size of the picture, pixels.
            #[arg(value_name = "WxH", value_parser = values::size, default_value_t)]
            size: Size,
            /// Edge of the tiles in which large pictures are drawn, pixels, 64 to 16384; by default 2048 above 36 million pixels or
            /// what the device can do (render only).
            #[arg(value_name = "PIXELS", value_parser = value_parser!(u32).range(64..=16_384))]
            tile: Option<u32>,
            /// Frames to accumulate: anti-aliasing, soft sun, less noise; with --noise the most, by default 4096.
            #[arg(value_name = "N", value_parser = value_parser!(u32).range(1..=65_536),
                  default_value_t = FrameSettings::default().samples,
                  default_value_if("noise", ArgPredicate::IsPresent, "4096"))]
            samples: u32,
            /// Stop before --samples when the picture's noise is less: the standard error of its luminance, relative to the mean, as
            /// an estimate from the samples, for instance 0.01 (render only).
            #[arg(value_name = "R", value_parser = values::noise, allow_hyphen_values = true)]
            noise: Option<f64>,
            /// What hides the sky: in single frames what --ambient says, or maps or rays in directions of the sky, which converge to
            /// the truth with the samples. From 16 samples on the default is dome. Given as ssao, so is --ambient.
            /// A number is the visibility of the air in km instead: --visual-range.
            #[arg(value_name = "HOW", value_parser = VisibilityParser, default_value_t)]
            visibility: Visibility,
            /// Anti-aliasing of a moving view and of single frames, of what is displayed alone: the values of .exr and of the read-out,
            /// other quantities and false colours keep one sample a pixel. In the window the default is taa. Pictures of several samples are smooth
            /// by these.
            #[arg(value_name = "HOW", value_parser = choice::<AntiAliasing>(), default_value_t)]
            aa: AntiAliasing,
            /// Spread of the samples in a pixel.
            #[arg(value_name = "FILTER", value_parser = choice::<Filter>(), default_value_t)]
            filter: Filter,
            /// Start of the sample sequences: the same number, the same picture.
            #[arg(value_name = "N", default_value_t = DomeSettings::default().seed)]
            seed: u32,
            /// What to show: the picture, or one quantity of the equation. With --false-colour illuminance the default is irradiance.
            #[arg(value_name = "WHAT", value_parser = choice::<Show>(), default_value_t,
                  default_value_ifs([("false_colour", name(Quantity::Illuminance), name(Show::Irradiance)),
                                     ("false_colour", name(Quantity::SunHours), name(Show::SunHours))]))]
            show: Show,
            /// Dates of --show sun-hours, whose hours are summed up, separated by commas: 3-21, 2026-3-21, or year. Without a year they are of
            /// that of --when.
            #[arg(value_name = "LIST", value_parser = values::sun_dates, default_value_t)]
            sun_dates: SunDates,
            /// Minutes from one sun of --show sun-hours to the next, 1 to 60, of which a day has a whole number; each takes a frame.
            #[arg(value_name = "MINUTES", value_parser = values::sun_step, default_value_t = 10)]
            sun_step: u32,
            /// Write every addend (sun, sky, bounces, emission ..), V, A, normal, depth and albedo as named layers (render to .exr only).
            layers: bool,
            /// Defaults of the lecture: its sun, sky, sampling and scale, ambient occlusion, no bounces; other options override them.
            #[arg(value_name = "NAME", value_parser = choice::<Preset>())]
            preset: Option<Preset>,
        }

        "Camera" [] {
            /// Name of a camera of the scene file.
            #[arg(value_name = "NAME")]
            camera: Option<String>,
        }

        "Camera" ["camera"] {
            /// Position of the camera, metres: east, up, south; by default the model is in view, without a wide ground or what lies far off; a room is entered.
            #[arg(value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
            eye: Option<[f64; 3]>,
            /// Point that the camera looks at, metres; by default the middle of what is in view.
            #[arg(value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
            target: Option<[f64; 3]>,
            /// Vertical field of view, degrees, 1 to 170.
            #[arg(value_name = "DEG", value_parser = values::fov, allow_hyphen_values = true,
                  default_value_t = DEFAULT_FOV_DEG.into())]
            fov: f64,
        }

        "Tone" ["exposure", "moment"] {
            /// Exposure value at ISO 100; 15 is bright sun.
            #[arg(value_name = "EV", value_parser = values::ev100, allow_hyphen_values = true, conflicts_with = "exposure")]
            ev100: Option<f64>,
            /// Exposure from the picture itself, unless --ev100 or --scale is given.
            #[arg(value_name = "MODE", value_parser = choice::<ExposureMode>(), default_value_t)]
            exposure: ExposureMode,
            /// Lowest exposure value of the automatic exposure, which leaves darker pictures dark: -2 shows a landscape under the full moon as
            /// a night; by default every night is exposed until it is as bright as a day.
            #[arg(value_name = "EV", value_parser = values::ev100, allow_hyphen_values = true)]
            min_ev100: Option<f64>,
            /// Tone curve of .png pictures and the window.
            #[arg(value_name = "CURVE", value_parser = choice::<ToneCurve>(), default_value_t)]
            tonemap: ToneCurve,
            /// Gamma instead of the sRGB curve, 0.1 to 10.
            #[arg(value_name = "G", value_parser = values::gamma, allow_hyphen_values = true)]
            gamma: Option<f64>,
            /// Factor before the tone curve, instead of an exposure.
            #[arg(value_name = "S", value_parser = values::scale, allow_hyphen_values = true)]
            scale: Option<f64>,
        }

        "Tone" ["exposure"] {
            /// HDR signal of the window: exposed cd/m² in proportion, without tone curve and gamma, white paper at 203 cd/m² and what is brighter up
            /// to the screen's peak (view only). Screens without HDR may get one offered too: hence the default.
            #[arg(value_name = "WHEN", value_parser = choice::<Hdr>(), default_value_t)]
            hdr: Hdr,
            /// Peak luminance of the HDR screen, cd/m², 100 to 10000.
            #[arg(value_name = "CD/M2", value_parser = values::hdr_peak, allow_hyphen_values = true, default_value_t = HDR_PEAK)]
            hdr_peak: f64,
        }

        "Tone" [] {
            /// False colours with a legend instead of the picture: luminance in cd/m², illuminance of the surfaces in lux, hours of sun.
            #[arg(value_name = "QUANTITY", value_parser = choice::<Quantity>(),
                  default_value_if("show", name(Show::SunHours), name(Quantity::SunHours)))]
            false_colour: Option<Quantity>,
            /// Values of the first and the last false colour; from 0 the scale is linear, else logarithmic. By default from the picture, in the
            /// window those of a sunny day.
            #[arg(value_name = "MIN,MAX", value_parser = values::colour_range, allow_hyphen_values = true)]
            false_colour_range: Option<Range>,
            /// Colours of false-colour pictures.
            #[arg(value_name = "MAP", value_parser = choice::<ColourMap>(), default_value_t)]
            colour_map: ColourMap,
        }

        "Light" ["sky", "moment"] {
            /// How the light of the sky is integrated.
            #[arg(value_name = "METHOD", value_parser = choice::<IrradianceMethod>(), default_value_t)]
            irradiance: IrradianceMethod,
            /// Most samples of the irradiance cube, 1 to 65536.
            #[arg(value_name = "N", value_parser = value_parser!(u32).range(1..=65_536),
                  default_value_t = IrradianceSettings::default().samples)]
            irradiance_samples: u32,
            /// Error at which sampling stops, percent of the irradiance from above, 0 to 100.
            #[arg(value_name = "PERCENT", value_parser = values::irradiance_error, allow_hyphen_values = true, default_value_t = 0.1)]
            irradiance_error: f64,
        }

        "Light" ["light"] {
            /// How often surfaces reflect light onto others: all, or a number; 0 is the light of sun and sky alone, and lamps light nothing.
            #[arg(value_name = "N", value_parser = values::bounces, allow_hyphen_values = true, default_value_t)]
            bounces: Bounces,
            /// Factor on the light that surfaces emit, 0 to 1e9: how many cd/m² a model's unit of emission is; 0 turns lamps off.
            #[arg(value_name = "SCALE", value_parser = values::emission_scale, allow_hyphen_values = true,
                  default_value_t = 1.0)]
            emission_scale: f64,
            /// Where single frames have the light of the sky and of other surfaces from.
            #[arg(value_name = "SOURCE", value_parser = choice::<Ambient>(), default_value_t)]
            ambient: Ambient,
            /// Light paths that refine the cells in each frame of a moving view, 0 to 65536; more are smoother but slower.
            #[arg(value_name = "PATHS", value_parser = value_parser!(u32).range(0..=65_536),
                  default_value_t = FrameSettings::default().refine)]
            refine: u32,
            /// Radius of ambient occlusion (--ambient ssao), metres; 0 turns it off.
            #[arg(value_name = "METRES", value_parser = values::ao_radius, allow_hyphen_values = true,
                  default_value_t = SsaoSettings::default().radius.into())]
            ao_radius: f64,
            /// Resolution of ambient occlusion.
            #[arg(value_name = "WHICH", value_parser = choice::<AoResolution>(), default_value_t)]
            ao_resolution: AoResolution,
            /// Factor on every specular reflectance; 0 turns reflections off.
            #[arg(value_name = "SCALE", value_parser = values::specular, allow_hyphen_values = true,
                  default_value_t = FrameSettings::default().lighting.specular_scale.into())]
            specular: f64,
            /// Whether specular reflectance of Phong's lobe grows toward grazing angles. That of GGX does.
            #[arg(value_name = "HOW", value_parser = choice::<Fresnel>(), default_value_t)]
            fresnel: Fresnel,
            /// Edge of the shadow map, texels, 64 to 16384.
            #[arg(value_name = "TEXELS", value_parser = value_parser!(u32).range(64..=16_384),
                  default_value_t = FrameSettings::default().shadow_resolution)]
            shadow_size: u32,
            /// Edges of the sun's shadow in a single frame: a texel of the map, or the penumbra of the sun's disc.
            #[arg(value_name = "HOW", value_parser = choice::<Penumbra>(), default_value_t)]
            penumbra: Penumbra,
        }

        "Light" [] {
            /// Specular lobe: by the model's format, or for every material the lecture's (r·l)^p beside a perfect mirror of the sky, or one
            /// energy-conserving reflectance for both.
            #[arg(value_name = "FORM", value_parser = choice::<Phong>(), default_value_t)]
            phong: Phong,
            /// Whether geometry occludes the sky in reflections of Phong's lobe (hidden needs --visibility dome). It does in those of GGX.
            #[arg(value_name = "HOW", value_parser = choice::<Reflections>(), default_value_t)]
            reflections: Reflections,
            /// Draw the sun's disc darker toward its limb, as it is (same illuminance).
            limb_darkening: bool,
            /// Directions of the sky in each sample of --visibility dome, 1 to 16.
            #[arg(value_name = "N", value_parser = value_parser!(u32).range(1..=i64::from(MOST_DIRECTIONS)),
                  default_value_t = DomeSettings::default().directions)]
            dome_directions: u32,
            /// Edge of the shadow map of each of them, texels, 64 to 4096.
            #[arg(value_name = "TEXELS", value_parser = value_parser!(u32).range(64..=4096),
                  default_value_t = DomeSettings::default().map_edge)]
            dome_size: u32,
            /// How the sky's visibility in them is found. Both converge to the same picture.
            #[arg(value_name = "HOW", value_parser = choice::<DomeBy>(), default_value_t)]
            dome_by: DomeBy,
            /// Smooth models without normals below this angle between faces, degrees, 0 to 180.
            #[arg(value_name = "DEGREES", value_parser = values::crease, allow_hyphen_values = true)]
            smooth: Option<f64>,
        }

        "Model" [] {
            /// Axis of the model that points up. Cameras and sensors keep the axes of the picture: +Y up.
            #[arg(value_name = "AXIS", value_parser = choice::<Up>(), default_value_t)]
            up: Up,
            /// Unit of the model's lengths: light depends on size. By default metres, with a warning if the size is implausible. In a scene
            /// file, the keys `up` and `unit` of a mesh override these options.
            #[arg(value_name = "UNIT", value_parser = choice::<Unit>())]
            unit: Option<Unit>,
            /// Transmittance of the panes of glass at normal incidence, 0.01 to 0.918, instead of the model's: of all, or by their materials
            /// (pane=0.7,roof=0.5). A tint stays.
            #[arg(value_name = "T", value_parser = materials::glass, allow_hyphen_values = true)]
            glass: Option<ByMaterial>,
            /// Makes materials grey and matt, with this reflectance each, 0 to 1, instead of their colours and textures.
            #[arg(value_name = "NAME=R", value_parser = materials::reflectance, allow_hyphen_values = true)]
            reflectance: Option<ByMaterial>,
        }

        "Limits" [] {
            /// Let a model read libraries and pictures outside of its own folder tree.
            allow_outside: bool,
            /// Read large models anew instead of keeping them processed in the user's cache folder.
            no_cache: bool,
            /// Most triangles of a scene, instances counted.
            #[arg(value_name = "N", value_parser = value_parser!(u32).range(1..),
                  default_value_t = LoadOptions::default().max_triangles as u32)]
            max_triangles: u32,
            /// Longest edge of a texture, texels.
            #[arg(value_name = "TEXELS", value_parser = value_parser!(u32).range(1..=65_536),
                  default_value_t = LoadOptions::default().max_texture_edge)]
            max_texture_edge: u32,
            /// Most memory of all textures together, MiB.
            #[arg(value_name = "MIB", value_parser = value_parser!(u32).range(1..),
                  default_value_t = (LoadOptions::default().max_texture_bytes >> 20) as u32)]
            max_texture_mib: u32,
            /// Largest file that is read, MiB.
            #[arg(value_name = "MIB", value_parser = value_parser!(u32).range(1..),
                  default_value_t = (LoadOptions::default().max_file_bytes >> 20) as u32)]
            max_file_mib: u32,
        }

        "Program" [] {
            /// Vulkan device: part of its name, or its number in `skylight info`.
            #[arg(value_name = "NAME|INDEX")]
            device: Option<String>,
            /// No progress; warnings stay.
            quiet: bool,
            /// No warnings.
            no_warnings: bool,
            /// File of your own defaults instead of config.toml in the user's folder (skylight --print-config tells which); none is none. So does
            /// SKYLIGHT_CONFIG in the environment.
            #[arg(value_name = "FILE|none")]
            config: Option<String>,
            /// Every warning is an error: nothing is drawn or written, and the exit code is 1.
            strict: bool,
            /// Check every Vulkan call with the validation layers; slow.
            validate: bool,
            /// How full-screen passes (lighting, occlusion, tone map ..) and the cubes of the sky are run; the picture is the same.
            #[arg(value_name = "ROUTE", value_parser = choice::<RouteChoice>(), default_value_t)]
            route: RouteChoice,
            /// Do without something that the device has, as on a device that lacks it.
            #[arg(value_name = "FEATURE", value_parser = choice::<Optional>())]
            without: Option<Optional>,
        }
    }
}

impl Options {
    /// Every option that has a value, by name. Resolving them gives equal options.
    pub fn values(&self) -> OptionValues {
        let mut list = self.sun.written();
        list.extend(self.written());
        // An option that another one overrides counts as not set.
        let colours = self.false_colour.is_some_and(|q| self.show.holds(q));
        list.retain(|(name, _)| match name.as_str() {
            "exposure" => self.ev100.is_none(),
            "false-colour" => colours,
            "aerial" => self.has_air(),
            _ => true,
        });
        OptionValues::from(list)
    }

    /// Turns on the false colours of a quantity that is shown in no other way, and off where they belong to another.
    pub fn show_in_colours(&mut self) {
        if self.show == Show::SunHours {
            self.false_colour = Some(Quantity::SunHours);
            self.false_colour_range = None;
        } else if self.false_colour == Some(Quantity::SunHours) {
            self.false_colour = None;
        }
    }

    /// Whether the sky is one whose air can be drawn.
    fn has_air(&self) -> bool {
        self.sky == SkyModel::Atmosphere
    }

    /// Whether the air between surfaces and the eye is drawn, if the scene is large enough.
    pub fn draws_air(&self) -> bool {
        self.has_air() && self.aerial != Some(Switch::Off)
    }

    /// The subset of [`Options::values`] that determines a daylight and how its irradiance is integrated.
    pub fn light(&self) -> Vec<(String, String)> {
        let all = self.values().into_pairs().into_iter();
        all.filter(|(name, _)| decides_light(name)).collect()
    }
}

/// Whether an option affects a daylight on its own, without a picture. The irradiance error limit does not: there
/// `--irradiance-samples` alone sets the number of samples.
pub(crate) fn decides_light(name: &str) -> bool {
    let mut tables = tables(name).iter();
    !["irradiance-error", "aerial"].contains(&name)
        && tables.any(|table| ["sun", "sky"].contains(table))
}

/// Identifiers of all options, with the tables of a scene file in which they may appear.
fn all_tables() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    let groups = [SunInput::TABLES, Options::TABLES];
    groups.into_iter().flatten().copied()
}

/// The tables of a scene file in which an option may appear.
fn tables(name: &str) -> &'static [&'static str] {
    all_tables()
        .find(|(field, _)| long(field) == name)
        .map_or(&[], |(_, tables)| tables)
}

/// Option name of a field.
fn long(field: &str) -> String {
    field.replace('_', "-")
}

/// The clap definition that parses values from sources other than the command line.
static DEFINITION: LazyLock<Command> =
    LazyLock::new(|| Options::augment_args(Command::new("options").no_binary_name(true)));

/// Whether an option of this name exists.
#[cfg(test)]
pub(crate) fn is_option(name: &str) -> bool {
    DEFINITION
        .get_arguments()
        .any(|arg| arg.get_long() == Some(name))
}

/// Whether an option takes no value on the command line.
fn is_flag(name: &str) -> bool {
    let mut args = DEFINITION.get_arguments();
    args.any(|arg| arg.get_long() == Some(name) && matches!(arg.get_action(), ArgAction::SetTrue))
}

/// Whether two options conflict.
fn exclude_each_other(name: &str, other: &str) -> bool {
    let excludes = |a: &str, b: &str| {
        let mut args = DEFINITION.get_arguments();
        let arg = args.find(|arg| arg.get_long() == Some(a));
        let excluded = arg.map(|arg| DEFINITION.get_arg_conflicts_with(arg));
        excluded.is_some_and(|list| list.iter().any(|arg| arg.get_long() == Some(b)))
    };
    excludes(name, other) || excludes(other, name)
}

/// A clap message (several lines with usage and hints) as one line.
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

#[cfg(test)]
pub(crate) mod tests;
