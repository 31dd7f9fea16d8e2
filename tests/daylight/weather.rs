//! Weather files of the real world: their clocks, suns and illuminances.

use std::io::Read;
use std::path::Path;

use skylight::daylight::perez::AllWeather;
use skylight::daylight::weather::clock::ClockCheck;
use skylight::daylight::weather::{BUNDLED, Record, Weather};

use crate::common::{Worst, shared};

fn read(path: &Path) -> Weather {
    let mut bytes = std::fs::read(path).expect("a weather file");
    if path.extension().is_some_and(|extension| extension == "xz") {
        let packed = std::mem::take(&mut bytes);
        lzma_rust2::XzReader::new(&packed[..], false)
            .read_to_end(&mut bytes)
            .expect("unpacked");
    }
    Weather::parse(&String::from_utf8_lossy(&bytes), false).expect("a whole file")
}

#[test]
fn clocks_that_are_off_are_told() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("daylight/weather");
    for (name, minutes, most_residual) in [
        ("chicago.epw.xz", 0, 3.0),
        ("amsterdam_iwec.epw.xz", 0, 2.0),
        ("denver_clock_trap.epw.xz", -30, 4.0),
    ] {
        let weather = read(&folder.join(name));
        assert_eq!(weather.warnings, Vec::<String>::new(), "{name}");
        let clock = ClockCheck::of(&weather).expect("all three irradiances");
        println!("{name}: {clock:?}");
        assert!((clock.minutes - minutes).abs() <= 5, "{name}: {clock:?}");
        assert!(clock.residual_w < most_residual, "{name}: {clock:?}");
        assert_eq!(clock.is_off(), minutes != 0, "{name}");
    }
}

#[test]
fn bundled_chicago_has_the_irradiances_that_others_have() {
    let Some(shared) = shared() else { return };
    let theirs = read(&shared.join("daylight/weather/chicago.epw.xz"));
    let ours = Weather::parse(BUNDLED[0].1, false).expect("a whole file");
    assert_eq!(ours.records.len(), theirs.records.len());
    let mut without_sun = 0;
    for (a, b) in ours.records.iter().zip(&theirs.records) {
        let most = |r: &Record| {
            (
                r.month,
                r.day,
                r.hour,
                r.global_w,
                r.diffuse_w,
                r.dew_point_c,
            )
        };
        assert_eq!(most(a), most(b));
        if a.direct_normal_w != b.direct_normal_w {
            // Ours was published with no direct light where the sun is below the horizon in the middle of the hour.
            let low = ours.sun(a).elevation_deg;
            assert!(
                a.direct_normal_w == Some(0.0) && low < 1.0,
                "{a:?}, {b:?}, {low}"
            );
            without_sun += 1;
        }
    }
    assert!(without_sun < 200, "{without_sun} hours");
}

#[test]
fn half_hours_of_a_zone_are_kept() {
    let Some(shared) = shared() else { return };
    let weather = read(&shared.join("daylight/weather/half_hour_zone_24h.epw"));
    assert_eq!(weather.station.zone_hours, 5.5);
    let first = weather.moment(&weather.records[0]);
    assert_eq!(first.to_rfc3339(), "2019-06-16T07:30:00+05:30");
    assert!(!weather.is_a_year());
    assert_eq!(weather.warnings.len(), 1, "{:?}", weather.warnings);
}

#[test]
fn the_hours_have_the_sun_and_the_light_of_two_other_programs() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("daylight");
    for name in ["chicago", "amsterdam_iwec"] {
        let weather = read(&folder.join(format!("weather/{name}.epw.xz")));
        let table = std::fs::read_to_string(folder.join(format!("annual/{name}_hours.csv")));
        let table = table.expect("the hours");
        let rows: Vec<Vec<f64>> = table
            .lines()
            .skip(1)
            .map(|line| {
                line.split(',')
                    .map(|c| c.parse().expect("a number"))
                    .collect()
            })
            .collect();
        assert!(rows.len() > 4000);
        let mut angle = Worst::new("position of the sun, degrees", 0.002);
        let mut sky = Worst::new("illuminance by the sky, of it", 0.002);
        let mut sun = Worst::new("illuminance by the sun, of it or 100 lux", 0.002);
        for row in rows {
            let [month, day, hour, altitude, azimuth, dni, dhi, _, edh, edn] = row[..] else {
                panic!("{row:?}");
            };
            let at =
                |r: &&Record| (f64::from(r.month), f64::from(r.day), r.hour) == (month, day, hour);
            let record = weather.records.iter().find(at).expect("the hour");
            let measured = weather.measured(record);
            let given = (measured.direct_normal_w, measured.diffuse_horizontal_w);
            assert_eq!(given, (dni, dhi), "{row:?}");
            let seen = weather.sun(record);
            angle.see(seen.elevation_deg - altitude, format!("{row:?}"));
            angle.see(
                (seen.azimuth_deg - azimuth) * altitude.to_radians().cos(),
                format!("{row:?}"),
            );
            let light = AllWeather::new(&measured, seen.elevation_deg);
            sky.see(
                (light.diffuse_horizontal_lux - edh) / edh.max(20.0),
                format!("{row:?}"),
            );
            if altitude > 0.0 {
                sun.see(
                    (light.direct_normal_lux - edn) / edn.max(100.0),
                    format!("{row:?}"),
                );
            }
        }
        angle.finish();
        sky.finish();
        sun.finish();
    }
}
