//! The measurement: warm-up frames, then timed frames.

use std::sync::Arc;

use super::hills::Ground;
use super::statistics::Samples;
use crate::cli::Motion;
use crate::commands::job::Job;
use crate::daylight::sky::Daylight;
use crate::error::Result;
use crate::frame::{Frame, FrameSettings, Visibility};
use crate::gpu::{Context, PassTime, PassWork, Recorder, Stopwatch, Timing};
use crate::passes::light::lighting::Precision;
use crate::scene::{Camera, Scene};

/// Warm-up frames, not counted: shaders are compiled at first use.
pub const WARM_UP: u32 = 3;

/// Times of whole frames, each a single submission.
#[derive(Debug, Clone, Default)]
pub struct Whole {
    /// From the start of recording to completion on the device.
    pub frame: Samples,
    /// Command recording on the CPU.
    pub record: Samples,
    /// From submission to completion, without recording.
    pub device: Samples,
}

/// Results of a measurement.
#[derive(Debug, Clone, Default)]
pub struct Measured {
    /// Each pass in drawing order, with sky, irradiance and shadow map recomputed every frame.
    pub passes: Vec<(&'static str, Samples)>,
    /// Sum of the passes of each frame.
    pub parts: Samples,
    /// Work of each pass in one frame.
    pub work: Vec<PassWork>,
    /// Whole frames with everything recomputed.
    pub anew: Whole,
    /// Whole frames in motion: sky, irradiance and shadow map are updated only as the motion requires.
    pub moving: Whole,
}

/// What to draw.
pub struct Subject<'j> {
    /// Camera, light and scene.
    pub job: &'j Job,
    /// Frame settings.
    pub settings: FrameSettings,
    /// Which scene to draw.
    pub ground: Ground,
    /// Camera before any motion.
    pub camera: Camera,
}

impl<'j> Subject<'j> {
    /// The subject given on the command line.
    pub fn new(job: &'j Job) -> Self {
        Self {
            job,
            settings: job.frame_settings(job.settings.show, Precision::Half),
            ground: Ground::Given,
            camera: job.camera,
        }
    }
}

/// A frame with two recorders: one times each pass, the other submits the frame as a whole.
pub struct Bench<'j> {
    job: &'j Job,
    camera: Camera,
    motion: Motion,
    frame: Frame,
    parts: Recorder,
    whole: Recorder,
}

impl<'j> Bench<'j> {
    /// Creates the frame and both recorders.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        subject: &Subject<'j>,
        scene: &Scene,
        context: &Arc<Context>,
        motion: Motion,
    ) -> Result<Self> {
        let mut whole = Recorder::new(context, Timing::Off)?;
        whole.begin()?;
        let frame = Frame::new(&mut whole, scene, subject.settings)?;
        whole.finish()?;
        Ok(Self {
            job: subject.job,
            camera: subject.camera,
            motion,
            frame,
            parts: Recorder::new(context, context.summary().timing())?,
            whole,
        })
    }

    /// Measures `frames` frames of each kind.
    ///
    /// # Errors
    /// Fails when the device is lost.
    pub fn run(&mut self, frames: u32) -> Result<Measured> {
        Ok(self.run_beside(frames, None)?.0)
    }

    /// Measures `frames` frames of each kind, and the passes of as many frames seen from `other`.
    ///
    /// # Errors
    /// Fails when the device is lost.
    pub fn run_beside(
        &mut self,
        frames: u32,
        other: Option<&Camera>,
    ) -> Result<(Measured, Measured)> {
        let (mut measured, mut beside) = (Measured::default(), Measured::default());
        let mut forgotten = Measured::default();
        for i in 0..WARM_UP + frames {
            let (into, into_beside) = if i < WARM_UP {
                (&mut forgotten, &mut Measured::default())
            } else {
                (&mut measured, &mut beside)
            };
            // The kinds alternate so that disturbances of the machine affect all of them alike.
            let camera = self.camera;
            self.passes(&camera, 2 * i, into)?;
            if let Some(other) = other {
                self.passes(other, 2 * i, into_beside)?;
            }
            self.frame.invalidate();
            self.whole(2 * i + 1, &mut into.anew)?;
        }
        measured.work = self.work()?;
        self.refine()?;
        for i in 0..WARM_UP + frames {
            let into = if i < WARM_UP {
                &mut forgotten
            } else {
                &mut measured
            };
            self.whole(i, &mut into.moving)?;
        }
        Ok((measured, beside))
    }

    /// Times each pass with everything recomputed.
    fn passes(&mut self, camera: &Camera, index: u32, into: &mut Measured) -> Result<()> {
        self.frame.invalidate();
        let camera = self.motion.camera(camera, index);
        let daylight = self.motion.daylight(self.job, index);
        let recorder = &mut self.parts;
        recorder.begin()?;
        draw(&mut self.frame, recorder, &daylight, &camera);
        recorder.finish()?;
        into.push(recorder.timings().passes());
        Ok(())
    }

    /// Times a frame as one submission. CPU work for a new sun counts as recording.
    fn whole(&mut self, index: u32, into: &mut Whole) -> Result<()> {
        let camera = self.motion.camera(&self.camera, index);
        let recorder = &mut self.whole;
        let recording = Stopwatch::start();
        let daylight = self.motion.daylight(self.job, index);
        recorder.begin()?;
        draw(&mut self.frame, recorder, &daylight, &camera);
        let (record, record_cpu) = recording.elapsed_ms();
        let waiting = Stopwatch::start();
        recorder.finish()?;
        let (device, device_cpu) = waiting.elapsed_ms();
        into.record.push(record, record_cpu);
        into.device.push(device, device_cpu);
        into.frame.push(record + device, record_cpu + device_cpu);
        Ok(())
    }

    /// Work of each pass, counted in a frame that is not timed.
    fn work(&mut self) -> Result<Vec<PassWork>> {
        let mut recorder = Recorder::new(self.whole.context(), Timing::Work)?;
        self.frame.invalidate();
        recorder.begin()?;
        let job = self.job;
        draw(&mut self.frame, &mut recorder, &job.daylight, &self.camera);
        recorder.finish()?;
        Ok(recorder.work().to_vec())
    }

    fn refine(&mut self) -> Result<()> {
        while !self.frame.is_refined() {
            self.whole.begin()?;
            self.frame.record_light(&mut self.whole, &self.job.daylight);
            self.whole.finish()?;
        }
        Ok(())
    }
}

/// Draws a frame of a moving view; with the dome, the first one of an average.
fn draw(frame: &mut Frame, recorder: &mut Recorder, daylight: &Daylight, camera: &Camera) {
    if frame.settings().sampling.visibility == Visibility::Ssao {
        frame.preview(recorder, daylight, camera);
    } else {
        frame.record(recorder, daylight, camera, 0);
    }
}

impl Measured {
    /// Adds the passes of one frame. Passes with the same name are summed.
    fn push(&mut self, passes: &[PassTime]) {
        let mut totals: Vec<PassTime> = Vec::new();
        for time in passes {
            match totals.iter_mut().find(|t| t.name == time.name) {
                Some(total) => {
                    total.ms += time.ms;
                    total.cpu_ms += time.cpu_ms;
                }
                None => totals.push(*time),
            }
        }
        for total in &totals {
            let known = self.passes.iter().position(|p| p.0 == total.name);
            let index = known.unwrap_or(self.passes.len());
            if known.is_none() {
                self.passes.push((total.name, Samples::default()));
            }
            self.passes[index].1.push(total.ms, total.cpu_ms);
        }
        let sum = |of: fn(&PassTime) -> f64| totals.iter().map(of).sum();
        self.parts.push(sum(|t| t.ms), sum(|t| t.cpu_ms));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_is_used_twice_is_one_pass() {
        let pass = |name, ms| PassTime {
            name,
            ms,
            cpu_ms: 2.0 * ms,
        };
        let mut measured = Measured::default();
        measured.push(&[pass("sky", 1.0), pass("shadow", 5.0), pass("sky", 2.0)]);
        let medians: Vec<_> = measured
            .passes
            .iter()
            .map(|(name, samples)| (*name, samples.summary().median_ms))
            .collect();
        assert_eq!(medians, [("sky", 3.0), ("shadow", 5.0)]);
        let parts = measured.parts.summary();
        assert_eq!((parts.median_ms, parts.cpu_median_ms), (8.0, Some(16.0)));
    }
}
