//! What a measurement came to, as files keep it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::BenchArgs;
use super::measure::{Measured, Whole, trustworthy};
use super::statistics::Summary;
use super::work::Work;
use crate::commands::job::Job;
use crate::gpu::{Context, Timing};

/// Share of the whole by which the parts may miss it before the program says so.
pub const SUM_TOLERANCE: f64 = 0.15;

/// A measurement and what was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// What was measured.
    #[serde(flatten)]
    pub head: Head,
    /// Each pass, with everything drawn anew.
    pub passes: Vec<Row>,
    /// The sum of the passes of a frame.
    pub parts: Summary,
    /// The whole frame; of sky, irradiance and shadow map only what moved was drawn.
    pub frame: Frame,
    /// The whole frame with sky, irradiance and shadow map drawn anew.
    pub frame_anew: Frame,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    /// The device.
    pub device: Device,
    /// Version of the program.
    pub version: String,
    /// Its commit, where known.
    pub commit: String,
    /// Name of the scene.
    pub scene: String,
    /// Width and height of the picture, pixels.
    pub size: [u32; 2],
    /// Triangles of the scene.
    pub triangles: usize,
    /// Frames measured.
    pub frames: u32,
    /// What moved from frame to frame: `none`, `camera` or `sun`.
    pub motion: String,
    /// The same in words.
    pub frame_name: String,
    /// How passes were timed: `isolated` or `timestamps`.
    pub timing: String,
    /// Options, by name.
    pub settings: BTreeMap<String, String>,
}

/// The device measured.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Device {
    /// Its name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: String,
    /// Driver and its version.
    pub driver: String,
    /// Vulkan version.
    pub vulkan: String,
}

/// One pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Its time.
    #[serde(flatten)]
    pub time: Summary,
    /// What it does.
    #[serde(flatten)]
    pub work: Work,
}

/// A whole frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// From the first command to the last result.
    #[serde(flatten)]
    pub time: Summary,
    /// Recording alone.
    pub record: Summary,
    /// From submission to the last result.
    pub device: Summary,
}

impl Head {
    /// Of a measurement that is about to begin.
    pub fn new(job: &Job, context: &Context, args: &BenchArgs) -> Self {
        let device = context.summary();
        let timing = match trustworthy(device) {
            Timing::Timestamps => "timestamps",
            _ => "isolated",
        };
        let settings = job.settings.values().into_pairs();
        Self {
            device: Device {
                name: device.name.clone(),
                kind: device.kind.to_owned(),
                driver: device.driver.trim().to_owned(),
                vulkan: device.api.clone(),
            },
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: commit(),
            scene: job.name.clone(),
            size: [job.settings.size.width, job.settings.size.height],
            triangles: job.scene.triangles(),
            frames: args.frames,
            motion: args.motion.to_string(),
            frame_name: args.motion.frame_name().to_owned(),
            timing: timing.to_owned(),
            settings: settings.into_iter().collect(),
        }
    }
}

fn commit() -> String {
    if cfg!(debug_assertions) {
        // Its figures are not worth to be kept.
        "a debug build".to_owned()
    } else {
        format!("commit {}", env!("SKYLIGHT_COMMIT"))
    }
}

impl Report {
    /// Sums up.
    pub fn new(head: Head, measured: &Measured) -> Self {
        let rows = measured.passes.iter().map(|(name, samples)| {
            let time = samples.summary();
            Row {
                name: (*name).to_owned(),
                time,
                work: Work::of(name, &measured.work, time.median_ms),
            }
        });
        Self {
            head,
            passes: rows.collect(),
            parts: measured.parts.summary(),
            frame: Frame::new(&measured.moving),
            frame_anew: Frame::new(&measured.anew),
        }
    }

    /// The sum of the parts over the whole that they make up.
    pub fn parts_to_whole(&self) -> f64 {
        self.parts.median_ms / self.frame_anew.device.median_ms
    }

    /// Every time that one report can be compared by with another.
    pub fn times(&self) -> Vec<(&str, &Summary)> {
        let passes = self.passes.iter().map(|row| (row.name.as_str(), &row.time));
        let frames = [
            (self.head.frame_name.as_str(), &self.frame.time),
            ("whole frame, everything anew", &self.frame_anew.time),
        ];
        passes.chain(frames).collect()
    }

    /// As a JSON file.
    pub fn json(&self) -> String {
        let mut value = serde_json::json!(self);
        let ratio = self.parts_to_whole();
        value["parts_to_whole"] = serde_json::json!({
            "ratio": ratio,
            "within_15_percent": is_whole(ratio),
        });
        format!("{value:#}\n")
    }
}

impl Frame {
    fn new(whole: &Whole) -> Self {
        Self {
            time: whole.frame.summary(),
            record: whole.record.summary(),
            device: whole.device.summary(),
        }
    }
}

/// Whether the parts sum to the whole.
pub fn is_whole(ratio: f64) -> bool {
    (ratio - 1.0).abs() <= SUM_TOLERANCE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_may_miss_the_whole_by_15_percent() {
        assert!(is_whole(1.0) && is_whole(1.149) && is_whole(0.851));
        assert!(!is_whole(1.16) && !is_whole(0.84) && !is_whole(f64::NAN));
    }
}
