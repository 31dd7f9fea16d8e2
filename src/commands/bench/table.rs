//! Reports as text tables.

use std::fmt::{self, Display, Formatter};

use super::report::{Frame, Head, Report, Row, is_whole};
use super::statistics::Summary;

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.head)?;
        let [name, median, low, high, cpu] = ["milliseconds", "median", "p5", "p95", "CPU"];
        writeln!(f, "{name:32} {median:>9} {low:>9} {high:>9} {cpu:>9}")?;
        for row in &self.passes {
            time(f, &row.name, &row.time)?;
        }
        time(f, "sum of the passes", &self.parts)?;
        writeln!(f)?;
        frame(f, &self.head.frame_name, &self.frame)?;
        frame(f, "whole frame, everything anew", &self.frame_anew)?;
        self.sum(f)?;
        self.work(f)
    }
}

impl Display for Head {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        let device = &self.device;
        writeln!(
            f,
            "{} ({}, {}), Vulkan {}",
            device.name, device.kind, device.driver, device.vulkan
        )?;
        writeln!(
            f,
            "{}, {} triangles, {width}x{height}, {} frames, skylight {}, {}",
            self.scene, self.triangles, self.frames, self.version, self.commit
        )?;
        let settings = self.settings.iter().filter(|(key, _)| *key != "size");
        let settings: Vec<String> = settings.map(|(k, v)| format!("{k} {v}")).collect();
        writeln!(f, "{}", settings.join(", "))?;
        let how = if self.timing == "timestamps" {
            "passes timed by timestamps of the device"
        } else {
            "each pass submitted alone and waited for: the device has no timestamps that tell passes apart"
        };
        writeln!(f, "{how}")
    }
}

impl Report {
    fn sum(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let ratio = self.parts_to_whole();
        let percent = 100.0 * ratio;
        if is_whole(ratio) {
            writeln!(f, "\nthe passes sum to {percent:.0} % of the whole frame\n")
        } else {
            writeln!(
                f,
                "\nwarning: the passes sum to {percent:.0} % of the whole frame, not to 100 ± 15 %: do not trust single \
                 passes (is the machine busy? are there too few --frames?)\n"
            )
        }
    }

    /// Bytes and counters of each pass.
    fn work(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let counted = self.passes.iter().any(|row| row.work.statistics.is_some());
        let [name, draws, pixels, read, written, rate] = [
            "work (bytes: at least)",
            "draws",
            "pixels",
            "read B/px",
            "write B/px",
            "GB/s",
        ];
        write!(
            f,
            "{name:24} {draws:>6} {pixels:>9} {read:>10} {written:>10} {rate:>7}"
        )?;
        if counted {
            let [vertices, clipped, shaded] = ["vertices", "triangles", "shaded/px"];
            write!(f, " {vertices:>9} {clipped:>9} {shaded:>9}")?;
        }
        writeln!(f)?;
        self.passes.iter().try_for_each(|row| work(f, row))
    }
}

fn work(f: &mut Formatter<'_>, row: &Row) -> fmt::Result {
    let w = &row.work;
    let rate = w.gb_per_s.map_or("-".to_owned(), |r| format!("{r:.2}"));
    write!(
        f,
        "{:24} {:6} {:9} {:10.2} {:10.2} {rate:>7}",
        row.name, w.draws, w.pixels, w.bytes_read_per_pixel, w.bytes_written_per_pixel
    )?;
    if let Some(s) = &w.statistics {
        let shaded = (s.fragment_invocations + s.compute_invocations) as f64;
        write!(
            f,
            " {:9} {:9} {:9.2}",
            s.vertex_invocations,
            s.clipped_primitives,
            shaded / w.pixels.max(1) as f64
        )?;
    }
    writeln!(f)
}

fn time(f: &mut Formatter<'_>, name: &str, time: &Summary) -> fmt::Result {
    let cpu = time.cpu_median_ms;
    let cpu = cpu.map_or("-".to_owned(), |ms| format!("{ms:.2}"));
    writeln!(
        f,
        "{name:32} {:9.2} {:9.2} {:9.2} {cpu:>9}",
        time.median_ms, time.p5_ms, time.p95_ms
    )
}

fn frame(f: &mut Formatter<'_>, name: &str, frame: &Frame) -> fmt::Result {
    time(f, name, &frame.time)?;
    time(f, "  of which recording", &frame.record)
}
