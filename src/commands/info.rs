//! `skylight info`: the Vulkan devices and the features that they lack.

use crate::error::Result;
use crate::gpu::{DeviceSummary, GpuError, Optional, devices};
use crate::output::print;

/// Prints one block per device.
///
/// # Errors
/// Fails without Vulkan or without any device.
pub fn run(without: &[Optional]) -> Result<()> {
    let devices = devices(without)?;
    if devices.is_empty() {
        return Err(GpuError::NoDevice.into());
    }
    print(&devices.iter().map(describe).collect::<String>())
}

fn describe(device: &DeviceSummary) -> String {
    let lacks = if device.missing.is_empty() {
        "nothing that skylight needs".to_owned()
    } else {
        device.missing.join(", ")
    };
    let optional: Vec<String> = device
        .optional
        .iter()
        .map(|(what, present)| format!("{}: {}", what.name(), if *present { "yes" } else { "no" }))
        .collect();
    format!(
        "{} \"{}\"\n    kind     {}\n    Vulkan   {}\n    driver   {}\n    lacks    {lacks}\n    \
         optional {}\n    largest  {} pixels\n",
        device.index,
        device.name,
        device.kind,
        device.api,
        device.driver,
        optional.join(", "),
        device.max_image_edge
    )
}
