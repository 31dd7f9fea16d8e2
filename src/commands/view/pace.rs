//! Measures how evenly frames follow each other: with `SKYLIGHT_PACE=FILE` in the environment the window turns its view in every frame,
//! changes one option after the other and back, writes what that cost to the file, and ends. `SKYLIGHT_PACE_OF=NAME,..` measures these
//! options alone.

use std::collections::VecDeque;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use super::controls::Drag;
use super::document::Document;
use crate::error::Result;
use crate::options::{Options, Size};
use crate::output::write_whole;

/// A change of nothing.
const NOTHING: &str = "nothing";

/// Options that others of the tour exclude or replace.
const EXCLUDED: [&str; 4] = ["aerial", "turbidity", "visual-range", "exposure"];

/// The options of the panel that need other passes or another daylight, with the values that they take.
const TOUR: [(&str, &str); 22] = [
    // What the machine does to frames by itself.
    (NOTHING, ""),
    ("show", "normal"),
    ("show", "bounces"),
    ("show", "irradiance"),
    ("false-colour", "luminance"),
    ("aa", "smaa"),
    ("aa", "off"),
    ("tonemap", "aces"),
    ("ev100", "14"),
    ("sky", "preetham"),
    ("sky", "overcast"),
    ("cloud-cover", "0.5"),
    ("aod", "0.25"),
    ("ground-albedo", "0.6"),
    ("irradiance", "exact"),
    ("bounces", "0"),
    ("ambient", "ssao"),
    ("refine", "8192"),
    ("shadow-size", "1024"),
    ("samples", "16"),
    ("specular", "0.5"),
    ("size", "half"),
];

/// Frames of which the median is the usual one; more at the start, until the cells are filled.
const USUAL: usize = 10;
const FIRST: usize = 40;
/// Frames with the new passes that still belong to a change.
const SETTLING: usize = 5;
/// Turn of the view in a frame, of a drag across the height of the window.
const TURN: f64 = 0.002;

/// What a change cost.
#[derive(Debug, Default)]
struct Line {
    change: String,
    /// Milliseconds and frames until its passes were in.
    until: (f64, usize),
    worst: f64,
    /// The usual frame before, milliseconds.
    before: f64,
}

/// Where the measurement is.
enum Phase {
    Usual,
    Changing(Instant),
    Settling,
}

/// The measurement.
pub(super) struct Pace {
    file: PathBuf,
    tour: Vec<(&'static str, &'static str)>,
    phase: Phase,
    /// Number of the change, two for each entry of the tour: there and back.
    at: usize,
    /// The options before the change.
    original: Option<Options>,
    last: Option<Instant>,
    /// Milliseconds of the frames of this phase.
    frames: Vec<f64>,
    /// When the input of the frames in flight was read.
    reads: VecDeque<Instant>,
    /// From the input to the end of the frame, of the usual frame.
    ages: Vec<f64>,
    lines: Vec<Line>,
}

impl Pace {
    /// The measurement that the environment asks for, if any.
    pub(super) fn asked() -> Option<Self> {
        let asked = std::env::var("SKYLIGHT_PACE_OF").ok();
        let is_asked = |name: &str| {
            let names = asked.as_deref();
            names.is_none_or(|names| names.split(',').any(|asked| asked == name))
        };
        Some(Self {
            file: std::env::var_os("SKYLIGHT_PACE")?.into(),
            tour: TOUR
                .into_iter()
                .filter(|(name, _)| is_asked(name))
                .collect(),
            phase: Phase::Usual,
            at: 0,
            original: None,
            last: None,
            frames: Vec::new(),
            reads: VecDeque::new(),
            ages: Vec::new(),
            lines: Vec::new(),
        })
    }

    /// Notes that a frame is begun, with the newest input; the frame two before it is drawn. Turns the view.
    pub(super) fn begin(&mut self, document: &mut Document, most_in_flight: usize) {
        let now = Instant::now();
        if self.reads.len() >= most_in_flight
            && let Some(read) = self.reads.pop_front()
            && let (Phase::Usual, true) = (&self.phase, self.frames.len() > most_in_flight)
        {
            self.ages.push(ms(read, now) / median(&self.frames));
        }
        self.reads.push_back(now);
        let turn = Drag {
            right: TURN,
            down: 0.0,
        };
        document.controls.orbit(turn);
    }

    /// Notes that a frame is handed over, and goes on to the next change when it is time. Returns whether this was the last one, which is
    /// then written.
    ///
    /// # Errors
    /// Fails when the file cannot be written.
    pub(super) fn end(&mut self, document: &mut Document) -> Result<bool> {
        let now = Instant::now();
        if let Some(last) = self.last.replace(now) {
            self.frames.push(ms(last, now));
        }
        match self.phase {
            Phase::Usual => {
                let wanted = if self.at == 0 { FIRST } else { USUAL };
                if self.frames.len() < wanted {
                    return Ok(false);
                }
                let usual = median(&self.frames[wanted - USUAL..]);
                // The table so far, if the window is closed before the end.
                write_whole(&self.file, self.table(usual).as_bytes())?;
                if self.at == 2 * self.tour.len() {
                    return Ok(true);
                }
                let change = self.change(document);
                self.lines.push(Line {
                    change,
                    before: usual,
                    ..Line::default()
                });
                self.go_to(Phase::Changing(now));
            }
            Phase::Changing(start) if !document.is_behind() => {
                let until = (ms(start, now), self.frames.len());
                if let Some(line) = self.lines.last_mut() {
                    line.until = until;
                }
                self.phase = Phase::Settling;
            }
            Phase::Changing(_) => {}
            Phase::Settling => {
                let Some(line) = self.lines.last_mut() else {
                    return Ok(false);
                };
                if self.frames.len() >= line.until.1 + SETTLING {
                    line.worst = self.frames.iter().copied().fold(0.0, f64::max);
                    self.at += 1;
                    self.go_to(Phase::Usual);
                }
            }
        }
        Ok(false)
    }

    fn go_to(&mut self, phase: Phase) {
        self.phase = phase;
        self.frames.clear();
    }

    /// Changes the next option, or back, and returns what it did. A size comes as if from the window.
    fn change(&mut self, document: &mut Document) -> String {
        let (name, value) = self.tour[self.at / 2];
        let settings = &mut document.job.settings;
        if let Some(original) = self.original.take() {
            *settings = original;
            return format!("{name} back");
        }
        self.original = Some(settings.clone());
        if name == "size" {
            let half = |edge: u32| (edge / 2).max(1);
            settings.size = Size {
                width: half(settings.size.width),
                height: half(settings.size.height),
            };
            return format!("{name}={value}");
        }
        if name == NOTHING {
            return name.to_owned();
        }
        let mut values = settings.values();
        values.remove(&EXCLUDED);
        values.set(name, value);
        match Options::resolve(&values, &document.job.loaded) {
            Ok(options) => *settings = options,
            Err(error) => return format!("{name}={value}: {error}"),
        }
        format!("{name}={value}")
    }

    /// Whether the measurement has set the picture's size.
    pub(super) fn sets_size(&self) -> bool {
        let change = self.tour.get(self.at / 2);
        self.original.is_some() && change.is_some_and(|(name, _)| *name == "size")
    }

    /// The table: tabs between columns. `last` is the usual frame after the last change.
    fn table(&self, last: f64) -> String {
        let mut text = "change\tms until it shows\tframes until then\tworst frame, ms\tusual before, ms\tusual after, ms\tworst / usual\n".to_owned();
        let afters = self.lines.iter().skip(1).map(|line| line.before);
        let mut all: Vec<(f64, &str)> = Vec::new();
        for (line, after) in self.lines.iter().zip(afters.chain([last])) {
            let ratio = line.worst / line.before.max(after);
            all.push((ratio, &line.change));
            let (until, frames) = line.until;
            let row = format!(
                "{}\t{until:.1}\t{frames}\t{:.1}\t{:.1}\t{after:.1}\t{ratio:.2}",
                line.change, line.worst, line.before
            );
            // Writing to a string does not fail.
            let _ = writeln!(text, "{row}");
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        if let [(ratio, change), ..] = all[..] {
            let (age, oldest) = (
                median(&self.ages),
                self.ages.iter().copied().fold(0.0, f64::max),
            );
            let _ = writeln!(
                text,
                "worst: {ratio:.2} usual frames, {change}; from input to the end of its frame: median {age:.2} usual frames, most {oldest:.2}"
            );
        }
        text
    }
}

fn ms(from: Instant, to: Instant) -> f64 {
    (to - from).as_secs_f64() * 1e3
}

/// The median; 0 of nothing.
fn median(list: &[f64]) -> f64 {
    let mut sorted = list.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::tests::exposed_scene;

    #[test]
    fn each_change_of_the_tour_is_one() {
        let scene = exposed_scene();
        let plain = Options::resolve(&Default::default(), &scene).expect("options");
        for (name, value) in TOUR
            .iter()
            .filter(|(name, _)| !["size", NOTHING].contains(name))
        {
            let mut values = plain.values();
            values.remove(&EXCLUDED);
            values.set(name, value);
            let changed = Options::resolve(&values, &scene).expect(name);
            // The window's default is another one than a file's.
            assert!(
                changed != plain || (*name, *value) == ("aa", "off"),
                "{name}={value}"
            );
        }
    }
}
