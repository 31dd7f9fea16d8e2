//! `skylight validate` on a faulty device: what it gives back is changed on the way, and every check sees it.

use std::collections::BTreeMap;

use crate::gpu::Device;
use skylight::validate::CHECKS;
use skylight::validate::device::Tamper;

/// A fault.
type Fault = (&'static str, fn() -> Tamper);

/// What every group of checks must see.
fn general() -> [Fault; 2] {
    [
        ("nothing is drawn", || Box::new(|_, t| t.fill([0.0; 4]))),
        ("values 5 % too high", || {
            Box::new(|_, t| each(t, |v| v.map(|v| v * 1.05)))
        }),
    ]
}

/// What some groups must see: the group takes the one of its number, so that each is seen by several.
fn special() -> [Fault; 4] {
    [
        ("red and blue exchanged", || {
            Box::new(|_, t| each(t, |[r, g, b, a]| [b, g, r, a]))
        }),
        ("the second half is missing", || {
            Box::new(|_, t| {
                let half = t.len() / 2;
                t[half..].fill([0.0; 4]);
            })
        }),
        ("the first sixth and the second exchanged", || {
            Box::new(|_, t| {
                let sixth = t.len() / 6;
                let (first, rest) = t.split_at_mut(sixth);
                first.swap_with_slice(&mut rest[..sixth]);
            })
        }),
        ("no number in one texel", no_number),
    ]
}

/// The special faults of a group.
const SPECIAL: [&[usize]; CHECKS.len()] = [
    &[0, 2, 3],
    &[0, 1],
    &[2],
    &[3],
    &[1],
    &[3],
    &[0],
    &[0, 3],
    &[0, 2],
];

fn each(texels: &mut [[f32; 4]], change: fn([f32; 4]) -> [f32; 4]) {
    for texel in texels {
        *texel = change(*texel);
    }
}

/// In the first image alone, so that no other one excludes it from being compared.
fn no_number() -> Tamper {
    let mut is_first = true;
    Box::new(move |_, texels| {
        if std::mem::take(&mut is_first) {
            let middle = texels.len() / 2;
            texels[middle] = [f32::NAN; 4];
        }
    })
}

#[test]
fn every_check_passes_and_sees_a_faulty_device() {
    let mut device = Device::new();
    let mut seen: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (number, group) in CHECKS.iter().enumerate() {
        device.tamper = None;
        for check in group(&mut device).expect("drawn") {
            assert!(
                check.passed(),
                "{}: {:e} at {}",
                check.name,
                check.error(),
                check.at()
            );
            seen.insert(check.name, Vec::new());
        }
        let special = SPECIAL[number].iter().map(|index| special()[*index]);
        for (fault, tamper) in general().into_iter().chain(special) {
            device.tamper = Some(tamper());
            let checks = group(&mut device).expect("drawn");
            let failed = checks.iter().filter(|check| !check.passed());
            let failed: Vec<&str> = failed.map(|check| check.name).collect();
            assert!(!failed.is_empty(), "group {number} does not see: {fault}");
            for name in failed {
                seen.entry(name).or_default().push(fault);
            }
        }
    }
    for (check, faults) in &seen {
        println!("{check}: {}", faults.join(", "));
        assert!(!faults.is_empty(), "{check} sees no fault");
    }
}
