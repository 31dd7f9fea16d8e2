//! Draws the samples of an image until the limit on samples or noise is met, or the user interrupts.

use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::interrupt;
use super::job::Job;
use super::noise::Noise;
use crate::error::Result;
use crate::frame::Frame;
use crate::gpu::{Recorder, read_texels};

/// Fewest samples for which the noise estimate is trusted: few batches may agree by chance.
const FEWEST: u32 = 32;

/// Stopping rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rule {
    /// Largest number of samples.
    pub most: u32,
    /// Relative standard error of the luminance at which to stop early.
    pub noise: Option<f64>,
}

/// The result of [`draw`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drawn {
    /// Number of samples in the mean.
    pub samples: u32,
    /// Relative standard error of the image at the last estimate; `None` with too few samples.
    pub error: Option<f64>,
    /// Whether the user interrupted the drawing.
    pub is_interrupted: bool,
}

impl Drawn {
    /// Text for the line on stdout; empty for a single sample.
    pub(super) fn summary(&self, rule: &Rule) -> String {
        if rule.most == 1 {
            return String::new();
        }
        let samples = if self.is_interrupted {
            format!(
                ", interrupted after {} of {} samples",
                self.samples, rule.most
            )
        } else {
            format!(", {} samples", self.samples)
        };
        let error = |e: f64| format!(", noise {:.2} %", 100.0 * e);
        samples + &self.error.map_or(String::new(), error)
    }

    /// Metadata for the image file.
    pub(super) fn metadata(&self, rule: &Rule) -> Vec<(String, String)> {
        let mut list = vec![("samples drawn".to_owned(), self.samples.to_string())];
        list.extend(
            self.error
                .map(|e| ("noise estimated".to_owned(), format!("{e:.6}"))),
        );
        if self.is_interrupted {
            let what = format!("after {} of {} samples", self.samples, rule.most);
            list.push(("interrupted".to_owned(), what));
        }
        list
    }
}

/// Draws samples until `rule` is met.
///
/// # Errors
/// Fails when the device is lost or out of memory.
pub(super) fn draw(
    frame: &mut Frame,
    recorder: &mut Recorder,
    job: &Job,
    rule: &Rule,
    progress: &Progress,
) -> Result<Drawn> {
    let [width, height] = frame.radiance().size();
    let (mut noise, started) = (Noise::new(width as usize * height as usize), Instant::now());
    // Nobody else asks for it before the end.
    let is_watched = rule.noise.is_some() || progress.is_shown();
    let mut error = None;
    let mut samples = 0;
    while samples < rule.most && !interrupt::is_interrupted() || samples == 0 {
        recorder.begin()?;
        job.record(frame, recorder, samples);
        recorder.finish()?;
        samples += 1;
        // Frames with a sun each differ by what they are to show.
        if rule.most > 1 && job.suns.is_none() && samples == noise.next_look() {
            let seen = read_texels(recorder, frame.radiance(), noise.pixels())?;
            noise.look(&seen);
            if is_watched {
                error = noise.relative_error();
            }
        }
        progress.show(samples, rule, error, started.elapsed());
        if is_enough(samples, rule, error) {
            break;
        }
    }
    Ok(Drawn {
        samples,
        error: noise.relative_error(),
        is_interrupted: samples < rule.most && !is_enough(samples, rule, error),
    })
}

fn is_enough(samples: u32, rule: &Rule, error: Option<f64>) -> bool {
    let is_small = |wanted: f64| error.is_some_and(|e| e <= wanted);
    samples >= FEWEST.min(rule.most) && rule.noise.is_some_and(is_small)
}

/// Expected number of samples. Assumes that the error falls with the square root of their number; it falls at least that fast.
fn expected(samples: u32, rule: &Rule, error: Option<f64>) -> u32 {
    let (Some(wanted), Some(error)) = (rule.noise, error) else {
        return rule.most;
    };
    let needed = f64::from(samples) * (error / wanted).powi(2);
    (needed.ceil() as u32).clamp(samples, rule.most)
}

/// Remaining time for `left` samples at the average speed so far.
fn time_left(done: u32, left: u32, elapsed: Duration) -> Duration {
    elapsed.mul_f64(f64::from(left) / f64::from(done.max(1)))
}

/// A progress bar with samples, noise and remaining time; hidden in a pipe and for a single sample.
pub(super) struct Progress(ProgressBar);

impl Progress {
    /// Creates a bar for `rule`.
    pub(super) fn new(rule: &Rule, quiet: bool) -> Self {
        if quiet || rule.most < 2 {
            return Self::hidden();
        }
        let bar = ProgressBar::new(u64::from(rule.most));
        // The template is constant and valid; a fault in it would only leave the default style.
        if let Ok(style) =
            ProgressStyle::with_template("{prefix}{bar:30} {pos}/{len} samples, {msg}")
        {
            bar.set_style(style);
        }
        Self(bar)
    }

    /// No bar.
    pub(super) fn hidden() -> Self {
        Self(ProgressBar::hidden())
    }

    /// Sets the name of the layer being drawn.
    pub(super) fn name(&self, name: &str) {
        self.0.set_prefix(format!("{name} "));
    }

    /// Removes the bar.
    pub(super) fn clear(&self) {
        self.0.finish_and_clear();
    }

    fn is_shown(&self) -> bool {
        !self.0.is_hidden()
    }

    fn show(&self, samples: u32, rule: &Rule, error: Option<f64>, elapsed: Duration) {
        if !self.is_shown() {
            return;
        }
        let all = expected(samples, rule, error);
        self.0.set_length(u64::from(all));
        self.0.set_position(u64::from(samples));
        self.0
            .set_message(message(error, time_left(samples, all - samples, elapsed)));
    }
}

fn message(error: Option<f64>, left: Duration) -> String {
    let noise = error.map_or(String::new(), |e| format!("noise {:.2} %, ", 100.0 * e));
    format!("{noise}{} left", HumanDuration(left))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: Rule = Rule {
        most: 400,
        noise: Some(0.01),
    };

    #[test]
    fn enough_is_enough() {
        assert!(is_enough(32, &RULE, Some(0.01)));
        assert!(!is_enough(31, &RULE, Some(0.001)));
        assert!(!is_enough(32, &RULE, Some(0.011)));
        assert!(!is_enough(32, &RULE, None));
        let unruled = Rule {
            noise: None,
            ..RULE
        };
        assert!(!is_enough(399, &unruled, Some(0.0)));
    }

    #[test]
    fn what_is_left_follows_from_error_and_pace() {
        assert_eq!(expected(16, &RULE, Some(0.04)), 256);
        assert_eq!(expected(16, &RULE, Some(0.4)), 400);
        assert_eq!(expected(16, &RULE, Some(0.001)), 16);
        assert_eq!(expected(16, &RULE, None), 400);
        assert_eq!(
            time_left(16, 240, Duration::from_secs(8)),
            Duration::from_secs(120)
        );
        assert_eq!(
            message(Some(0.0123), Duration::from_secs(120)),
            "noise 1.23 %, 2 minutes left"
        );
        assert_eq!(message(None, Duration::from_secs(1)), "1 second left");
    }

    #[test]
    fn an_interrupted_picture_says_so() {
        let drawn = Drawn {
            samples: 17,
            error: Some(0.0314),
            is_interrupted: true,
        };
        assert_eq!(
            drawn.summary(&RULE),
            ", interrupted after 17 of 400 samples, noise 3.14 %"
        );
        let keys: Vec<String> = drawn.metadata(&RULE).into_iter().map(|e| e.0).collect();
        assert_eq!(keys, ["samples drawn", "noise estimated", "interrupted"]);
        let whole = Drawn {
            is_interrupted: false,
            ..drawn
        };
        assert_eq!(whole.metadata(&RULE).len(), 2);
        assert_eq!(
            whole.summary(&Rule {
                most: 1,
                noise: None
            }),
            ""
        );
    }
}
