//! The open scene: its options, daylight and camera, and the progress of its image.

mod following;
mod hours;

use std::any::Any;
use std::path::PathBuf;
use std::sync::Arc;

use crate::commands::hour::{NoHour, expand};
use crate::commands::job::Job;
use crate::daylight::hdr::PAPER_WHITE;
use crate::daylight::sun_position::azimuth_elevation;
use crate::daylight::weather::Weather;
use crate::error::Result;
use crate::frame::{Frame, FrameSettings};
use crate::gpu::{Context, Image, Recorder, Timing};
use crate::options::{AntiAliasing, OptionValues, Options, Size, SunInput, Visibility, name};
use crate::passes::light::lighting::Precision;
use crate::passes::light::probe::Reading;
use crate::passes::picture::tone_map::{Scale, ToneSettings};
use crate::scene::{Camera, Loaded};

use super::adaptation::Adaptation;
use super::background::Wake;
use super::controls::{Controls, FlyKeys};
use super::desk::{Desk, Grid};
use super::grid_overlay::GridOverlay;
use super::interface::Notes;
use super::keys::Action;
use super::light_ahead::LightAhead;
use super::passes_ahead::PassesAhead;
use super::stage::Screen;
use super::surfaces::Surfaces;
use super::viewpoints::{Viewpoint, Viewpoints};
use super::year::Year;

/// Default of `--samples` in the window: number of frames averaged at rest.
pub(super) const REST_SAMPLES: u32 = 64;

/// Default of `--dome-directions` in the window.
const REST_DIRECTIONS: u32 = 4;

/// An open scene.
pub(super) struct Document {
    /// Scene, options and daylight. Call [`Document::follow`] after changing the options.
    pub(super) job: Job,
    /// Camera controls.
    pub(super) controls: Controls,
    /// Viewpoints: named and saved cameras.
    pub(super) viewpoints: Viewpoints,
    /// The hours of a weather file, if there is one.
    pub(super) year: Option<Year>,
    /// Sensors, if a grid was asked for.
    pub(super) desk: Option<Desk>,
    /// Reflectances that are changed.
    pub(super) surfaces: Surfaces,
    /// What went wrong beside, to be told once.
    pub(super) fault: Option<String>,
    overlay: GridOverlay,
    frame: Frame,
    /// Options that the frame was last updated to.
    followed: Options,
    light: LightAhead,
    passes: PassesAhead,
    /// Passes whose place others took; frames in flight may still use them.
    replaced: Vec<Box<dyn Any + Send>>,
    /// Camera of the newest frame; `None` restarts the average.
    drawn: Option<Camera>,
    /// Number of frames in the average.
    averaged: u32,
    adaptation: Adaptation,
    /// Number of frames drawn since the scene was opened.
    frames: u64,
    /// What the window can show; the frame may be behind.
    screen: Screen,
    is_hdr: bool,
}

/// A document without a device.
pub(super) struct Aside {
    job: Job,
    controls: Controls,
    viewpoints: Viewpoints,
    year: Option<Year>,
    desk: Option<Desk>,
    fault: Option<String>,
    light: LightAhead,
    frames: u64,
}

/// What a user asks for: options, the weather file of the command line, a grid of sensors.
#[derive(Clone)]
pub(super) struct Asked {
    pub(super) options: OptionValues,
    pub(super) weather: Option<Arc<Weather>>,
    pub(super) grid: Option<Grid>,
}

/// The device of a window, and how its event loop is woken.
pub(super) type Device<'a> = (&'a Arc<Context>, &'a Wake);

impl Aside {
    /// Uploads the scene and makes the passes, by this thread; frames of a window may go on meanwhile.
    ///
    /// # Errors
    /// Not enough device memory for the scene, or a lost device.
    pub(super) fn on(self, (context, wake): Device<'_>, screen: Screen) -> Result<Document> {
        let mut recorder = Recorder::new(context, Timing::Off)?;
        recorder.begin()?;
        let settings = frame_settings(&self.job, screen.is_hdr);
        let frame = Frame::new(&mut recorder, &self.job.scene, settings);
        match frame {
            Ok(_) => recorder.finish()?,
            Err(_) => recorder.abandon()?,
        }
        Ok(Document {
            surfaces: Surfaces::new(
                (context, wake),
                &self.job.scene,
                self.job.materials.clone(),
                &self.job.settings,
            ),
            overlay: GridOverlay::new(context),
            frame: frame?,
            passes: PassesAhead::new(wake, recorder),
            replaced: Vec::new(),
            // Passes of options that were not followed yet are among those just made.
            followed: self.job.settings.clone(),
            job: self.job,
            controls: self.controls,
            viewpoints: self.viewpoints,
            year: self.year,
            desk: self.desk,
            fault: self.fault,
            light: self.light,
            frames: self.frames,
            drawn: None,
            averaged: 0,
            adaptation: Adaptation::default(),
            is_hdr: screen.is_hdr,
            screen,
        })
    }
}

impl Document {
    /// Opens a loaded scene, by this thread; frames of the window may go on meanwhile.
    ///
    /// # Errors
    /// Invalid options, not enough device memory for the scene, or a lost device.
    pub(super) fn open(
        device: Device<'_>,
        path: Option<PathBuf>,
        mut loaded: Loaded,
        asked: Asked,
        (size, screen): (Size, Screen),
    ) -> Result<Self> {
        let user = at_rest(asked.options, size);
        let of_scene = expand(&mut loaded, NoHour::Chosen)?;
        let job = Job::of(path.as_deref(), loaded, &user)?;
        let weather = asked.weather.or(of_scene);
        // A grid that cannot be made is told of; the scene is shown without.
        let desk = asked
            .grid
            .map(|grid| Desk::new(&grid, &job, weather.clone(), device.1));
        let (desk, fault) = match desk.transpose() {
            Ok(desk) => (desk, None),
            Err(error) => (None, Some(error.to_string())),
        };
        let year = weather.map(|weather| Year::new(weather, &job.settings));
        let viewpoints = named_cameras(&job, &user);
        let aside = Aside {
            controls: Controls::new(&job.camera, &job.scene.bounds),
            viewpoints,
            year,
            desk,
            fault,
            light: LightAhead::new(&job.settings, device.1),
            frames: 0,
            job,
        };
        aside.on(device, screen)
    }

    /// Gives up the device, and keeps scene, options and view.
    pub(super) fn lay_aside(self) -> Aside {
        Aside {
            job: self.job,
            controls: self.controls,
            viewpoints: self.viewpoints,
            year: self.year,
            desk: self.desk,
            fault: self.fault,
            light: self.light,
            frames: self.frames,
        }
    }

    /// Sets what the window can show.
    pub(super) fn set_screen(&mut self, screen: Screen) {
        self.screen = screen;
    }

    /// What the window can show.
    pub(super) fn screen(&self) -> Screen {
        self.screen
    }

    /// Performs a key's action on scene and daylight, and reports it in `notes`.
    pub(super) fn perform(&mut self, action: Action, notes: &mut Notes) {
        match action {
            Action::FrameAll => self.frame_all(),
            Action::SaveViewpoint => {
                let name = self.viewpoints.save(self.controls.camera());
                notes.say(&format!("kept viewpoint {name}"));
            }
            Action::NextViewpoint => {
                if let Some(viewpoint) = self.viewpoints.cycle() {
                    notes.say(&format!("viewpoint {}", viewpoint.name));
                    self.controls.go_to(&viewpoint.camera);
                }
            }
            Action::Shift(steps) => self.shift(steps),
            Action::LightFromView => {
                let behind = -self.controls.camera().forward().as_dvec3();
                let (azimuth_deg, elevation_deg) = azimuth_elevation(behind);
                self.job.settings.sun = SunInput::Direction {
                    azimuth_deg,
                    elevation_deg,
                };
            }
            Action::Show(show) => {
                self.job.settings.show = show;
                self.job.settings.show_in_colours();
                notes.say(crate::options::name(show));
            }
            _ => {}
        }
    }

    /// Moves the camera so that the whole subject is in view.
    pub(super) fn frame_all(&mut self) {
        let size = self.job.settings.size;
        let aspect = size.width as f32 / size.height.max(1) as f32;
        self.controls.frame_all(&self.job.subject.bounds, aspect);
    }

    /// Jumps to `camera`.
    pub(super) fn set_camera(&mut self, camera: &Camera) {
        self.controls.go_to(camera);
        self.controls.arrive();
    }

    /// Advances the camera by `seconds` with these keys held.
    pub(super) fn advance(&mut self, seconds: f64, keys: FlyKeys) {
        self.controls.advance(seconds, keys);
        self.adaptation.advance(seconds);
        self.job.camera = self.controls.camera();
    }

    /// Restarts the average.
    pub(super) fn start_over(&mut self) {
        self.drawn = None;
    }

    /// Whether all samples of the frame's options are drawn and the exposure has adapted.
    pub(super) fn is_at_rest(&self) -> bool {
        self.is_averaged() && self.adaptation.is_done()
    }

    /// Whether the average is complete.
    fn is_averaged(&self) -> bool {
        !self.has_moved() && self.averaged >= self.samples()
    }

    fn has_moved(&self) -> bool {
        self.drawn != Some(self.job.camera)
    }

    /// Number of frames in the average, and its target.
    pub(super) fn progress(&self) -> (u32, u32) {
        (self.averaged, self.samples())
    }

    /// Number of frames of an average.
    fn samples(&self) -> u32 {
        self.frame.settings().samples
    }

    /// Records the next frame: a preview while the camera moves or the irradiance is being refined, then the samples of the
    /// average, then only the exposure until it has adapted, then nothing.
    pub(super) fn record(&mut self, recorder: &mut Recorder) {
        for passes in self.replaced.drain(..) {
            recorder.keep(passes);
        }
        let is_new = self.record_picture(recorder);
        self.record_grid(recorder, is_new);
    }

    /// As [`Document::record`], without the grid; whether there is another picture.
    fn record_picture(&mut self, recorder: &mut Recorder) -> bool {
        if self.is_at_rest() {
            return false;
        }
        let (daylight, camera) = (&self.job.daylight, &self.job.camera);
        let is_preview = self.has_moved() || !self.frame.is_refined();
        if is_preview {
            self.adaptation.restart();
        }
        if !matches!(self.frame.settings().tone.scale, Scale::Average { .. }) {
            self.adaptation.cut();
        }
        let is_last = !is_preview && self.averaged + 1 >= self.samples();
        self.frame.set_adaptation(self.adaptation.share(is_last));
        if self.is_averaged() {
            self.frame.expose(recorder);
            return true;
        }
        if is_preview {
            self.frame.preview(recorder, daylight, camera);
            self.averaged = 0;
        } else {
            self.job.record(&mut self.frame, recorder, self.averaged);
            self.averaged += 1;
        }
        self.drawn = Some(self.job.camera);
        self.frames += 1;
        true
    }

    /// Number of frames drawn since the scene was opened.
    pub(super) fn frames(&self) -> u64 {
        self.frames
    }

    /// The image in display values.
    pub(super) fn display(&self) -> &Image {
        self.overlay.image().unwrap_or(self.frame.display())
    }

    /// The frame, for reading back its images.
    pub(super) fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Tone maps the newest image again: for an HDR screen of this peak, or for a file. `recorder` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub(super) fn retone(&mut self, recorder: &mut Recorder, peak: Option<f64>) -> Result<()> {
        let tone = ToneSettings {
            peak,
            ..self.frame.settings().tone
        };
        Ok(self.frame.retone(recorder, tone)?)
    }

    /// Records the read-back of one pixel of the newest image.
    pub(super) fn pick(&mut self, recorder: &mut Recorder, pixel: [u32; 2]) {
        self.frame.pick(recorder, pixel);
    }

    /// The pixel read back, once the device has finished.
    pub(super) fn picked(&mut self) -> Option<Reading> {
        self.frame.picked()
    }

    /// The command line that renders this image.
    ///
    /// # Errors
    /// See [`Job::command_line`].
    pub(super) fn command(&self) -> Result<String> {
        self.job.command_line()
    }

    /// File name of the scene.
    pub(super) fn title(&self) -> String {
        let name = self.job.path.as_deref().and_then(|p| p.file_name());
        name.map_or("bundled scene".to_owned(), |n| {
            n.to_string_lossy().into_owned()
        })
    }
}

/// The user's options with the window's size and defaults: enough samples at rest for the true visibility of the sky (except with
/// the lecture preset), fewer directions per frame than for a file, which keeps frames short when motion resumes, and anti-aliasing.
fn at_rest(mut options: OptionValues, size: Size) -> OptionValues {
    options.set("size", size);
    if options.get("preset").is_some() {
        options.set_default("visibility", Visibility::Ssao);
    }
    options.set_default("samples", REST_SAMPLES);
    options.set_default("aa", name(AntiAliasing::Taa));
    options.set_default("dome-directions", REST_DIRECTIONS);
    options
}

/// Frame settings for the screen.
fn frame_settings(job: &Job, is_hdr: bool) -> FrameSettings {
    let mut settings = job.moving_settings(job.settings.show, Precision::Half);
    settings.tone.peak = is_hdr.then_some(job.settings.hdr_peak / PAPER_WHITE);
    settings.sampling.dome.illuminance = true;
    // Single frames while something moves; at rest the image fades over to the converging one.
    if settings.sampling.visibility == Visibility::Dome {
        settings.sampling.visibility = Visibility::Progressive;
    }
    settings
}

/// Viewpoints of the cameras named in the scene file.
fn named_cameras(job: &Job, user: &OptionValues) -> Viewpoints {
    let loaded = &job.loaded;
    let camera = |name: &str| -> Option<Camera> {
        let mut user = user.clone();
        user.remove(&["eye", "target", "fov"]);
        user.set("camera", name);
        let options = Options::resolve(&user, loaded).ok()?;
        Some(options.camera(&job.subject, job.scene.origin))
    };
    let list = loaded.cameras.iter().filter_map(|named| {
        Some(Viewpoint {
            name: named.name.clone(),
            camera: camera(&named.name)?,
        })
    });
    Viewpoints::new(list.collect())
}
