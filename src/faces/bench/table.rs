//! The table for people.

use std::fmt::{self, Display, Formatter};

use super::report::{Frame, Report, is_whole};
use super::statistics::Summary;

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.head(f)?;
        writeln!(
            f,
            "{:32} {:>9} {:>9} {:>9} {:>9}",
            "milliseconds", "median", "p5", "p95", "CPU"
        )?;
        for row in &self.passes {
            time(f, &row.name, &row.time)?;
        }
        time(f, "sum of the passes", &self.parts)?;
        writeln!(f)?;
        frame(f, &self.frame_name, &self.frame)?;
        frame(f, "whole frame, everything anew", &self.frame_new_light)?;
        self.sum(f)
    }
}

impl Report {
    fn head(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        let device = &self.device;
        writeln!(
            f,
            "{} ({}), Vulkan {}",
            device.name, device.driver, device.vulkan
        )?;
        writeln!(
            f,
            "{}, {} triangles, {width}x{height}, {} frames, skylight {}",
            self.scene, self.triangles, self.frames, self.version
        )?;
        let settings: Vec<String> = self
            .settings
            .iter()
            .filter(|(key, _)| *key != "size")
            .map(|(key, value)| format!("{key} {value}"))
            .collect();
        writeln!(f, "{}", settings.join(", "))?;
        writeln!(f, "{}\n", self.how())
    }

    fn how(&self) -> &'static str {
        if self.timing == "timestamps" {
            "passes timed by timestamps of the device"
        } else {
            "each pass submitted alone and waited for: timestamps of software drivers are attributed to the wrong pass"
        }
    }

    fn sum(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let ratio = self.parts_to_whole();
        let percent = 100.0 * ratio;
        if is_whole(ratio) {
            writeln!(f, "\nthe passes sum to {percent:.0} % of the whole frame")
        } else {
            writeln!(
                f,
                "\nwarning: the passes sum to {percent:.0} % of the whole frame, not to 100 ± 15 %: do not trust \
                 single passes (is the machine busy? more --frames help)"
            )
        }
    }
}

fn time(f: &mut Formatter<'_>, name: &str, time: &Summary) -> fmt::Result {
    let cpu = time
        .cpu_median_ms
        .map_or("-".to_owned(), |ms| format!("{ms:.2}"));
    writeln!(
        f,
        "{name:32} {:9.2} {:9.2} {:9.2} {cpu:>9}",
        time.median_ms, time.p5_ms, time.p95_ms
    )
}

fn frame(f: &mut Formatter<'_>, name: &str, frame: &Frame) -> fmt::Result {
    time(f, name, &frame.time)?;
    time(f, "  recording", &frame.record)
}
