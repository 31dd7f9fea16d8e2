//! What render, view and bench have in common: from options to a scene, a daylight and the settings of a frame.

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use glam::UVec2;

use super::light::{conditions, sun_position};
use crate::daylight::exposure::{KEY, factor_from_ev100};
use crate::daylight::sample_count::ErrorEstimate;
use crate::daylight::sky::Daylight;
use crate::daylight::spectrum::LUMINOUS_EFFICACY;
use crate::daylight::sun_position::SunPosition;
use crate::daylight::sunlight::LIMB_DARKENING;
use crate::daylight::tone_curve::REINHARD_WHITE;
use crate::error::Result;
use crate::frame::{FrameSettings, Sampling};
use crate::gpu::{Context, ContextOptions, Optional};
use crate::passes::dome::gather::DomeSettings;
use crate::passes::light::lighting::{LightingSettings, Precision, Shadows, Show};
use crate::passes::occlusion::ssao::SsaoSettings;
use crate::passes::picture::tone_map::{Scale, ToneSettings};
use crate::passes::sky::irradiance::IrradianceSettings;
use crate::passes::sky::route::CubeRoute;
use crate::scene::{self, Camera, LoadOptions, Loaded, Scene};
use crate::settings::{Exposure, Fresnel, Options, Penumbra, Preset, Settings};

/// How a scene is to be loaded.
pub fn load_options(options: &Options) -> LoadOptions {
    let default = LoadOptions::default();
    let bytes = |mib: Option<u32>, default| mib.map_or(default, |mib| u64::from(mib) << 20);
    LoadOptions {
        smooth_deg: options.smooth.map(|s| s as f32),
        max_texture_edge: options.max_texture_edge.unwrap_or(default.max_texture_edge),
        max_texture_bytes: bytes(options.max_texture_mib, default.max_texture_bytes),
        max_file_bytes: bytes(options.max_file_mib, default.max_file_bytes),
        max_triangles: options
            .max_triangles
            .map_or(default.max_triangles, |n| n as usize),
        allow_outside: options.allow_outside,
        cache: if options.no_cache {
            None
        } else {
            cache_folder()
        },
    }
}

/// Where processed scenes and pipelines are kept: the user's folder for files that may be deleted at any time.
fn cache_folder() -> Option<PathBuf> {
    Some(dirs::cache_dir()?.join("skylight"))
}

/// How a device is to be opened.
pub fn context_options(
    device: Option<String>,
    validate: bool,
    without: Option<Optional>,
) -> ContextOptions {
    ContextOptions {
        device,
        validate,
        without: without.into_iter().collect(),
        cache_folder: cache_folder(),
        fault: std::env::var("SKYLIGHT_FAULT").ok(),
        ..ContextOptions::default()
    }
}

/// Says on stderr what a device has to go a long way round for.
pub fn notice(context: &Context) {
    let device = context.summary();
    if CubeRoute::of(context) == CubeRoute::Compute {
        eprintln!(
            "notice: \"{}\" has no geometry shaders; compute shaders draw the cubes of sky and irradiance",
            device.name
        );
    }
}

/// A scene under a daylight, and how it is to be drawn.
pub struct Job {
    /// Everything decided.
    pub settings: Settings,
    /// What is drawn.
    pub scene: Scene,
    /// From where.
    pub camera: Camera,
    /// Where the sun stands.
    pub sun: SunPosition,
    /// Under which light.
    pub daylight: Daylight,
    /// Name of the scene, for metadata.
    pub name: String,
    /// Where the scene came from, `None` for the bundled one.
    pub path: Option<PathBuf>,
    /// What its file says of the settings; its model is in `scene`.
    pub loaded: Loaded,
}

impl Job {
    /// Loads the scene and decides everything. Warnings go to stderr unless the user wants quiet.
    ///
    /// # Errors
    /// A scene that cannot be read, or options that make no sense.
    pub fn new(path: Option<&Path>, options: Options) -> Result<Self> {
        let loaded = scene::load_with_progress(path, &load_options(&options), &|_, _| ())?;
        let job = Self::of(path, loaded, options)?;
        if !job.settings.quiet {
            for warning in job.warnings() {
                eprintln!("warning: {warning}");
            }
        }
        Ok(job)
    }

    /// Decides everything about a scene that is loaded.
    ///
    /// # Errors
    /// Options that make no sense.
    pub fn of(path: Option<&Path>, mut loaded: Loaded, options: Options) -> Result<Self> {
        let settings = Settings::resolve(options, &loaded)?;
        let sun = sun_position(&settings)?;
        let daylight = Daylight::new(&conditions(&settings, &sun));
        let scene = std::mem::take(&mut loaded.scene);
        let camera = settings.camera(&scene.bounds);
        let name = path.map_or("bundled".to_owned(), |p| p.display().to_string());
        Ok(Self {
            settings,
            scene,
            camera,
            sun,
            daylight,
            name,
            path: path.map(Path::to_owned),
            loaded,
        })
    }

    /// What is odd about the scene and its light, a line each.
    pub fn warnings(&self) -> impl Iterator<Item = &String> {
        self.scene.warnings.iter().chain(&self.daylight.warnings)
    }

    /// Follows the settings after a change of place, time, sky or air.
    ///
    /// # Errors
    /// A moment that the ephemeris does not cover: the light is as it was.
    pub fn relight(&mut self) -> Result<()> {
        self.sun = sun_position(&self.settings)?;
        self.daylight = Daylight::new(&conditions(&self.settings, &self.sun));
        Ok(())
    }

    /// [`Job::new`], and the device that the user wants, which is opened meanwhile.
    ///
    /// # Errors
    /// As [`Job::new`], and when there is no such device.
    pub fn on_device(path: Option<&Path>, options: Options) -> Result<(Self, Arc<Context>)> {
        let wanted = context_options(options.device.clone(), options.validate, options.without);
        let (job, context) = thread::scope(|scope| {
            let context = scope.spawn(|| Context::new(&wanted));
            let job = Self::new(path, options);
            // A fault of this program is one on this thread too.
            (
                job,
                context.join().unwrap_or_else(|fault| resume_unwind(fault)),
            )
        });
        let (job, context) = (job?, context?);
        if !job.settings.quiet {
            notice(&context);
        }
        Ok((job, context))
    }

    /// The settings of the frame.
    pub fn frame_settings(&self, show: Show, precision: Precision) -> FrameSettings {
        let s = &self.settings;
        let ssao = SsaoSettings {
            radius: s.ao_radius as f32,
            downscale: s.ao_resolution.downscale(s.size.height),
            ..SsaoSettings::default()
        };
        FrameSettings {
            size: UVec2::new(s.size.width, s.size.height),
            samples: s.samples,
            sampling: self.sampling(),
            sky_edge: self.sky_edge(),
            irradiance: self.irradiance_settings(),
            shadow_resolution: s.shadow_size,
            ssao,
            lighting: LightingSettings {
                show,
                precision,
                specular_scale: s.specular as f32,
                limb_darkening: if s.limb_darkening {
                    LIMB_DARKENING as f32
                } else {
                    0.0
                },
                has_albedo: true,
                occlusion_downscale: ssao.pixels_per_texel(),
                fresnel: s.fresnel == Fresnel::Schlick,
                shadows: Shadows {
                    cascades: 0,
                    penumbrae: s.penumbra == Penumbra::Sun,
                },
                mirrors: s.mirrors,
            },
            tone: ToneSettings {
                show,
                curve: s.tone_curve,
                scale: self.scale(),
                white: REINHARD_WHITE,
                gamma: s.gamma,
                depth_scale: f64::from(self.scene.bounds.diagonal()).max(1e-3),
                false_colour: s
                    .false_colour
                    .filter(|quantity| show.holds(*quantity))
                    .map(|quantity| s.false_colour_range.unwrap_or(quantity.daytime())),
            },
        }
    }

    fn sampling(&self) -> Sampling {
        let s = &self.settings;
        Sampling {
            visibility: s.visibility,
            filter: s.filter,
            dome: DomeSettings {
                directions: s.dome_directions,
                map_edge: s.dome_size,
                seed: s.seed,
            },
        }
    }

    fn sky_edge(&self) -> u32 {
        if self.settings.preset == Some(Preset::Lecture) {
            512
        } else {
            256
        }
    }

    fn irradiance_settings(&self) -> IrradianceSettings {
        let s = &self.settings;
        let default = IrradianceSettings::default();
        // The course framework refines by five samples a frame.
        let lecture = s.preset == Some(Preset::Lecture);
        let samples_per_pass = if lecture { 5 } else { default.samples_per_pass };
        let method = s.irradiance;
        let (error, most) = (s.irradiance_error / 100.0, s.irradiance_samples);
        // The estimate takes milliseconds: only where it can spare samples.
        let samples = if method.is_sampled() && error > 0.0 {
            let estimate = ErrorEstimate::new(|direction| self.daylight.radiance(direction));
            estimate.samples(method, error, most)
        } else {
            most
        };
        IrradianceSettings {
            method,
            samples,
            samples_per_pass,
            ..default
        }
    }

    fn scale(&self) -> Scale {
        match (self.settings.scale, self.settings.exposure) {
            // The lecture's scale applies to its own unit, luminance / 683.
            (Some(scale), _) => Scale::Fixed(scale / LUMINOUS_EFFICACY),
            (None, Exposure::Ev100(ev100)) => Scale::Fixed(factor_from_ev100(ev100)),
            (None, Exposure::Auto) => Scale::Average(KEY),
        }
    }

    /// The command line that renders this view under this light, with these settings.
    ///
    /// # Errors
    /// As [`Settings::command_line`].
    pub fn command_line(&self) -> Result<String> {
        let settings = self.settings.with_camera(&self.camera);
        settings.command_line(self.path.as_deref(), &self.loaded)
    }

    /// What makes the picture again, and the numbers of its light.
    pub fn metadata(&self) -> Vec<(String, String)> {
        let rgb = |v: glam::DVec3| format!("{},{},{}", v.x, v.y, v.z);
        let point = |v: glam::Vec3| format!("{},{},{}", v.x, v.y, v.z);
        let mut list: Vec<(String, String)> = vec![
            (
                "Software".into(),
                concat!("skylight ", env!("CARGO_PKG_VERSION")).into(),
            ),
            ("scene".into(), self.name.clone()),
            ("eye".into(), point(self.camera.eye)),
            ("target".into(), point(self.camera.target)),
            ("fov".into(), self.camera.fov_deg.to_string()),
            (
                "sun azimuth".into(),
                format!("{} deg", self.sun.azimuth_deg),
            ),
            (
                "sun elevation".into(),
                format!("{} deg", self.sun.apparent_elevation_deg),
            ),
            (
                "sun illuminance".into(),
                format!("{} lux (RGB)", rgb(self.daylight.sun_illuminance)),
            ),
            (
                "sky illuminance".into(),
                format!("{} lux (RGB)", rgb(self.daylight.sky_irradiance_up)),
            ),
        ];
        // Missing only where a scene sets what these settings lack.
        list.extend(
            self.command_line()
                .ok()
                .map(|line| ("command".into(), line)),
        );
        let parameters = self.settings.parameters();
        list.extend(
            parameters
                .into_iter()
                .map(|(key, value)| (key.to_owned(), value)),
        );
        list
    }
}
