//! How well the picture of a moving view is anti-aliased: a walk, each frame against the mean of many samples at the same camera.
//!
//! `cargo run --release --example walk -- SCENE [OPTION=VALUE ..] [frames=N] [truth=N] [dome] [pace=METRES] [turn=DEGREES] [out=FOLDER]`, for instance
//! `walk colonnade camera=pool size=480x270 ambient=ssao bounces=0 ao-radius=0`, where nothing but the sampling differs. Other pairs are options of `skylight render`. It prints for each anti-aliasing the mean FLIP, and the flicker: the energy above 5 Hz,
//! at 60 frames a second, of what the luma of a pixel differs by from the truth, over pixels at edges of the truth. The truth is the mean of jittered frames; with `dome` it
//! is the converged picture.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use glam::{Quat, UVec2, Vec3};
use skylight::compare::{Picture, flip};
use skylight::daylight::sky::{Conditions, Daylight};
use skylight::frame::{AntiAliasing, Frame, FrameSettings, Visibility};
use skylight::gpu::{Context, ContextOptions, Recorder, Timing, read_back};
use skylight::options::{Choice, OptionValues, Options, name};
use skylight::output::{Effort, Encoding, write_png};
use skylight::passes::occlusion::ssao::SsaoSettings;
use skylight::passes::picture::tone_map::Scale;
use skylight::scene::{Camera, LoadOptions, Scene, Subject, load_with_progress};

/// Frames before the first one that is compared.
const LEAD: u32 = 16;
/// Frames a second, and the frequency from which changes flicker, Hz.
const RATE: f64 = 60.0;
const FLICKER: f64 = 5.0;
/// Difference of luma to a neighbour that makes an edge.
const EDGE: f32 = 0.1;

type Outcome<T> = Result<T, Box<dyn Error>>;

struct Walk {
    scene: Scene,
    camera: Camera,
    daylight: Daylight,
    settings: FrameSettings,
    recorder: Recorder,
    frames: u32,
    samples: u32,
    pace: f32,
    turn: f32,
    is_dome: bool,
    folder: Option<PathBuf>,
}

fn pairs() -> (PathBuf, Vec<(String, String)>) {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "colonnade".to_owned());
    let split = |text: String| match text.split_once('=') {
        Some((key, value)) => (key.to_owned(), value.to_owned()),
        None => (text, String::new()),
    };
    (scene.into(), arguments.map(split).collect())
}

impl Walk {
    fn new() -> Outcome<Self> {
        let (path, mut pairs) = pairs();
        let mut take = |key: &str| {
            let at = pairs.iter().position(|(name, _)| name == key)?;
            Some(pairs.remove(at).1)
        };
        let frames = take("frames").map_or(Ok(60), |n| n.parse())?;
        let samples = take("truth").map_or(Ok(64), |n| n.parse())?;
        let pace = take("pace").map_or(Ok(1.4 / RATE as f32), |n| n.parse())?;
        let turn = take("turn").map_or(Ok(0.1f32), |n| n.parse())?;
        let (is_dome, folder) = (take("dome").is_some(), take("out").map(PathBuf::from));
        let user = OptionValues::from(pairs);
        let mut loaded = load_with_progress(Some(&path), &LoadOptions::default(), &|_, _| ())?;
        let options = Options::resolve(&user, &loaded)?;
        let mut scene = std::mem::take(&mut loaded.scene);
        let subject = Subject::of(&scene).entered(&mut scene);
        let camera = options.camera(&subject, scene.origin);
        let context = Context::new(&ContextOptions::default())?;
        #[cfg(feature = "hot-reload")]
        context.reload_shaders()?;
        let mut settings = FrameSettings {
            size: UVec2::new(options.size.width, options.size.height),
            ..FrameSettings::default()
        };
        (settings.lighting.ambient, settings.bounces) = (options.ambient, options.bounces);
        settings.refine = options.refine;
        settings = settings.with_occlusion(SsaoSettings {
            radius: options.ao_radius as f32,
            ..settings.ssao
        });
        settings.tone.scale = Scale::Average {
            key: skylight::daylight::exposure::KEY,
            least: 0.0,
        };
        Ok(Self {
            scene,
            camera,
            daylight: Daylight::new(&Conditions {
                sun_azimuth_deg: 220.0,
                sun_elevation_deg: 35.0,
                ..Conditions::default()
            }),
            settings,
            recorder: Recorder::new(&context, Timing::Off)?,
            frames,
            samples,
            pace,
            turn: turn.to_radians(),
            is_dome,
            folder,
        })
    }

    /// The camera of a frame: a step forward and a turn to the side each.
    fn camera(&self, index: u32) -> Camera {
        let (mut eye, mut ahead) = (self.camera.eye, self.camera.target - self.camera.eye);
        let turn = Quat::from_rotation_y(self.turn);
        for _ in 0..index {
            ahead = turn * ahead;
            eye += (ahead * Vec3::new(1.0, 0.0, 1.0)).normalize_or_zero() * self.pace;
        }
        Camera {
            eye,
            target: eye + ahead,
            ..self.camera
        }
    }

    fn run<T>(&mut self, work: impl FnOnce(&mut Recorder) -> T) -> Outcome<T> {
        self.recorder.begin()?;
        let result = work(&mut self.recorder);
        self.recorder.finish()?;
        Ok(result)
    }

    fn frame(&mut self, settings: FrameSettings) -> Outcome<Frame> {
        self.recorder.begin()?;
        let frame = Frame::new(&mut self.recorder, &self.scene, settings)?;
        self.recorder.finish()?;
        Ok(frame)
    }

    fn picture(&mut self, frame: &Frame, file: &str) -> Outcome<Picture> {
        let pixels = read_back(&mut self.recorder, frame.display())?;
        if let Some(folder) = &self.folder {
            let how = (Encoding::Srgb, Effort::Quick);
            write_png(
                &folder.join(file),
                pixels.size,
                &pixels.bytes,
                how,
                &Vec::new(),
            )?;
        }
        let size = pixels.size.map(|edge| edge as usize);
        let rgb: Vec<u8> = pixels
            .bytes
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect();
        Ok(Picture::from_srgb8(size, &rgb))
    }

    /// The pictures of the walk as a moving view has them.
    fn moving(&mut self, aa: AntiAliasing) -> Outcome<Vec<Picture>> {
        let mut frame = self.frame(FrameSettings {
            aa,
            ..self.settings
        })?;
        let mut pictures = Vec::new();
        for index in 0..LEAD + self.frames {
            let (camera, daylight) = (self.camera(index), self.daylight.clone());
            self.run(|rec| frame.preview(rec, &daylight, &camera))?;
            if index >= LEAD {
                pictures.push(self.picture(&frame, &format!("{}-{index:03}.png", name(aa)))?);
            }
        }
        Ok(pictures)
    }

    /// The pictures of many samples.
    fn truth(&mut self) -> Outcome<Vec<Picture>> {
        let mut settings = self.settings;
        settings.samples = self.samples;
        if self.is_dome {
            settings.sampling.visibility = Visibility::Dome;
        }
        let mut frame = self.frame(settings)?;
        let mut pictures = Vec::new();
        for index in LEAD..LEAD + self.frames {
            let (camera, daylight) = (self.camera(index), self.daylight.clone());
            // After a frame of a moving view an average goes on with its cells.
            self.run(|rec| frame.preview(rec, &daylight, &camera))?;
            for sample in 0..self.samples {
                self.run(|rec| frame.record(rec, &daylight, &camera, sample))?;
            }
            pictures.push(self.picture(&frame, &format!("truth-{index:03}.png"))?);
        }
        Ok(pictures)
    }
}

/// Luma of the sRGB curve, roughly.
fn luma(picture: &Picture) -> Vec<f32> {
    picture.luminance().into_iter().map(f32::sqrt).collect()
}

/// Pixels at edges.
fn edges(size: [usize; 2], luma: &[f32]) -> Vec<bool> {
    let [width, height] = size;
    let at = |x: usize, y: usize| luma[y * width + x];
    let is_edge = |i: usize| {
        let (x, y) = (i % width, i / width);
        let near = [(x + 1 < width, 1, 0), (y + 1 < height, 0, 1)];
        near.iter()
            .any(|(inside, dx, dy)| *inside && (at(x, y) - at(x + dx, y + dy)).abs() > EDGE)
    };
    (0..width * height).map(is_edge).collect()
}

/// Mean energy of the errors at frequencies above [`FLICKER`], over pixels that are at an edge in any frame.
fn flicker(test: &[Picture], truth: &[Picture]) -> f64 {
    let lumas = |list: &[Picture]| list.iter().map(luma).collect::<Vec<_>>();
    let (test_luma, true_luma) = (lumas(test), lumas(truth));
    let size = truth[0].size;
    let all: Vec<Vec<bool>> = true_luma.iter().map(|luma| edges(size, luma)).collect();
    let (frames, mut energy, mut count) = (truth.len(), 0.0, 0);
    for pixel in (0..size[0] * size[1]).filter(|p| all.iter().any(|frame| frame[*p])) {
        let errors = |t: usize| f64::from(test_luma[t][pixel] - true_luma[t][pixel]);
        count += 1;
        for k in 1..=frames / 2 {
            if k as f64 * RATE / frames as f64 <= FLICKER {
                continue;
            }
            let step = TAU * k as f64 / frames as f64;
            let (mut re, mut im) = (0.0, 0.0);
            for t in 0..frames {
                let (sin, cos) = (step * t as f64).sin_cos();
                re += errors(t) * cos;
                im += errors(t) * sin;
            }
            energy += 2.0 * (re * re + im * im) / (frames * frames) as f64;
        }
    }
    energy / f64::from(count.max(1))
}

fn main() -> Outcome<()> {
    let mut walk = Walk::new()?;
    if let Some(folder) = &walk.folder {
        std::fs::create_dir_all(Path::new(folder))?;
    }
    let truth = walk.truth()?;
    let mut off: Option<(f64, f64)> = None;
    for (aa, text, _) in AntiAliasing::VALUES {
        let pictures = walk.moving(*aa)?;
        let errors = truth.iter().zip(&pictures);
        let errors = errors.map(|(truth, test)| flip::mean(&flip::ldr(truth, test)));
        let mean = errors.sum::<f64>() / truth.len() as f64;
        let energy = flicker(&pictures, &truth);
        let (first, first_energy) = *off.get_or_insert((mean, energy));
        println!(
            "{text:5} mean FLIP {mean:.4} ({:.2} of off)  flicker {energy:.2e} ({:.3} of off)",
            mean / first,
            energy / first_energy
        );
    }
    Ok(())
}
