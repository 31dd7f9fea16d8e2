//! The benchmark report as written to files.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::BenchArgs;
use super::measure::{Measured, Whole};
use super::statistics::Summary;
use super::work::Work;
use crate::commands::job::Job;
use crate::gpu::{Context, Timing};

/// Largest relative difference between the sum of the passes and the whole frame that goes unreported.
pub const SUM_TOLERANCE: f64 = 0.15;

/// A measurement and its conditions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Conditions of the measurement.
    #[serde(flatten)]
    pub head: Head,
    /// Each pass, with everything recomputed.
    pub passes: Vec<Row>,
    /// Sum of the passes of a frame.
    pub parts: Summary,
    /// The whole frame: sky, irradiance and shadow map are updated only as the motion requires.
    pub frame: Frame,
    /// The whole frame with sky, irradiance and shadow map recomputed.
    pub frame_anew: Frame,
}

/// Conditions of a measurement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    /// The device measured.
    pub device: Device,
    /// Program version.
    pub version: String,
    /// Commit of the build, in words.
    pub commit: String,
    /// Scene name.
    pub scene: String,
    /// Width and height of the image, pixels.
    pub size: [u32; 2],
    /// Triangles in the scene.
    pub triangles: usize,
    /// Number of frames measured.
    pub frames: u32,
    /// What moved from frame to frame: `none`, `camera` or `sun`.
    pub motion: String,
    /// The motion in words.
    pub frame_name: String,
    /// Timing method: `isolated` or `timestamps`.
    pub timing: String,
    /// Options by name.
    pub settings: BTreeMap<String, String>,
}

/// A device, as reported by its driver.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Device {
    /// Device name.
    pub name: String,
    /// Device type: `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: String,
    /// Driver name and version.
    pub driver: String,
    /// Vulkan version.
    pub vulkan: String,
}

/// Results for one pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Pass name.
    pub name: String,
    /// Time per frame.
    #[serde(flatten)]
    pub time: Summary,
    /// Work per frame.
    #[serde(flatten)]
    pub work: Work,
}

/// Times of a whole frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// From the start of recording to completion on the device.
    #[serde(flatten)]
    pub time: Summary,
    /// Command recording on the CPU.
    pub record: Summary,
    /// From submission to completion.
    pub device: Summary,
}

impl Head {
    /// Conditions of a measurement that is about to start.
    pub fn new(job: &Job, context: &Context, args: &BenchArgs) -> Self {
        let device = context.summary();
        let timing = match device.timing() {
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
        // Timings of a debug build are not worth keeping.
        "a debug build".to_owned()
    } else {
        format!("commit {}", env!("SKYLIGHT_COMMIT"))
    }
}

impl Report {
    /// Summarises a measurement.
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

    /// Ratio of the sum of the passes to the whole frame, medians.
    pub fn parts_to_whole(&self) -> f64 {
        self.parts.median_ms / self.frame_anew.device.median_ms
    }

    /// All times that can be compared between reports, by name.
    pub fn times(&self) -> Vec<(&str, &Summary)> {
        let passes = self.passes.iter().map(|row| (row.name.as_str(), &row.time));
        let frames = [
            (self.head.frame_name.as_str(), &self.frame.time),
            ("whole frame, everything anew", &self.frame_anew.time),
        ];
        passes.chain(frames).collect()
    }

    /// The report as JSON.
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

/// Whether the sum of the passes matches the whole frame.
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
