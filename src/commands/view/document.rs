//! What the window shows: a scene under a daylight, the camera in the hand, and how far its picture is refined.

use std::path::PathBuf;

use crate::commands::job::Job;
use crate::daylight::sun_position::azimuth_elevation;
use crate::error::Result;
use crate::frame::{Frame, FrameSettings};
use crate::gpu::{Image, Recorder};
use crate::passes::light::lighting::Precision;
use crate::passes::light::probe::Reading;
use crate::passes::picture::tone_map::Scale;
use crate::scene::{Camera, Loaded};
use crate::settings::{Options, Settings, Size, SunInput, Visibility};

use super::adaptation::Adaptation;
use super::controls::{Controls, FlyKeys};
use super::interface::{Notes, shift};
use super::keys::Action;
use super::viewpoints::{Viewpoint, Viewpoints};

/// Frames averaged at rest, unless the user says otherwise.
pub(super) const REST_SAMPLES: u32 = 64;

/// Directions of the sky in each of them, unless the user says otherwise.
const REST_DIRECTIONS: u32 = 4;

/// A scene that is open.
pub(super) struct Document {
    /// Scene, settings, light. Who changes the settings calls [`Document::follow`].
    pub(super) job: Job,
    /// The camera in the hand.
    pub(super) controls: Controls,
    /// Places to come back to.
    pub(super) viewpoints: Viewpoints,
    frame: Frame,
    /// The settings that light and frame follow.
    followed: Settings,
    /// Camera of the newest frame.
    drawn: Option<Camera>,
    /// Frames in the average.
    averaged: u32,
    adaptation: Adaptation,
    /// Frames drawn since it was opened.
    frames: u64,
}

impl Document {
    /// Takes over a scene that is loaded; `recorder` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// Options that make no sense, or a device without memory for the scene.
    pub(super) fn open(
        recorder: &mut Recorder,
        path: Option<PathBuf>,
        loaded: Loaded,
        options: &Options,
        size: Size,
    ) -> Result<Self> {
        let viewpoints = named_cameras(&loaded, options, size);
        let options = Options {
            size: Some(size),
            ..options.clone()
        };
        let options = at_rest(options, &loaded);
        let mut job = Job::of(path.as_deref(), loaded, options)?;
        // What moves is drawn with ambient occlusion; at rest the picture goes over from that.
        if job.settings.visibility == Visibility::Dome {
            job.settings.visibility = Visibility::Progressive;
        }
        let frame = Frame::new(recorder, &job.scene, frame_settings(&job))?;
        Ok(Self {
            controls: Controls::new(&job.camera, &job.scene.bounds),
            viewpoints,
            followed: job.settings.clone(),
            frame,
            job,
            drawn: None,
            averaged: 0,
            adaptation: Adaptation::default(),
            frames: 0,
        })
    }

    /// Does what a key asks of the scene and its light; what it did goes to `notes`.
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
            Action::ShiftHours(hours) => shift(&mut self.job.settings.sun, hours * 3600.0),
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
                notes.say(show.name());
            }
            _ => {}
        }
    }

    /// Travels to where everything is in view.
    pub(super) fn frame_all(&mut self) {
        let size = self.job.settings.size;
        let aspect = size.width as f32 / size.height.max(1) as f32;
        self.controls.frame_all(&self.job.scene.bounds, aspect);
    }

    /// Takes up another camera at once.
    pub(super) fn set_camera(&mut self, camera: &Camera) {
        self.controls.go_to(camera);
        self.controls.arrive();
    }

    /// Lets time pass with these keys of flight held.
    pub(super) fn advance(&mut self, seconds: f64, keys: FlyKeys) {
        self.controls.advance(seconds, keys);
        self.adaptation.advance(seconds);
        self.job.camera = self.controls.camera();
    }

    /// Whether light and frame lag behind the settings.
    pub(super) fn is_behind(&self) -> bool {
        self.job.settings != self.followed
    }

    /// Brings light and frame up with the settings. `recorder` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// Settings that cannot be followed: they are as they were, then.
    pub(super) fn follow(&mut self, recorder: &mut Recorder) -> Result<()> {
        let followed = self.try_follow(recorder);
        if followed.is_err() {
            self.job.settings = self.followed.clone();
            // It held before, so it does again.
            self.job.relight()?;
        }
        self.followed = self.job.settings.clone();
        self.start_over();
        followed
    }

    fn try_follow(&mut self, recorder: &mut Recorder) -> Result<()> {
        if self.job.settings.show != self.followed.show {
            self.adaptation.cut();
        }
        if light_of(&self.job.settings) != light_of(&self.followed) {
            self.job.relight()?;
        }
        let wanted = frame_settings(&self.job);
        if wanted != *self.frame.settings() {
            self.frame.apply(recorder, wanted)?;
        }
        Ok(())
    }

    /// Makes everything that the device holds anew: after its shaders changed. `recorder` must be recording.
    ///
    /// # Errors
    /// When the device refuses; the old frame stays.
    #[cfg(feature = "hot-reload")]
    pub(super) fn rebuild(&mut self, recorder: &mut Recorder) -> Result<()> {
        self.frame = Frame::new(recorder, &self.job.scene, frame_settings(&self.job))?;
        self.start_over();
        Ok(())
    }

    /// Begins the average anew.
    pub(super) fn start_over(&mut self) {
        self.drawn = None;
    }

    /// Whether the picture is as good as it gets, and the exposure has adapted to it.
    pub(super) fn is_at_rest(&self) -> bool {
        self.is_averaged() && self.adaptation.is_done()
    }

    /// Whether the average has all its frames.
    fn is_averaged(&self) -> bool {
        !self.is_behind() && !self.has_moved() && self.averaged >= self.job.settings.samples
    }

    fn has_moved(&self) -> bool {
        self.drawn != Some(self.job.camera)
    }

    /// Frames in the average, and in all.
    pub(super) fn progress(&self) -> (u32, u32) {
        (self.averaged, self.job.settings.samples)
    }

    /// Records what is to be drawn of it now: a preview while it moves or its light refines, then the frames of an average,
    /// then only the exposure until it has adapted, then nothing.
    pub(super) fn record(&mut self, recorder: &mut Recorder) {
        if self.is_at_rest() {
            return;
        }
        let (daylight, camera) = (&self.job.daylight, &self.job.camera);
        let is_preview = self.has_moved() || !self.frame.is_refined();
        if is_preview {
            self.adaptation.restart();
        }
        if !matches!(self.frame.settings().tone.scale, Scale::Average(_)) {
            self.adaptation.cut();
        }
        let is_last = !is_preview && self.averaged + 1 >= self.job.settings.samples;
        self.frame.set_adaptation(self.adaptation.share(is_last));
        if self.is_averaged() {
            self.frame.expose(recorder);
            return;
        }
        if is_preview {
            self.frame.preview(recorder, daylight, camera);
            self.averaged = 0;
        } else {
            self.frame.record(recorder, daylight, camera, self.averaged);
            self.averaged += 1;
        }
        self.drawn = Some(self.job.camera);
        self.frames += 1;
    }

    /// Frames drawn since it was opened: another number, another picture.
    pub(super) fn frames(&self) -> u64 {
        self.frames
    }

    /// The picture in display values.
    pub(super) fn display(&self) -> &Image {
        self.frame.display()
    }

    /// The frame, to read its images.
    pub(super) fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Records the question what a pixel shows.
    ///
    /// # Errors
    /// When memory is out.
    pub(super) fn ask(&mut self, recorder: &mut Recorder, pixel: [u32; 2]) -> Result<()> {
        Ok(self.frame.ask(recorder, &self.job.daylight, pixel)?)
    }

    /// The answer, when the work is done.
    pub(super) fn reading(&mut self) -> Option<Reading> {
        self.frame.reading()
    }

    /// The command that renders this picture, for a shell.
    ///
    /// # Errors
    /// What no option can say.
    pub(super) fn command(&self) -> Result<String> {
        self.job.command_line()
    }

    /// Name of the scene, without its folder.
    pub(super) fn title(&self) -> String {
        let name = self.job.path.as_deref().and_then(|p| p.file_name());
        name.map_or("bundled scene".to_owned(), |n| {
            n.to_string_lossy().into_owned()
        })
    }
}

/// The options of a picture at rest, where nothing is said of them: samples enough for the sky's true visibility, but with the
/// lecture's preset, which has its own; and fewer directions a frame than for a file, since the window is to answer soon when
/// something moves again.
fn at_rest(options: Options, loaded: &Loaded) -> Options {
    let unsaid = |key: &str| loaded.options.iter().all(|(name, _)| name != key);
    let is_preset = options.preset.is_some() || !unsaid("preset");
    let by_screen = (is_preset && unsaid("visibility")).then_some(Visibility::Ssao);
    let samples = unsaid("samples").then_some(REST_SAMPLES);
    let directions = unsaid("dome-directions").then_some(REST_DIRECTIONS);
    Options {
        samples: options.samples.or(samples),
        visibility: options.visibility.or(by_screen),
        dome_directions: options.dome_directions.or(directions),
        ..options
    }
}

/// The settings of a frame for the screen. The number of irradiance samples does not follow the light, so that the sun can be
/// dragged without making the map anew.
fn frame_settings(job: &Job) -> FrameSettings {
    let mut settings = job.frame_settings(job.settings.show, Precision::Half);
    settings.irradiance.samples = job.settings.irradiance_samples;
    settings
}

/// What of the settings decides the light.
fn light_of(settings: &Settings) -> impl PartialEq + use<> {
    (
        settings.sun,
        (settings.sun_position, settings.refraction),
        (settings.sky, settings.turbidity),
        (settings.sky_illuminance, settings.ground_albedo),
    )
}

/// The cameras that the scene file names, as viewpoints.
fn named_cameras(loaded: &Loaded, options: &Options, size: Size) -> Viewpoints {
    let camera = |name: &str| -> Option<Camera> {
        let options = Options {
            size: Some(size),
            camera: Some(name.to_owned()),
            eye: None,
            target: None,
            fov: None,
            ..options.clone()
        };
        let settings = Settings::resolve(options, loaded).ok()?;
        Some(settings.camera(&loaded.scene.bounds))
    };
    let list = loaded.cameras.iter().filter_map(|named| {
        Some(Viewpoint {
            name: named.name.clone(),
            camera: camera(&named.name)?,
        })
    });
    Viewpoints::new(list.collect())
}
