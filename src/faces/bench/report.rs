//! What a measurement came to, as files keep it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::BenchWishes;
use super::measure::{Measured, Whole, trustworthy};
use super::statistics::Summary;
use crate::faces::job::Job;
use crate::gpu::{Context, Timing};
use crate::settings::name;

/// Share of the whole by which the parts may miss it before the program says so.
pub const SUM_TOLERANCE: f64 = 0.15;

/// A measurement and what was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The device.
    pub device: Device,
    /// Version of the program.
    pub version: String,
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
    /// Each pass.
    pub passes: Vec<Row>,
    /// The sum of the passes of a frame.
    pub parts: Summary,
    /// The whole frame; of sky, irradiance and shadow map only what moved was drawn.
    pub frame: Frame,
    /// The whole frame with sky, irradiance and shadow map drawn anew.
    pub frame_new_light: Frame,
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

impl Report {
    /// Sums up.
    pub fn new(job: &Job, context: &Context, measured: &Measured, wishes: &BenchWishes) -> Self {
        let summary = context.summary();
        let row = |(name, samples): &(&str, super::statistics::Samples)| Row {
            name: (*name).to_owned(),
            time: samples.summary(),
        };
        let settings = job.settings.parameters().into_iter();
        Self {
            device: Device {
                name: summary.name.clone(),
                kind: summary.kind.to_owned(),
                driver: summary.driver.trim().to_owned(),
                vulkan: summary.api.clone(),
            },
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: job.name.clone(),
            size: [job.settings.size.width, job.settings.size.height],
            triangles: job.scene.triangles(),
            frames: wishes.frames,
            motion: name(wishes.motion),
            frame_name: wishes.motion.frame_name().to_owned(),
            timing: match trustworthy(summary) {
                Timing::Timestamps => "timestamps",
                _ => "isolated",
            }
            .to_owned(),
            settings: settings.map(|(k, v)| (k.to_owned(), v)).collect(),
            passes: measured.passes.iter().map(row).collect(),
            parts: measured.parts.summary(),
            frame: Frame::new(&measured.moving),
            frame_new_light: Frame::new(&measured.new_light),
        }
    }

    /// The sum of the parts over the whole that they make up.
    pub fn parts_to_whole(&self) -> f64 {
        self.parts.median_ms / self.frame_new_light.device.median_ms
    }

    /// As a file.
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
