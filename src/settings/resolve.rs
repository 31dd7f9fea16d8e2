//! From what the user gave to what is used: defaults, presets, cameras by name.

use glam::Vec3;

use super::{
    AoResolution, Filter, Fresnel, IrradianceMethod, Limits, Mirrors, Options, Penumbra, Preset,
    Quantity, Range, Reflections, SettingsError, Show, Size, SkyModel, SunInput, SunPositionMethod,
    Switch, ToneCurve, Visibility, name,
};
use crate::error::Error;
use crate::gpu::Optional;
use crate::passes::dome::gather::DomeSettings;
use crate::scene::{Bounds, Camera, DEFAULT_FOV_DEG, Loaded, NamedOptions, SceneError};

/// Samples from which on shadow maps from the sky are better than ambient occlusion in every view.
const DOME_SAMPLES: u32 = 16;

/// Most samples where the noise decides and nothing is said.
const NOISE_SAMPLES: u32 = 4096;

/// What `--preset lecture` sets, by the course's own defaults.
const LECTURE: [(&str, &str); 16] = [
    ("place", "45,0"),
    ("solar", "200,10"),
    ("sun-position", "lecture"),
    ("refraction", "off"),
    ("sky", "preetham"),
    ("turbidity", "2.4"),
    ("ground-albedo", "0"),
    ("fov", "55"),
    ("tonemap", "linear"),
    ("scale", "0.025"),
    ("gamma", "1"),
    ("irradiance", "monte-carlo"),
    ("irradiance-samples", "2000"),
    ("irradiance-error", "0"),
    ("ao-resolution", "half"),
    ("shadow-size", "4096"),
];

/// How the picture is exposed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exposure {
    /// From the log-average luminance.
    Auto,
    /// Exposure value at ISO 100.
    Ev100(f64),
}

/// What is known of the camera; [`Settings::camera`] chooses the rest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CameraParts {
    /// Where the eye is, metres.
    pub eye: Option<[f64; 3]>,
    /// What it looks at, metres.
    pub target: Option<[f64; 3]>,
    /// Vertical field of view, degrees, 1..170.
    pub fov_deg: Option<f64>,
    /// The camera of the scene file that was asked for by name.
    pub name: Option<String>,
}

/// Everything that decides a picture, besides the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Of the picture.
    pub size: Size,
    /// Edge of the tiles that large pictures are drawn in, if asked for, pixels.
    pub tile: Option<u32>,
    /// Frames to accumulate, at least 1.
    pub samples: u32,
    /// Standard error of the luminance, relative to the mean, below which there are enough.
    pub noise: Option<f64>,
    /// What hides the sky.
    pub visibility: Visibility,
    /// Spread of the samples in a pixel.
    pub filter: Filter,
    /// Start of the sample sequences.
    pub seed: u32,
    /// Where the sun comes from.
    pub sun: SunInput,
    /// Formulas of its position.
    pub sun_position: SunPositionMethod,
    /// Model of the sky.
    pub sky: SkyModel,
    /// As given; the daylight clamps it to what the sky model holds for and says so.
    pub turbidity: f64,
    /// Horizontal illuminance to which the sky is scaled, lux.
    pub sky_illuminance: Option<f64>,
    /// Whether the air lifts the sun.
    pub refraction: Switch,
    /// 0..1; 0 is black below the horizon.
    pub ground_albedo: f64,
    /// What is known of the camera.
    pub camera: CameraParts,
    /// How bright.
    pub exposure: Exposure,
    /// Of pictures with 8 bits.
    pub tone_curve: ToneCurve,
    /// Instead of the sRGB curve.
    pub gamma: Option<f64>,
    /// Factor before the tone curve, instead of an exposure.
    pub scale: Option<f64>,
    /// What the picture shows.
    pub show: Show,
    /// What of it false colours show.
    pub false_colour: Option<Quantity>,
    /// From where to where they go.
    pub false_colour_range: Option<Range>,
    /// How the light of the sky is integrated.
    pub irradiance: IrradianceMethod,
    /// Most samples of the irradiance cube.
    pub irradiance_samples: u32,
    /// Error at which sampling stops, percent of the irradiance from above.
    pub irradiance_error: f64,
    /// Metres; 0 is off.
    pub ao_radius: f64,
    /// Of the occlusion image.
    pub ao_resolution: AoResolution,
    /// Multiplies every specular reflectance.
    pub specular: f64,
    /// Where the defaults came from.
    pub preset: Option<Preset>,
    /// Whether ρ_s grows toward grazing angles.
    pub fresnel: Fresnel,
    /// How surfaces mirror.
    pub mirrors: Mirrors,
    /// Whether the sun's disc is darker toward its limb.
    pub limb_darkening: bool,
    /// Whether all addends are written (EXR).
    pub layers: bool,
    /// Crease angle for models without normals, degrees.
    pub smooth: Option<f64>,
    /// Edge of the shadow map, texels.
    pub shadow_size: u32,
    /// How wide its shadows' edges are.
    pub penumbra: Penumbra,
    /// Directions of the sky in a sample, 1..=16.
    pub dome_directions: u32,
    /// Edge of the map of each, texels.
    pub dome_size: u32,
    /// What a scene may take and read.
    pub limits: Limits,
    /// Part of a device's name, or its number.
    pub device: Option<String>,
    /// No progress, no warnings.
    pub quiet: bool,
    /// Validation layers on.
    pub validate: bool,
    /// What to do without although the device has it.
    pub without: Option<Optional>,
}

impl Settings {
    /// The user's options over the scene file's, over the preset's, over the defaults.
    ///
    /// # Errors
    /// A bad value in the scene file, an unknown camera, an eye that looks at itself.
    pub fn resolve(user: Options, loaded: &Loaded) -> Result<Self, Error> {
        let scene_file = |e: SettingsError| SceneError::SceneFile {
            path: loaded.path.clone(),
            what: e.0,
        };
        let mut file = Options::from_pairs(&loaded.options).map_err(scene_file)?;
        if let Some(name) = &user.moment {
            let named = find_named("moment", &loaded.moments, name, "--when and --place")?;
            file = Options::from_pairs(named).map_err(scene_file)?.over(file);
        }
        if let Some(name) = &user.camera {
            let named = Options::from_pairs(find_named(
                "camera",
                &loaded.cameras,
                name,
                "--eye and --target",
            )?)
            .map_err(scene_file)?;
            // Not a mixture of two cameras: what the named one leaves open is open.
            (file.eye, file.target, file.fov) = (named.eye, named.target, named.fov);
        }
        let camera = user.camera.clone();
        let given = Options {
            camera: None,
            ..user
        }
        .over(file);
        let base = match given.preset {
            Some(Preset::Lecture) => {
                Options::from_pairs(&LECTURE.map(|(k, v)| (k.to_owned(), v.to_owned())))?
            }
            None => Options::default(),
        };
        Ok(Self::with_defaults(Options {
            camera,
            ..given.over(base)
        })?)
    }

    fn with_defaults(o: Options) -> Result<Self, SettingsError> {
        if o.eye.is_some() && o.eye == o.target {
            return Err(SettingsError(
                "--eye and --target are the same point; move one".to_owned(),
            ));
        }
        let default = o.noise.map_or(1, |_| NOISE_SAMPLES);
        let samples = o.samples.unwrap_or(default);
        let visibility = if samples >= DOME_SAMPLES {
            Visibility::Dome
        } else {
            Visibility::Ssao
        };
        let visibility = o.visibility.unwrap_or(visibility);
        let mirrors = mirrors(&o, visibility)?;
        let dome = DomeSettings::default();
        let show = shown(&o)?;
        let (sky, turbidity) = (o.sky.unwrap_or_default(), o.turbidity.unwrap_or(3.0));
        Ok(Self {
            sun: SunInput::of(&o)?,
            tile: o.tile,
            size: o.size.unwrap_or(Size {
                width: 1280,
                height: 720,
            }),
            samples,
            noise: o.noise,
            visibility,
            filter: o.filter.unwrap_or_default(),
            seed: o.seed.unwrap_or(0),
            sun_position: o.sun_position.unwrap_or_default(),
            sky,
            turbidity,
            sky_illuminance: o.sky_illuminance,
            refraction: o.refraction.unwrap_or_default(),
            ground_albedo: o.ground_albedo.unwrap_or(0.2),
            camera: CameraParts {
                eye: o.eye,
                target: o.target,
                fov_deg: o.fov,
                name: o.camera,
            },
            exposure: o.ev100.map_or(Exposure::Auto, Exposure::Ev100),
            tone_curve: o.tonemap.unwrap_or_default(),
            gamma: o.gamma,
            scale: o.scale,
            show,
            false_colour: o.false_colour,
            false_colour_range: o.false_colour_range,
            irradiance: o.irradiance.unwrap_or_default(),
            irradiance_samples: o.irradiance_samples.unwrap_or(1024),
            irradiance_error: o.irradiance_error.unwrap_or(0.1),
            ao_radius: o.ao_radius.unwrap_or(5.0),
            ao_resolution: o.ao_resolution.unwrap_or_default(),
            specular: o.specular.unwrap_or(1.0),
            preset: o.preset,
            fresnel: o.fresnel.unwrap_or_default(),
            mirrors,
            limb_darkening: o.limb_darkening,
            layers: o.layers,
            smooth: o.smooth,
            penumbra: o.penumbra.unwrap_or_default(),
            shadow_size: o.shadow_size.unwrap_or(2048),
            dome_directions: o.dome_directions.unwrap_or(dome.directions),
            dome_size: o.dome_size.unwrap_or(dome.map_edge),
            limits: Limits {
                allow_outside: o.allow_outside,
                max_triangles: o.max_triangles,
                max_texture_edge: o.max_texture_edge,
                max_texture_mib: o.max_texture_mib,
                max_file_mib: o.max_file_mib,
            },
            device: o.device,
            quiet: o.quiet,
            validate: o.validate,
            without: o.without,
        })
    }

    /// The camera for a model within `bounds`; what was not given is chosen so that the model is in view.
    pub fn camera(&self, bounds: &Bounds) -> Camera {
        let point = |p: [f64; 3]| Vec3::from(p.map(|v| v as f32));
        let parts = &self.camera;
        let fov = parts.fov_deg.map(|fov| fov as f32);
        Camera::from_parts(
            parts.eye.map(point),
            parts.target.map(point),
            fov,
            bounds,
            self.aspect(),
        )
    }

    /// A camera that sees all within `bounds`, whatever was given.
    pub fn framing(&self, bounds: &Bounds) -> Camera {
        Camera::framing(bounds, DEFAULT_FOV_DEG, self.aspect())
    }

    fn aspect(&self) -> f32 {
        self.size.width as f32 / self.size.height as f32
    }
}

/// What the picture shows: where nothing is said, what false colours ask for.
fn shown(o: &Options) -> Result<Show, SettingsError> {
    match (o.false_colour, o.show) {
        (Some(Quantity::Illuminance), None) => Ok(Show::Irradiance),
        (Some(quantity), Some(show)) if !show.holds(quantity) => Err(SettingsError(format!(
            "--false-colour {} has no meaning for --show {}; leave one out",
            name(quantity),
            show.name()
        ))),
        _ => Ok(o.show.unwrap_or_default()),
    }
}

/// How surfaces mirror; what hides the sky from them is told by the maps of the dome.
fn mirrors(o: &Options, visibility: Visibility) -> Result<Mirrors, SettingsError> {
    let reflections = o.reflections.unwrap_or_default();
    if reflections == Reflections::Hidden && visibility == Visibility::Ssao {
        return Err(SettingsError(
            "--reflections hidden needs --visibility dome; give it, or --samples 16 or more"
                .to_owned(),
        ));
    }
    Ok(Mirrors {
        phong: o.phong.unwrap_or_default(),
        reflections,
    })
}

/// The options of the camera or moment of this name.
fn find_named<'a>(
    what: &str,
    list: &'a [NamedOptions],
    name: &str,
    instead: &str,
) -> Result<&'a [(String, String)], SettingsError> {
    let known: Vec<&str> = list.iter().map(|named| named.name.as_str()).collect();
    match list.iter().find(|named| named.name == name) {
        Some(named) => Ok(&named.options),
        None if known.is_empty() => Err(SettingsError(format!(
            "no {what} \"{name}\": the scene names no {what}s; use {instead}"
        ))),
        None => Err(SettingsError(format!(
            "no {what} \"{name}\"; the scene has {}",
            known.join(", ")
        ))),
    }
}

#[cfg(test)]
#[path = "resolve_tests.rs"]
mod tests;
