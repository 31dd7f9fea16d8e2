//! CSV output: one row per pass and per whole frame. Each row is self-contained, so files can be concatenated.

use serde::Serialize;

use super::report::{Frame, Report, Row};
use super::statistics::Summary;
use super::work::Statistics;

#[derive(Serialize)]
struct Line<'r> {
    device: &'r str,
    driver: &'r str,
    commit: &'r str,
    scene: &'r str,
    width: u32,
    height: u32,
    triangles: usize,
    frames: u32,
    motion: &'r str,
    timing: &'r str,
    name: &'r str,
    median_ms: f64,
    p5_ms: f64,
    p95_ms: f64,
    cpu_median_ms: Option<f64>,
    record_median_ms: Option<f64>,
    draws: Option<u64>,
    pixels: Option<u64>,
    bytes_read_per_pixel: Option<f64>,
    bytes_written_per_pixel: Option<f64>,
    gb_per_s: Option<f64>,
    vertices: Option<u64>,
    vertex_invocations: Option<u64>,
    clipped_primitives: Option<u64>,
    fragment_invocations: Option<u64>,
    compute_invocations: Option<u64>,
}

impl<'r> Line<'r> {
    fn new(
        report: &'r Report,
        name: &'r str,
        time: &Summary,
        frame: Option<&Frame>,
        row: Option<&Row>,
    ) -> Self {
        let head = &report.head;
        let work = row.map(|row| &row.work);
        let count = |of: fn(&Statistics) -> u64| work?.statistics.as_ref().map(of);
        Self {
            device: &head.device.name,
            driver: &head.device.driver,
            commit: &head.commit,
            scene: &head.scene,
            width: head.size[0],
            height: head.size[1],
            triangles: head.triangles,
            frames: head.frames,
            motion: &head.motion,
            timing: &head.timing,
            name,
            median_ms: time.median_ms,
            p5_ms: time.p5_ms,
            p95_ms: time.p95_ms,
            cpu_median_ms: time.cpu_median_ms,
            record_median_ms: frame.map(|frame| frame.record.median_ms),
            draws: work.map(|w| w.draws),
            pixels: work.map(|w| w.pixels),
            bytes_read_per_pixel: work.map(|w| w.bytes_read_per_pixel),
            bytes_written_per_pixel: work.map(|w| w.bytes_written_per_pixel),
            gb_per_s: work.and_then(|w| w.gb_per_s),
            vertices: count(|s| s.vertices),
            vertex_invocations: count(|s| s.vertex_invocations),
            clipped_primitives: count(|s| s.clipped_primitives),
            fragment_invocations: count(|s| s.fragment_invocations),
            compute_invocations: count(|s| s.compute_invocations),
        }
    }
}

/// The report as CSV with a header line.
pub fn csv(report: &Report) -> String {
    let passes = report.passes.iter();
    let lines = passes.map(|row| Line::new(report, &row.name, &row.time, None, Some(row)));
    let frames = [
        (report.head.frame_name.as_str(), &report.frame),
        ("whole frame, everything anew", &report.frame_anew),
    ];
    let whole = frames.map(|(name, frame)| Line::new(report, name, &frame.time, Some(frame), None));
    written(lines.chain(whole))
}

/// Serialises records as CSV with a header line.
pub fn written(lines: impl Iterator<Item = impl Serialize>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for line in lines {
        // Flat records of text and numbers written to memory cannot fail.
        writer.serialize(line).expect("a flat record");
    }
    let bytes = writer.into_inner().expect("memory");
    String::from_utf8_lossy(&bytes).into_owned()
}
