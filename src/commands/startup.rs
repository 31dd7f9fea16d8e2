//! `skylight info --startup`: the time of each step up to the first image of the bundled scene.

use std::fmt::Write as _;
use std::time::Instant;

use serde_json::json;

use super::job::Job;
use crate::error::Result;
use crate::frame::Frame;
use crate::gpu::{CacheState, Context, Recorder, Step, Timing, shaders};
use crate::options::{OptionValues, Optional};
use crate::output::print;
use crate::passes::light::lighting::Precision;

/// Number of pipelines listed, slowest first.
const LISTED: usize = 8;

/// Goes through the steps of `render` and prints their times.
///
/// # Errors
/// No usable device, or a device error.
pub fn run(device: Option<String>, without: Option<Optional>, as_json: bool) -> Result<()> {
    let mut clock = Clock::new();
    let mut options = OptionValues::default();
    if let Some(device) = device {
        options.set("device", device);
    }
    if let Some(without) = without {
        options.set("without", without);
    }
    let (job, context) = Job::on_device(None, &options)?;
    clock.done("read the bundled scene, decide about its light; open the device");
    let mut recorder = Recorder::new(&context, Timing::Off)?;
    let settings = job.frame_settings(job.settings.show, Precision::Half);
    clock.done("recorder, frame settings");
    recorder.begin()?;
    let mut frame = Frame::new(&mut recorder, &job.scene, settings)?;
    clock.done("pipelines, images, scene upload (recorded)");
    recorder.finish()?;
    clock.done("scene upload (executed)");
    for name in [
        "first frame (software drivers compile shaders here)",
        "second frame",
    ] {
        recorder.begin()?;
        frame.record(&mut recorder, &job.daylight, &job.camera, 0);
        recorder.finish()?;
        clock.done(name);
    }
    context.check_validation()?;
    if as_json {
        return print(&format!("{:#}\n", json(&clock.steps, &context)));
    }
    print(&report(&clock.steps, &context))
}

struct Clock {
    last: Instant,
    steps: Vec<Step>,
}

impl Clock {
    fn new() -> Self {
        Self {
            last: Instant::now(),
            steps: Vec::new(),
        }
    }

    fn done(&mut self, name: &str) {
        let now = Instant::now();
        self.steps.push(Step {
            name: name.to_owned(),
            ms: (now - self.last).as_secs_f64() * 1e3,
        });
        self.last = now;
    }
}

fn report(steps: &[Step], context: &Context) -> String {
    let mut text = format!("start-up on \"{}\", milliseconds\n", context.summary().name);
    let mut line = |name: &str, ms: f64| {
        let _ = writeln!(text, "{name:52} {ms:8.2}");
    };
    for step in steps {
        line(&step.name, step.ms);
    }
    line("total", steps.iter().map(|s| s.ms).sum());
    let _ = writeln!(text, "\nopening the device, while the scene was loaded:");
    for step in context.opening() {
        let _ = writeln!(text, "    {:48} {:8.2}", step.name, step.ms);
    }
    let mut pipelines = context.pipelines();
    pipelines.sort_by(|a, b| b.ms.total_cmp(&a.ms));
    let one_by_one: f64 = pipelines.iter().map(|p| p.ms).sum();
    let _ = writeln!(
        text,
        "\n{} pipelines, created in parallel; {one_by_one:.2} ms in sequence; the slowest:",
        pipelines.len()
    );
    for step in pipelines.iter().take(LISTED) {
        let _ = writeln!(text, "    {:48} {:8.2}", step.name, step.ms);
    }
    let words: usize = shaders::ALL.iter().map(|s| s.words.len()).sum();
    let _ = writeln!(
        text,
        "pipeline cache: {}\nshader modules: {}, {} KiB in total",
        cache(context.cache_state()),
        shaders::ALL.len(),
        4 * words / 1024
    );
    text
}

/// The same figures, every pipeline among them, slowest first; milliseconds.
fn json(steps: &[Step], context: &Context) -> serde_json::Value {
    let list = |steps: &[Step]| -> Vec<serde_json::Value> {
        let step = |step: &Step| json!({ "name": step.name, "ms": step.ms });
        steps.iter().map(step).collect()
    };
    let mut pipelines = context.pipelines();
    pipelines.sort_by(|a, b| b.ms.total_cmp(&a.ms));
    json!({
        "device": context.summary().name,
        "steps": list(steps),
        "total_ms": steps.iter().map(|s| s.ms).sum::<f64>(),
        "opening": list(context.opening()),
        "pipelines": list(&pipelines),
        "pipeline_cache": cache(context.cache_state()),
        "shader_modules": shaders::ALL.len(),
    })
}

fn cache(state: CacheState) -> String {
    match state {
        CacheState::Off => "off: no cache folder".to_owned(),
        CacheState::New => "new".to_owned(),
        CacheState::Read(bytes) => format!("loaded, {bytes} bytes"),
        CacheState::Refused => "damaged or of another driver; replaced".to_owned(),
    }
}
