//! Shared by render, view and bench: resolves options into a scene, a daylight and frame settings.

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use glam::UVec2;

use super::hour::{NoHour, expand};
use super::light::{conditions, sun_position};
use super::sun_series::SunSeries;
use super::{check_strict, tell};
use crate::daylight::colour::luminance;
use crate::daylight::exposure::{KEY, automatic, factor_from_ev100, least_average};
use crate::daylight::false_colour::{Colours, Quantity};
use crate::daylight::glass::tinted;
use crate::daylight::sample_count::ErrorEstimate;
use crate::daylight::sky::Daylight;
use crate::daylight::spectrum::LUMINOUS_EFFICACY;
use crate::daylight::sun_position::SunPosition;
use crate::daylight::sunlight::LIMB_DARKENING;
use crate::error::{Error, Result};
use crate::frame::{Frame, FrameSettings, Sampling, Visibility};
use crate::gpu::{Context, ContextOptions, GpuError, Recorder};
use crate::options::{
    ByMaterial, Fresnel, Mirrors, OptionValues, Options, Penumbra, Phong, Preset,
};
use crate::output::{LATITUDE, LONGITUDE, MOMENT, WHITE_LUMINANCE, message};
use crate::passes::bounces::cells::Bounces;
use crate::passes::dome::gather::DomeSettings;
use crate::passes::light::lighting::{Ambient, Precision, Show};
use crate::passes::occlusion::ssao::SsaoSettings;
use crate::passes::picture::tone_map::{Scale, is_light};
use crate::passes::route::settle_route;
use crate::passes::sky::irradiance::IrradianceSettings;
use crate::scene::{self, Camera, LoadOptions, Loaded, Material, Scene, Subject};

/// Edge of a sky cube face with `--preset lecture`, texels.
const LECTURE_SKY_EDGE: u32 = 512;

/// Load options of a scene, with the cache folder unless `--no-cache` is set.
pub fn load_options(options: &Options) -> LoadOptions {
    let cache = cache_folder().filter(|_| !options.no_cache);
    LoadOptions {
        cache,
        ..options.load_options()
    }
}

/// Folder of processed scenes and pipeline caches, in the user's cache folder.
fn cache_folder() -> Option<PathBuf> {
    Some(dirs::cache_dir()?.join("skylight"))
}

/// Options for opening a device.
pub fn context_options(options: &Options) -> ContextOptions {
    ContextOptions {
        device: options.device.clone(),
        validate: options.validate,
        without: options.without.into_iter().collect(),
        cache_folder: cache_folder(),
        route: options.route.route(),
        fault: planned_fault(0),
        ..ContextOptions::default()
    }
}

/// For tests: the fault planned for the device that is opened as number `device`, from 0: one of a list, `submit@3=device-lost,..`.
pub fn planned_fault(device: usize) -> Option<String> {
    let list = std::env::var("SKYLIGHT_FAULT").ok()?;
    list.split(',').nth(device).map(str::to_owned)
}

/// Reports on stderr which fallbacks the device needs.
pub fn notice(context: &Context) {
    let device = context.summary();
    let missing = device.optional.iter().filter(|(_, used)| !used);
    for what in missing.filter_map(|(optional, _)| optional.fallback()) {
        message::notice(format!("\"{}\" has {what}", device.name));
    }
}

/// A scene in a daylight, with its camera and options.
pub struct Job {
    /// The options of the image.
    pub settings: Options,
    /// Geometry and materials.
    pub scene: Arc<Scene>,
    /// Materials of the model, without those of `--glass` and `--reflectance`.
    pub materials: Vec<Material>,
    /// What of the scene the default view shows.
    pub subject: Subject,
    /// The camera.
    pub camera: Camera,
    /// Position of the sun.
    pub sun: SunPosition,
    /// Sun and sky.
    pub daylight: Daylight,
    /// The suns whose hours are shown, if they are.
    pub suns: Option<SunSeries>,
    /// Name of the scene, for metadata.
    pub name: String,
    /// Path of the scene; `None` for the default bundled scene.
    pub path: Option<PathBuf>,
    /// The options of the scene file. Its model has been moved to `scene`.
    pub loaded: Loaded,
}

/// Takes the scene out of what was loaded, as the options want it but for [`set_materials`].
fn model_of(loaded: &mut Loaded, settings: &Options) -> Scene {
    let mut scene = std::mem::take(&mut loaded.scene);
    scene.scale_emission(settings.emission_scale as f32);
    if settings.phong != Phong::ByFormat {
        scene.use_phong();
    }
    scene
}

/// Takes the scene out of what was loaded, as the options want it.
///
/// # Errors
/// `--glass` or `--reflectance` of what the model lacks.
pub(super) fn scene_of(loaded: &mut Loaded, settings: &Options) -> Result<Scene> {
    let mut scene = model_of(loaded, settings);
    set_materials(&mut scene, settings)?;
    Ok(scene)
}

/// Gives materials the values of `--glass` and `--reflectance`.
///
/// # Errors
/// What the model lacks.
pub(super) fn set_materials(scene: &mut Scene, settings: &Options) -> Result<()> {
    let wrong =
        |option: &'static str| move |what: String| Error::usage(format!("--{option}: {what}"));
    if let Some(ByMaterial(list)) = &settings.reflectance {
        scene.set_reflectance(list).map_err(wrong("reflectance"))?;
    }
    if let Some(ByMaterial(list)) = &settings.glass {
        scene.set_glass(list, tinted).map_err(wrong("glass"))?;
    }
    Ok(())
}

/// Settings whose frames have the visibility of one sun each, and nothing else to compute.
fn of_suns(mut set: FrameSettings, suns: &SunSeries) -> FrameSettings {
    set.samples = suns.frames(set.samples);
    set.sampling.visibility = Visibility::Ssao;
    set.lighting.ambient = Ambient::Ssao;
    set.bounces = Bounces::UpTo(0);
    set.lighting.air = false;
    set.lighting.precision = Precision::Float;
    set.tone.hours = suns.hours;
    set
}

/// Illuminance by the sky below which radiance is kept in 32-bit floats: that of a sky of 1 cd/m².
const DARK_LUX: f64 = std::f64::consts::PI;

impl Job {
    /// Loads the scene and resolves the options. Tells the warnings ([`tell`]).
    ///
    /// # Errors
    /// A scene that cannot be read, invalid options, or a warning with `--strict`.
    pub fn new(path: Option<&Path>, user: &OptionValues) -> Result<Self> {
        let job = Self::untold(path, user)?;
        tell(&job.settings, job.warnings())?;
        Ok(job)
    }

    /// Like [`Job::new`], without telling its warnings.
    ///
    /// # Errors
    /// A scene that cannot be read, or invalid options.
    pub fn untold(path: Option<&Path>, user: &OptionValues) -> Result<Self> {
        let loaded = scene::load_with_progress(path, &load_options(&user.alone()?), &|_, _| ())?;
        Self::of(path, loaded, user)
    }

    /// Resolves the user's options over those of a loaded scene.
    ///
    /// # Errors
    /// Invalid options.
    pub fn of(path: Option<&Path>, mut loaded: Loaded, user: &OptionValues) -> Result<Self> {
        let moments = ["when", "solar", "sun", "moment"];
        let says_moment = moments.iter().any(|name| user.get(name).is_some());
        let no_hour = if says_moment {
            NoHour::PlaceAlone
        } else {
            NoHour::Refused
        };
        expand(&mut loaded, no_hour)?;
        let settings = Options::resolve(user, &loaded)?;
        let sun = sun_position(&settings)?;
        let daylight = Daylight::new(&conditions(&settings, &sun));
        let suns = SunSeries::of(&settings, None)?;
        let mut scene = model_of(&mut loaded, &settings);
        let materials = scene.materials.clone();
        set_materials(&mut scene, &settings)?;
        let mut subject = Subject::of(&scene);
        if settings.eye.is_none() && settings.target.is_none() {
            subject = subject.entered(&mut scene);
        }
        let camera = settings.camera(&subject, scene.origin);
        let name = path.map_or("bundled".to_owned(), |p| p.display().to_string());
        Ok(Self {
            settings,
            scene: Arc::new(scene),
            materials,
            subject,
            camera,
            sun,
            daylight,
            suns,
            name,
            path: path.map(Path::to_owned),
            loaded,
        })
    }

    /// Warnings about the scene and its light, one line each.
    pub fn warnings(&self) -> impl Iterator<Item = &String> + Clone {
        self.scene.warnings.iter().chain(&self.daylight.warnings)
    }

    /// Fails with the first warning if `--strict` is set.
    ///
    /// # Errors
    /// See above.
    pub fn check_strict(&self) -> Result<()> {
        check_strict(&self.settings, self.warnings())
    }

    /// Updates sun and daylight to these options.
    ///
    /// # Errors
    /// A moment that the ephemeris does not cover; the light is then unchanged.
    pub fn relight(&mut self, settings: &Options) -> Result<()> {
        self.sun = sun_position(settings)?;
        self.daylight = Daylight::new(&conditions(settings, &self.sun));
        Ok(())
    }

    /// Turns to another picture of the same scene: resolves other options of camera and moment. Tells what is new to warn of.
    ///
    /// # Errors
    /// Invalid options, or a warning with `--strict`.
    pub fn turn_to(&mut self, user: &OptionValues) -> Result<()> {
        let settings = Options::resolve(user, &self.loaded)?;
        self.suns = SunSeries::of(&settings, self.suns.take())?;
        let told = std::mem::take(&mut self.daylight.warnings);
        self.relight(&settings)?;
        let is_unseen = settings.eye.is_none() && settings.target.is_none();
        if is_unseen && self.subject.inside.is_none() {
            let scene = Arc::make_mut(&mut self.scene);
            self.subject = self.subject.entered(scene);
        }
        self.camera = settings.camera(&self.subject, self.scene.origin);
        self.settings = settings;
        let new = self.daylight.warnings.iter();
        tell(&self.settings, new.filter(|line| !told.contains(line)))
    }

    /// Like [`Job::new`], while another thread opens the device.
    ///
    /// # Errors
    /// See [`Job::new`]; also fails when there is no such device.
    pub fn on_device(path: Option<&Path>, user: &OptionValues) -> Result<(Self, Arc<Context>)> {
        let wanted = context_options(&user.alone()?);
        let (job, context) = thread::scope(|scope| {
            let context = scope.spawn(|| {
                let context = Context::new(&wanted)?;
                settle_route(&context)?;
                Ok::<_, GpuError>(context)
            });
            let job = Self::new(path, user);
            // A panic of the other thread is propagated.
            (
                job,
                context.join().unwrap_or_else(|fault| resume_unwind(fault)),
            )
        });
        let (job, context) = (job?, context?);
        if !(job.settings.quiet || job.settings.no_warnings) {
            notice(&context);
        }
        Ok((job, context))
    }

    /// The frame settings for displaying `show` in this daylight.
    pub fn frame_settings(&self, show: Show, precision: Precision) -> FrameSettings {
        let mut set = self.moving_settings(show, precision);
        set.irradiance.samples = self.irradiance_samples();
        set
    }

    /// The same for a daylight that may change in every frame: the number of irradiance samples does not depend on it.
    pub fn moving_settings(&self, show: Show, precision: Precision) -> FrameSettings {
        let s = &self.settings;
        let mut set = FrameSettings {
            size: UVec2::new(s.size.width, s.size.height),
            samples: s.samples,
            sampling: self.sampling(),
            irradiance: self.irradiance_settings(),
            shadow_resolution: s.shadow_size,
            bounces: s.bounces,
            refine: s.refine,
            aa: s.aa,
            ..FrameSettings::default()
        };
        if s.preset == Some(Preset::Lecture) {
            set.sky_edge = LECTURE_SKY_EDGE;
        }
        // Half floats of kcd/m² are too coarse for a dark sky.
        let is_dark = luminance(self.daylight.sky_irradiance_up) < DARK_LUX;
        set.lighting.precision = if is_dark { Precision::Float } else { precision };
        set.lighting.ambient = s.ambient;
        set.lighting.air = s.draws_air();
        set.lighting.specular_scale = s.specular as f32;
        if s.limb_darkening {
            set.lighting.limb_darkening = LIMB_DARKENING as f32;
        }
        set.lighting.fresnel = s.fresnel == Fresnel::Schlick;
        set.lighting.shadows.penumbrae = s.penumbra == Penumbra::Sun;
        set.lighting.mirrors = Mirrors {
            phong: s.phong,
            reflections: s.reflections,
        };
        set.tone.curve = s.tonemap;
        set.tone.scale = self.scale();
        set.tone.gamma = s.gamma;
        set.tone.depth_scale = f64::from(self.scene.bounds.diagonal()).max(1e-3);
        set.tone.false_colour = self.colours(show).map(|(_, colours)| colours);
        if let Some(suns) = self.suns.as_ref().filter(|_| show == Show::SunHours) {
            set = of_suns(set, suns);
        }
        set.showing(show).with_occlusion(SsaoSettings {
            radius: s.ao_radius as f32,
            downscale: s.ao_resolution.downscale(s.size.height),
            ..SsaoSettings::default()
        })
    }

    /// Quantity and colours of false colours for `show`, if they are asked for; their range is that of the options, or usual.
    pub fn colours(&self, show: Show) -> Option<(Quantity, Colours)> {
        let s = &self.settings;
        let quantity = s.false_colour.filter(|quantity| show.holds(*quantity))?;
        let of_suns = self.suns.as_ref().map(SunSeries::range);
        let usual = match quantity {
            Quantity::SunHours => of_suns.unwrap_or(quantity.daytime()),
            _ => quantity.daytime(),
        };
        let colours = Colours {
            range: s.false_colour_range.unwrap_or(usual),
            map: s.colour_map,
        };
        Some((quantity, colours))
    }

    /// Records frame number `index` of an average: of hours of sun, with the sun of that number.
    pub fn record(&self, frame: &mut Frame, rec: &mut Recorder, index: u32) {
        let (daylight, camera) = (&self.daylight, &self.camera);
        match self
            .suns
            .as_ref()
            .filter(|_| frame.settings().lighting.show == Show::SunHours)
        {
            Some(suns) => frame.record_under(rec, daylight, suns.direction(index), camera, index),
            None => frame.record(rec, daylight, camera, index),
        }
    }

    /// What a value of a picture of `show` is multiplied with for a file: cd/m², lux, hours.
    pub fn file_unit(&self, show: Show) -> f32 {
        match &self.suns {
            Some(suns) if show == Show::SunHours => suns.hours as f32,
            _ => show.file_unit(),
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
                by: s.dome_by,
                seed: s.seed,
                ..DomeSettings::default()
            },
        }
    }

    fn irradiance_settings(&self) -> IrradianceSettings {
        let s = &self.settings;
        let default = IrradianceSettings::default();
        // The course framework takes five samples per frame.
        let lecture = s.preset == Some(Preset::Lecture);
        let samples_per_pass = if lecture { 5 } else { default.samples_per_pass };
        IrradianceSettings {
            method: s.irradiance,
            samples: s.irradiance_samples,
            samples_per_pass,
            ..default
        }
    }

    /// Irradiance samples that bring the error below the one that is allowed.
    fn irradiance_samples(&self) -> u32 {
        let s = &self.settings;
        let (method, most) = (s.irradiance, s.irradiance_samples);
        let error = s.irradiance_error / 100.0;
        // The estimate takes milliseconds, so it is made only where it can save samples.
        if !method.is_sampled() || error <= 0.0 {
            return most;
        }
        let estimate = ErrorEstimate::new(|direction| self.daylight.radiance(direction));
        estimate.samples(method, error, most)
    }

    fn scale(&self) -> Scale {
        match (self.settings.scale, self.settings.ev100) {
            // The lecture's scale applies to its own unit, luminance / 683.
            (Some(scale), _) => Scale::Fixed(scale / LUMINOUS_EFFICACY),
            (None, Some(ev100)) => Scale::Fixed(factor_from_ev100(ev100)),
            (None, None) => Scale::Average {
                key: KEY,
                least: self.settings.min_ev100.map_or(0.0, least_average),
            },
        }
    }

    /// EV100 of the automatic exposure for a picture of this average luminance, cd/m².
    pub fn automatic_ev100(&self, average: f64) -> f64 {
        let least = self.settings.min_ev100.map_or(0.0, least_average);
        automatic(average.max(least))
    }

    /// The command line that renders this view with these options.
    ///
    /// # Errors
    /// See [`Options::command_line`].
    pub fn command_line(&self) -> Result<String> {
        let options = self.options_in_view();
        Ok(options.command_line(self.path.as_deref(), &self.loaded)?)
    }

    /// The options with the current camera.
    pub fn options_in_view(&self) -> Options {
        self.settings.with_camera(&self.camera, self.scene.origin)
    }

    /// What other programs read too, see [`crate::output::write_exr`]: where and when, and the luminance of a 1.
    fn standard(&self) -> Vec<(String, String)> {
        let mut list = Vec::new();
        if let Some((latitude, longitude, when)) = self.settings.sun.place() {
            list.push((LATITUDE.into(), latitude.to_string()));
            list.push((LONGITUDE.into(), longitude.to_string()));
            list.push((MOMENT.into(), when.to_rfc3339()));
        }
        let show = self.settings.show;
        if is_light(show) && show != Show::Irradiance {
            list.push((WHITE_LUMINANCE.into(), "1".to_owned()));
        }
        list
    }

    /// Metadata for the image file: the options that reproduce the image, and figures of its light.
    pub fn metadata(&self) -> Vec<(String, String)> {
        let rgb = |v: glam::DVec3| format!("{},{},{}", v.x, v.y, v.z);
        let mut list: Vec<(String, String)> = vec![
            (
                "Software".into(),
                concat!("skylight ", env!("CARGO_PKG_VERSION")).into(),
            ),
            ("scene".into(), self.name.clone()),
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
        list.extend(self.standard());
        if let Some(moon) = self.daylight.moon {
            let text = format!("{} lux (RGB)", rgb(moon.illuminance));
            list.push(("moon illuminance".into(), text));
        }
        // There is no command line when the scene sets an option that cannot be unset.
        list.extend(
            self.command_line()
                .ok()
                .map(|line| ("command".into(), line)),
        );
        list.extend(self.options_in_view().values().into_pairs());
        list
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::is_option;
    use crate::options::tests::{each_set, exposed_scene};

    #[test]
    fn phong_replaces_microfacets_if_it_is_asked_for() {
        let kept = |options: &[(&str, &str)]| {
            let mut loaded = exposed_scene();
            loaded.scene.materials = vec![crate::scene::Material {
                microfacet: Some(crate::scene::Microfacet {
                    base: [0.5; 3],
                    f0: [0.04; 3],
                    f90: 1.0,
                    metallic: 1.0,
                    roughness: 0.5,
                    texture: None,
                }),
                ..Default::default()
            }];
            let pairs = options
                .iter()
                .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()));
            let user = OptionValues::from(pairs.collect::<Vec<_>>());
            let job = Job::of(None, loaded, &user).expect("a job");
            job.scene.materials[0].microfacet.is_some()
        };
        assert!(kept(&[]) && kept(&[("phong", "by-format")]));
        for options in [
            ("phong", "lecture"),
            ("phong", "normalized"),
            ("preset", "lecture"),
        ] {
            assert!(!kept(&[options]), "{options:?}");
        }
    }

    #[test]
    fn metadata_give_every_option_again() {
        let all = each_set(&exposed_scene());
        let mut seen = 0;
        for (name, options) in all {
            let mut loaded = exposed_scene();
            if name == "reflectance" {
                // Panes have none.
                loaded.scene.materials[0].glass = None;
            }
            let job = Job::of(None, loaded, &options.values()).expect(&name);
            let list = job.metadata().into_iter();
            let pairs: Vec<_> = list.filter(|(name, _)| is_option(name)).collect();
            let again = Options::resolve(&OptionValues::from(pairs), &job.loaded).expect(&name);
            assert_eq!(again, job.options_in_view(), "{name}");
            seen += 1;
        }
        assert!(seen > 100, "{seen}");
    }
}
