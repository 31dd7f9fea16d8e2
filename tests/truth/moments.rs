//! Moments in rooms against a path tracer, addend by addend: `skylight daylight --weather --hour`.

use serde_json::Value;

use crate::annual::Case;
use crate::common::Table;

const ADDENDS: [&str; 4] = ["sky_direct", "sky_reflected", "sun_direct", "sun_reflected"];

/// Each addend of every sensor within 3 % of the sensor's light. The sun's direct light is that of the reference times one factor for all
/// sensors within 1e-4, but where the edge of the sun's disc lies: the reference has a sun without extent and without refraction.
fn check(model: &str, case: &Case, (number, hour): (u32, &str)) {
    let report = case.run(model, &format!("--hour {hour} --error 0.01"));
    let table = Table::at(&format!("daylight/pit/{model}_pit.csv")).expect("the folder");
    let sensors = report["sensors"].as_array().expect("a list");
    let rows: Vec<_> = table.rows().step_by(case.every).collect();
    assert_eq!(sensors.len(), rows.len());
    let ours =
        |sensor: &Value, addend: &str| sensor[format!("{addend}_lux")].as_f64().expect("lux");
    let full = sensors
        .iter()
        .map(|s| ours(s, "sun_direct"))
        .fold(0.0, f64::max);
    let (mut worst, mut ratios, mut edges) = ([0.0_f64; 4], Vec::new(), 0);
    for (sensor, row) in sensors.iter().zip(&rows) {
        let theirs = |addend: &str| row.get(&format!("m{number}_{addend}"));
        let sun = ours(sensor, "sun_direct");
        let is_edge = sun > 1e-3 * full && sun < 0.999 * full;
        edges += usize::from(is_edge);
        if !is_edge && theirs("sun_direct") > 0.0 {
            ratios.push(sun / theirs("sun_direct"));
        }
        for (addend, worst) in ADDENDS.iter().zip(&mut worst) {
            if !(is_edge && *addend == "sun_direct") {
                let apart = (ours(sensor, addend) - theirs(addend)).abs();
                *worst = worst.max(apart / theirs("total"));
            }
        }
    }
    println!("{model}, moment {number}: {worst:.4?} of a sensor's light, {edges} at an edge");
    assert!(worst.iter().all(|apart| *apart < 0.03), "{worst:?}");
    assert!(edges <= 2, "{edges} of {}", sensors.len());
    if let Some(first) = ratios.first() {
        println!("sun direct: {first:.5} of the reference's, {ratios:.5?}");
        assert!((first - 1.0).abs() < 0.006, "{first}");
        let is_one = ratios
            .iter()
            .all(|ratio| (ratio / first - 1.0).abs() < 1e-4);
        assert!(is_one, "{ratios:?}");
    }
}

#[test]
fn the_four_addends_in_an_office_are_the_path_tracers() {
    let Some(case) = Case::new("office", "chicago", 12) else {
        return;
    };
    for moment in [(0, "1-15T09"), (1, "3-21T12"), (3, "4-28T16")] {
        check("office_glass", &case, moment);
    }
}

#[test]
fn the_four_addends_in_an_open_plan_are_the_path_tracers() {
    let Some(case) = Case::new("openplan", "amsterdam_iwec", 20) else {
        return;
    };
    for moment in [(4, "12-21T11"), (5, "9-2T11")] {
        check("openplan_glass", &case, moment);
    }
}
