//! Work of a pass: draws, bytes per pixel of its render targets, and pipeline statistics.

use serde::{Deserialize, Serialize};

use crate::gpu::{PassWork, PipelineStatistics, Traffic};

/// Work of all passes of one name in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Work {
    /// Number of draws, dispatches and copies.
    #[serde(default)]
    pub draws: u64,
    /// Pixels of the render targets, all layers.
    pub pixels: u64,
    /// Least number of bytes read (see [`Traffic`]), per pixel.
    pub bytes_read_per_pixel: f64,
    /// Least number of bytes written, per pixel.
    pub bytes_written_per_pixel: f64,
    /// Bytes read and written over the median time, 10⁹ bytes/s. `None` when the time rounds to zero.
    pub gb_per_s: Option<f64>,
    /// Pipeline statistics, if the device supports them.
    pub statistics: Option<Statistics>,
}

/// Pipeline statistics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Statistics {
    /// Vertices read by input assembly.
    pub vertices: u64,
    /// Vertex shader invocations.
    pub vertex_invocations: u64,
    /// Primitives left after clipping.
    pub clipped_primitives: u64,
    /// Fragment shader invocations.
    pub fragment_invocations: u64,
    /// Compute shader invocations.
    pub compute_invocations: u64,
}

impl Work {
    /// Work of the passes named `name`, which take `ms` milliseconds together.
    pub fn of(name: &str, passes: &[PassWork], ms: f64) -> Self {
        let mut total = Traffic::default();
        let mut draws = 0;
        let mut counted: Option<Statistics> = None;
        for pass in passes.iter().filter(|pass| pass.name == name) {
            draws += pass.draws;
            total.pixels += pass.traffic.pixels;
            total.bytes_read += pass.traffic.bytes_read;
            total.bytes_written += pass.traffic.bytes_written;
            if let Some(statistics) = &pass.statistics {
                counted.get_or_insert_default().add(statistics);
            }
        }
        let per_pixel = |bytes: u64| bytes as f64 / total.pixels.max(1) as f64;
        let bytes = (total.bytes_read + total.bytes_written) as f64;
        Self {
            draws,
            pixels: total.pixels,
            bytes_read_per_pixel: per_pixel(total.bytes_read),
            bytes_written_per_pixel: per_pixel(total.bytes_written),
            gb_per_s: (ms > 0.0).then(|| bytes / (ms * 1e6)),
            statistics: counted,
        }
    }
}

impl Statistics {
    fn add(&mut self, more: &PipelineStatistics) {
        self.vertices += more.vertices;
        self.vertex_invocations += more.vertex_invocations;
        self.clipped_primitives += more.clipped_primitives;
        self.fragment_invocations += more.fragment_invocations;
        self.compute_invocations += more.compute_invocations;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_of_one_name_are_summed() {
        let pass = |name, pixels, bytes_read, bytes_written, fragment_invocations| PassWork {
            name,
            draws: 2,
            traffic: Traffic {
                pixels,
                bytes_read,
                bytes_written,
            },
            statistics: Some(PipelineStatistics {
                fragment_invocations,
                ..PipelineStatistics::default()
            }),
        };
        let passes = [
            pass("sky", 100, 400, 800, 100),
            pass("lighting", 7, 7, 7, 7),
            pass("sky", 300, 400, 2400, 300),
        ];
        let work = Work::of("sky", &passes, 2.0);
        assert_eq!((work.draws, work.pixels), (4, 400));
        assert_eq!(work.bytes_read_per_pixel, 2.0);
        assert_eq!(work.bytes_written_per_pixel, 8.0);
        // 4000 bytes in 2 ms.
        assert_eq!(work.gb_per_s, Some(0.002));
        assert_eq!(work.statistics.map(|s| s.fragment_invocations), Some(400));
        assert_eq!(Work::of("none", &passes, 0.0), Work::default());
    }
}
