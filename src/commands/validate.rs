//! `skylight validate`: proves the device that is there.

use std::fmt::Write as _;
use std::time::Instant;

use serde_json::{Value, json};

use super::progress;
use crate::error::{Error, Result};
use crate::gpu::{Context, ContextOptions, DeviceSummary, Optional};
use crate::output::print;
use crate::validate::check::{Check, Measure, all_passed};
use crate::validate::device::Device;
use crate::validate::{CHECKS, sun};

/// Runs all checks and prints them as a table, or as JSON.
///
/// # Errors
/// No usable device, a device error, or a check that fails.
pub fn run(device: Option<String>, without: Option<Optional>, json: bool) -> Result<()> {
    let started = Instant::now();
    let context = Context::new(&ContextOptions {
        device,
        without: without.into_iter().collect(),
        ..ContextOptions::default()
    })?;
    let bar = progress(CHECKS.len() as u64, "groups of checks", false);
    let mut checks = sun::checks()?;
    let mut drawn = Device::new(&context)?;
    for group in CHECKS {
        checks.extend(group(&mut drawn)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let device = context.summary();
    let seconds = started.elapsed().as_secs_f64();
    print(&if json {
        format!("{:#}\n", value(device, &checks))
    } else {
        table(device, &checks, seconds)
    })?;
    verdict(&checks)
}

/// Fails unless there are checks and all of them passed.
fn verdict(checks: &[Check]) -> Result<()> {
    if all_passed(checks) {
        return Ok(());
    }
    let failed: Vec<&str> = checks
        .iter()
        .filter(|c| !c.passed())
        .map(|c| c.name)
        .collect();
    Err(Error::NotValid(if failed.is_empty() {
        "nothing was checked".to_owned()
    } else {
        format!(
            "{} of {} checks failed: {}",
            failed.len(),
            checks.len(),
            failed.join("; ")
        )
    }))
}

fn table(device: &DeviceSummary, checks: &[Check], seconds: f64) -> String {
    let mut text = format!(
        "{} ({}, {}), Vulkan {}; skylight {}\n\n{:35} {:>8} {:>12} {:>12}  {:19} {:>9} {:>9}\n",
        device.name,
        device.kind,
        device.driver.trim(),
        device.api,
        env!("CARGO_PKG_VERSION"),
        "check",
        "compared",
        "value",
        "reference",
        "by",
        "error",
        "allowed"
    );
    for check in checks {
        let [value, reference] = check.values().unwrap_or([f64::NAN; 2]);
        let unit = match check.measure {
            Measure::Relative => "",
            Measure::Absolute => check.unit,
        };
        let verdict = if check.passed() {
            String::new()
        } else {
            format!("  FAILED at {}", check.at())
        };
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{:35} {:8} {:>12} {:>12}  {:19} {:>9.1e} {:>9.1e} {unit}{verdict}",
            check.name,
            check.count(),
            short(value),
            short(reference),
            check.against,
            check.error(),
            check.tolerance,
        );
    }
    let passed = checks.iter().filter(|c| c.passed()).count();
    let _ = writeln!(
        text,
        "\n{passed} of {} checks passed in {seconds:.0} s; value and reference are those with the largest error, \
         which is relative or has the unit behind it",
        checks.len()
    );
    text
}

/// Six digits.
fn short(value: f64) -> String {
    let digits = (5.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 8.0) as usize;
    if value == 0.0 || (1e-3..1e7).contains(&value.abs()) {
        format!("{value:.digits$}")
    } else {
        format!("{value:.4e}")
    }
}

fn value(device: &DeviceSummary, checks: &[Check]) -> Value {
    json!({
        "skylight": env!("CARGO_PKG_VERSION"),
        "device": device.name,
        "kind": device.kind,
        "driver": device.driver.trim(),
        "vulkan": device.api,
        "passed": all_passed(checks),
        "checks": checks.iter().map(Check::json).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_check_and_an_empty_list_end_with_an_error() {
        assert!(verdict(&[]).is_err());
        let mut good = Check::absolute("good", "b", "", 1.0);
        good.see(1.0, 1.0, 1.0, String::new);
        assert!(verdict(&[good.clone()]).is_ok());
        let mut bad = Check::absolute("bad", "b", "", 1.0);
        bad.see(3.0, 1.0, 1.0, String::new);
        let error = verdict(&[good, bad]).expect_err("one failed");
        assert_eq!(error.to_string(), "1 of 2 checks failed: bad");
        assert_eq!(error.exit_code(), 1);
    }

    #[test]
    fn numbers_have_six_digits() {
        for (value, text) in [
            (0.0, "0.00000000"),
            (4.14159265, "4.14159"),
            (23_456.78, "23456.8"),
            (1e-9, "1.0000e-9"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}
