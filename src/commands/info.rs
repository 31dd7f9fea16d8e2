//! `skylight info`: the Vulkan devices and the features that they lack.

use serde_json::{Map, Value, json};

use crate::error::Result;
use crate::gpu::{DeviceSummary, GpuError, Heap, Optional, devices};
use crate::output::print;

/// Prints one block per device, or all as JSON.
///
/// # Errors
/// Fails without Vulkan or without any device.
pub fn run(without: &[Optional], json: bool) -> Result<()> {
    let devices = devices(without)?;
    if devices.is_empty() {
        return Err(GpuError::NoDevice.into());
    }
    if json {
        let list: Vec<Value> = devices.iter().map(value).collect();
        return print(&format!("{:#}\n", json!({ "devices": list })));
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
         optional {}\n    largest  {} pixels\n    memory   {}\n{portability}",
        device.index,
        device.name,
        device.kind,
        device.api,
        device.driver,
        optional.join(", "),
        device.max_image_edge,
        memory(&device.memory)
    )
}

fn optional((what, used): &(Optional, bool)) -> String {
    format!("{}: {}", what.name(), if *used { "yes" } else { "no" })
}

/// The heaps in MiB, with what of them may be used now.
fn memory(heaps: &[Heap]) -> String {
    let heaps = heaps.iter().map(|heap| {
        let owner = if heap.is_local { "own" } else { "shared" };
        let budget = heap.budget.map_or(String::new(), |bytes| {
            format!(", {} free to use now", bytes >> 20)
        });
        format!("{} MiB {owner}{budget}", heap.bytes >> 20)
    });
    heaps.collect::<Vec<_>>().join("; ")
}

fn value(device: &DeviceSummary) -> Value {
    let optional = device.optional.iter();
    let optional: Map<String, Value> = optional
        .map(|(what, used)| (what.name().to_owned(), (*used).into()))
        .collect();
    let heaps = device.memory.iter().map(
        |heap| json!({ "bytes": heap.bytes, "own": heap.is_local, "budget_bytes": heap.budget }),
    );
    json!({
        "index": device.index,
        "name": device.name,
        "kind": device.kind,
        "vulkan": device.api,
        "driver": device.driver.trim(),
        "lacks": device.missing,
        "optional": optional,
        "largest": device.max_image_edge,
        "timestamp_bits": device.timestamp_bits,
        "memory": heaps.collect::<Vec<_>>(),
    })
}
