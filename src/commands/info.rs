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
    let optional: Vec<String> = device.optional.iter().map(optional).collect();
    let portability = device.portability.as_ref().map_or(String::new(), |unused| {
        let unused = match unused.as_slice() {
            [] => "all features".to_owned(),
            some => format!("without {}, which skylight does not use", some.join(", ")),
        };
        format!("    subset   VK_KHR_portability_subset, {unused}\n")
    });
    format!(
        "{} \"{}\"\n    kind     {}\n    Vulkan   {}\n    driver   {}\n    lacks    {lacks}\n    \
         optional {}\n    largest  {} pixels\n{portability}",
        device.index,
        device.name,
        device.kind,
        device.api,
        device.driver,
        optional.join(", "),
        device.max_image_edge
    )
}

fn optional((what, used): &(Optional, bool)) -> String {
    format!("{}: {}", what.name(), if *used { "yes" } else { "no" })
}
