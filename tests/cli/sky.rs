//! `skylight sky`, end to end: its JSON, known sun positions, and messages for invalid input.

use std::process::{Command, Output};

use serde_json::Value;

fn skylight(line: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_skylight");
    let words = line.split_whitespace();
    Command::new(program)
        .args(words)
        .output()
        .expect("it starts")
}

fn json(options: &str) -> Value {
    let output = skylight(&format!("sky --json {options}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{options}: {errors}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn at(value: &Value, path: &str) -> f64 {
    let found = value.pointer(&format!("/{}", path.replace('.', "/")));
    let found = found.unwrap_or_else(|| panic!("{path} is missing"));
    found.as_f64().unwrap_or_else(|| panic!("{path}: {found}"))
}

fn numbers(value: &Value, path: &str, count: usize) -> Vec<f64> {
    let found = value.pointer(&format!("/{}", path.replace('.', "/")));
    let list = found.and_then(Value::as_array);
    let list = list.unwrap_or_else(|| panic!("{path} is no list"));
    assert_eq!(list.len(), count, "{path}");
    list.iter()
        .map(|v| v.as_f64().unwrap_or_else(|| panic!("{path}: {v}")))
        .collect()
}

#[test]
fn every_fixed_key_has_its_shape() {
    let found = json("--sun 180,45 --sky preetham --turbidity 1.65");
    for path in [
        "sun.azimuth_deg",
        "sun.elevation_deg",
        "sun.apparent_elevation_deg",
        "sun.air_mass",
        "sun.illuminance_lux",
        "sky.turbidity",
        "sky.zenith_luminance",
        "sky.diffuse_horizontal_lux",
    ] {
        assert!(at(&found, path) > 0.0, "{path}");
    }
    for path in ["sun.illuminance_rgb", "sun.luminance_rgb", "sky.zenith_rgb"] {
        assert!(numbers(&found, path, 3).iter().all(|v| *v > 0.0), "{path}");
    }
    for axis in ["+x", "-x", "+y", "-y", "+z", "-z"] {
        numbers(&found, &format!("sky.irradiance.{axis}"), 3);
    }
    let [x, y, z] = numbers(&found, "sun.direction", 3)[..] else {
        unreachable!("three")
    };
    let expected = std::f64::consts::FRAC_1_SQRT_2;
    assert!(x.abs() < 1e-12 && (y - expected).abs() < 1e-12 && (z - expected).abs() < 1e-12);
    assert_eq!(found["sky"]["model"], "preetham");
    // Preetham's model begins at 2; the warning names the requested value.
    assert_eq!(at(&found, "sky.turbidity"), 2.0);
    let warning = found["warnings"][0].as_str().expect("a warning");
    assert!(warning.contains("turbidity 1.65"), "{warning}");
}

#[test]
fn samples_are_the_radiance_in_the_directions_asked_for() {
    let found = json("--sun 180,45 --direction 0,90 --direction -90,-5");
    let samples = found["sky"]["samples"].as_array().expect("a list");
    assert_eq!(samples.len(), 2);
    let zenith = at(&found, "sky.zenith_luminance");
    assert!((at(&samples[0], "luminance") / zenith - 1.0).abs() < 1e-12);
    assert_eq!(
        numbers(&samples[0], "rgb", 3),
        numbers(&found, "sky.zenith_rgb", 3)
    );
    assert_eq!(at(&samples[1], "azimuth_deg"), 270.0);
    assert_eq!(at(&samples[1], "luminance"), at(&found, "ground.luminance"));
    assert!(json("--sun 180,45")["sky"].get("samples").is_none());
}

#[test]
fn illuminances_add_up() {
    // The atmosphere's view is interpolated in a table.
    check_sums("atmosphere", 1e-3);
    check_sums("preetham", 5e-4);
}

fn check_sums(model: &str, bound: f64) {
    let found = json(&format!("--sun 100,30 --ground-albedo 0 --sky {model}"));
    let up = numbers(&found, "sky.irradiance.+y", 3);
    let diffuse = numbers(&found, "sky.diffuse_horizontal_rgb", 3);
    for (a, b) in up.iter().zip(&diffuse) {
        assert!((a / b - 1.0).abs() < bound, "{model}: {a} {b}");
    }
    assert!(
        numbers(&found, "sky.irradiance.-y", 3)
            .iter()
            .all(|e| e.abs() < 1e-9)
    );
    let half = at(&found, "sun.illuminance_lux") / 2.0;
    assert!((at(&found, "sun.direct_horizontal_lux") / half - 1.0).abs() < 1e-9);
    let total = half + at(&found, "sky.diffuse_horizontal_lux");
    assert!((at(&found, "global_horizontal_lux") / total - 1.0).abs() < 1e-9);
}

#[test]
fn a_measured_illuminance_scales_the_sky() {
    let found = json("--sun 100,30 --sky overcast --sky-illuminance 9000");
    assert!((at(&found, "sky.diffuse_horizontal_lux") / 9000.0 - 1.0).abs() < 1e-6);
    // CIE overcast: zenith = 9/(7π) of the horizontal illuminance.
    let zenith = 9000.0 * 9.0 / (7.0 * std::f64::consts::PI);
    let found = at(&found, "sky.zenith_luminance");
    assert!((found / zenith - 1.0).abs() < 1e-3, "{found} {zenith}");
}

#[test]
fn measured_irradiances_give_sky_and_sun_their_illuminances() {
    let sky = "--sky perez --dni 700 --dhi 120 --dew-point 5";
    let found = json(&format!(
        "--place 41.98,-87.92 --when 2026-03-05T12:30-06:00 {sky}"
    ));
    let lux = 120.0 * at(&found, "sky.measured.diffuse_efficacy");
    assert!((at(&found, "sky.diffuse_horizontal_lux") / lux - 1.0).abs() < 1e-9);
    let lux = 700.0 * at(&found, "sky.measured.direct_efficacy");
    assert!((at(&found, "sun.illuminance_lux") / lux - 1.0).abs() < 1e-9);
    // ε = (ratio + 1.041 z³)/(1 + 1.041 z³), the sun 49° from the zenith.
    assert!((4.3..4.8).contains(&at(&found, "sky.measured.clearness")));
    let water = (0.07f64 * 5.0 - 0.075).exp();
    assert!((at(&found, "sky.measured.water_cm") / water - 1.0).abs() < 1e-9);
    for (name, value) in [
        ("dni", "700"),
        ("dhi", "120"),
        ("dew-point", "5"),
        ("sky", "perez"),
    ] {
        assert_eq!(found["inputs"][name], value);
    }
    // The sun is 7 % brighter in January: the same irradiance is a darker sky, relative to what comes in.
    let of = |day: &str| {
        let day = json(&format!(
            "--solar {day},12 --place 0,0 --refraction off {sky}"
        ));
        at(&day, "sky.measured.brightness")
    };
    assert!(
        (of("3") / of("182") - 0.935).abs() < 0.02,
        "{} {}",
        of("3"),
        of("182")
    );
    let text = String::from_utf8(skylight(&format!("sky {sky}")).stdout).expect("text");
    for part in ["clearness ε", "brightness Δ", "luminous efficacies"] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn clouds_dim_the_sun_and_their_own_skies_say_no() {
    let open = json("--sun 180,40");
    let half = json("--sun 180,40 --cloud-cover 0.5");
    let ratio = at(&half, "global_horizontal_lux") / at(&open, "global_horizontal_lux");
    assert!(
        (ratio / (1.0 - 0.75 * 0.5f64.powf(3.4)) - 1.0).abs() < 1e-6,
        "{ratio}"
    );
    let sun = at(&half, "sun.illuminance_lux") / at(&open, "sun.illuminance_lux");
    assert!((0.6..0.75).contains(&sun), "{sun}");
    let cloudy = json("--sun 180,40 --cloud-cover 0.5 --sky cie-8");
    let warning = cloudy["warnings"][0].as_str().expect("a warning");
    assert!(warning.contains("clouds of its own"), "{warning}");
}

#[test]
fn refraction_can_be_switched_off() {
    let place = "--place 55.68,12.57 --when 2026-06-21T04:40+02:00";
    let on = json(place);
    let off = json(&format!("{place} --refraction off"));
    let lift = at(&on, "sun.apparent_elevation_deg") - at(&on, "sun.elevation_deg");
    assert!((0.2..0.5).contains(&lift), "{lift}");
    assert_eq!(
        at(&off, "sun.apparent_elevation_deg"),
        at(&off, "sun.elevation_deg")
    );
    assert!(numbers(&off, "sun.direction", 3)[1] < numbers(&on, "sun.direction", 3)[1]);
}

/// Place, moment, true elevation and azimuth (degrees) within 0.2, sunrise and sunset (local hours and minutes) within 3.
///
/// Elevations at noon and midnight follow from latitude and declination (23.44° at a solstice): 90 - |φ - δ|, φ + δ - 90.
type Known = (&'static str, f64, f64, Option<[&'static str; 2]>);
const KNOWN: [Known; 6] = [
    // Copenhagen, summer and winter, at solar noon.
    (
        "--place 55.676,12.568 --when 2026-06-21T13:11:40+02:00",
        57.76,
        180.0,
        Some(["04:25", "21:57"]),
    ),
    (
        "--place 55.676,12.568 --when 2026-12-21T12:07:50+01:00",
        10.89,
        180.0,
        Some(["08:37", "15:38"]),
    ),
    // Quito at the equinox: the sun passes within a degree of the zenith.
    (
        "--place -0.18,-78.47 --when 2026-03-20T09:21-05:00",
        45.0,
        90.0,
        Some(["06:17", "18:24"]),
    ),
    // Tromsø: midnight sun in the north (solar midnight is 00:46), polar night at noon in the south.
    (
        "--place 69.65,18.96 --when 2026-06-22T00:46+02:00",
        3.09,
        0.0,
        None,
    ),
    (
        "--place 69.65,18.96 --when 2026-12-21T11:42+01:00",
        -3.09,
        180.0,
        None,
    ),
    // Sydney, midsummer noon: the sun is in the north.
    (
        "--place -33.87,151.21 --when 2026-12-21T12:53:10+11:00",
        79.57,
        0.0,
        Some(["05:41", "20:05"]),
    ),
];

fn minutes(moment: &str) -> i32 {
    let clock = moment.split('T').next_back().expect("a clock");
    let part = |i: usize| clock[i..i + 2].parse::<i32>().expect("two digits");
    part(0) * 60 + part(3)
}

#[test]
fn known_places_have_their_suns() {
    for (options, elevation, azimuth, events) in KNOWN {
        let found = json(options);
        let seen = at(&found, "sun.elevation_deg");
        assert!(
            (seen - elevation).abs() < 0.2,
            "{options}: elevation {seen}"
        );
        let turn = at(&found, "sun.azimuth_deg") - azimuth;
        let turn = ((turn + 180.0).rem_euclid(360.0) - 180.0) * elevation.to_radians().cos();
        assert!(turn.abs() < 0.2, "{options}: azimuth off by {turn}");
        for (key, i) in [("sunrise", 0), ("sunset", 1)] {
            match (found["sun"][key].as_str(), events) {
                (Some(found), Some(events)) => {
                    let late = minutes(found) - minutes(events[i]);
                    assert!(late.abs() <= 3, "{options}: {key} {found}");
                }
                (None, None) => {}
                (found, _) => panic!("{options}: {key} {found:?}"),
            }
        }
        assert!(found["sun"]["solar_noon"].is_string(), "{options}");
    }
}

#[test]
fn quito_has_the_sun_in_the_zenith_at_the_equinox() {
    let found = json("--place -0.18,-78.47 --when 2026-03-20T12:21:20-05:00");
    let elevation = at(&found, "sun.elevation_deg");
    assert!(elevation > 89.5, "{elevation}");
}

#[test]
fn polar_day_and_night_are_told_as_such() {
    let words = |options: &str| {
        let output = skylight(&format!("sky {options}"));
        String::from_utf8(output.stdout).expect("text")
    };
    let summer = words(KNOWN[3].0);
    assert_eq!(summer.matches("none: polar day").count(), 2, "{summer}");
    let winter = words(KNOWN[4].0);
    assert_eq!(winter.matches("none: polar night").count(), 2, "{winter}");
    assert!(!winter.contains("warning"), "{winter}");
    let fitted = words(&format!("{} --sky hosek", KNOWN[4].0));
    assert!(
        fitted.contains("warning: the sun is below the horizon"),
        "{fitted}"
    );
    assert_eq!(json(KNOWN[3].0)["sun"]["polar"], "day");
    assert_eq!(json(KNOWN[4].0)["sun"]["polar"], "night");
    assert!(at(&json(KNOWN[3].0), "sun.illuminance_lux") > 1000.0);
    assert_eq!(at(&json(KNOWN[4].0), "sun.illuminance_lux"), 0.0);
}

#[test]
fn twilights_and_hours_follow_each_other_and_are_told_where_there_are_none() {
    let found = json("--place 37.08,15.29 --when 2026-09-24T16:40+02:00");
    let text = |path: &str| {
        let found = found.pointer(path).and_then(Value::as_str);
        found
            .unwrap_or_else(|| panic!("{path} is missing"))
            .to_owned()
    };
    let order = [
        "/times/astronomical_twilight/dawn",
        "/times/nautical_twilight/dawn",
        "/times/civil_twilight/dawn",
        "/times/blue_hour/morning/1",
        "/sun/sunrise",
        "/times/golden_hour/morning/1",
        "/sun/solar_noon",
        "/times/golden_hour/evening/0",
        "/sun/sunset",
        "/times/blue_hour/evening/0",
        "/times/civil_twilight/dusk",
        "/times/nautical_twilight/dusk",
        "/times/astronomical_twilight/dusk",
    ];
    let moments = order.map(text);
    assert!(moments.is_sorted(), "{moments:?}");
    assert_eq!(text("/times/blue_hour/morning/0"), moments[2]);
    // Syracuse, civil twilight of some 25 minutes: the sun sets at 18:50.
    assert!(
        moments[10].starts_with("2026-09-24T19:1"),
        "{}",
        moments[10]
    );
    let summer = skylight("sky --place 55.68,12.57 --when 2026-06-21T12:00+02:00");
    let summer = String::from_utf8(summer.stdout).expect("text");
    assert!(
        summer.contains("none: the sun stays above -12°"),
        "{summer}"
    );
    assert!(summer.contains("golden hour"), "{summer}");
    let polar = json("--place 78.22,15.65 --when 2026-12-24T12:00+01:00");
    assert_eq!(polar["times"]["civil_twilight"]["sun_stays"], "below");
    assert!(polar["times"]["golden_hour"]["morning"][0].is_null());
    assert!(json("--sun 180,45").get("times").is_none());
}

#[test]
fn the_moon_is_told_with_its_phase_and_light() {
    // Full on 2026-01-03 10:03 UTC: moon.csv has it at Quito.
    let found = json("--place -0.1807,-78.4678 --when 2026-01-03T10:00Z");
    let close = |path: &str, expected: f64, within: f64| {
        let found = at(&found, path);
        assert!((found - expected).abs() < within, "{path} {found}");
    };
    close("moon.elevation_deg", 16.6931, 0.01);
    close("moon.azimuth_deg", 298.5894, 0.01);
    close("moon.illuminated_fraction", 0.99849, 0.001);
    close("moon.distance_km", 360_423.0, 50.0);
    let (outside, ground) = (
        at(&found, "moon.outside_lux"),
        at(&found, "moon.illuminance_lux"),
    );
    assert!((0.25..0.4).contains(&outside), "{outside}");
    assert!(ground > 0.2 * outside && ground < 0.7 * outside, "{ground}");
    let sine = numbers(&found, "moon.direction", 3)[1];
    close("moon.direct_horizontal_lux", ground * sine, 1e-12);
    // It is night there: the moon is the light from one direction, unless it is switched off.
    let both = at(&found, "sky.diffuse_horizontal_lux") + ground * sine;
    close("global_horizontal_lux", both, 1e-9);
    let off = json("--place -0.1807,-78.4678 --when 2026-01-03T10:00Z --moon off");
    let sky = at(&off, "sky.diffuse_horizontal_lux");
    assert_eq!(at(&off, "global_horizontal_lux"), sky);
    let below = json("--place 37.0755,15.2866 --when 2026-01-03T10:00Z");
    assert_eq!(at(&below, "moon.illuminance_lux"), 0.0);
    assert!(json("--sun 180,45").get("moon").is_none());
}

#[test]
fn every_model_is_compared_and_is_as_on_its_own() {
    // The same haze for all: the optical depth of the atmosphere is that of the turbidity.
    let sun = "--sun 180,40 --dni 700 --dhi 120 --turbidity 3";
    let found = json(&format!("{sun} --compare"));
    let models = found["models"].as_array().expect("a list");
    assert_eq!(models.len(), 22);
    for row in models {
        let name = row["model"].as_str().expect("a name");
        let alone = json(&format!("{sun} --sky {name}"));
        for (key, path) in [
            ("sky_lux", "sky.diffuse_horizontal_lux"),
            ("sun_lux", "sun.illuminance_lux"),
            ("global_lux", "global_horizontal_lux"),
            ("zenith_luminance", "sky.zenith_luminance"),
        ] {
            assert_eq!(at(row, key), at(&alone, path), "{name} {key}");
        }
        assert_eq!(row["sky_cct_k"], alone["sky"]["cct_k"], "{name}");
    }
    let published = found["published"].as_array().expect("a list");
    let clear = 800.0 + 15_500.0 * 40f64.to_radians().sin().sqrt();
    assert!((at(&published[1], "sky_lux") / clear - 1.0).abs() < 1e-12);
    let output = skylight("sky --sun 180,-5 --compare");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.contains("perez       needs --dni and --dhi"), "{text}");
    assert!(text.contains("AMS Glossary"), "{text}");
}

#[test]
fn nonsense_is_one_line_and_exit_code_2() {
    for (line, part) in [
        ("sky --place 91,0", "latitude must be -90 to 90"),
        ("sky --when 2026-02-30T12:00Z", "a date that does not exist"),
        (
            "sky --when 9999-01-01T00:00Z",
            "no sun position for this moment",
        ),
        ("sky --sun 1,2 --solar 3,4", "cannot be used with"),
        ("sky --direction 1", "AZIMUTH,ELEVATION"),
        ("sky --sky-illuminance -1", "0 to 1000000 lux"),
        ("sky --plot spectrum.png", ".svg"),
        ("sky --sky cie-17", "cie-16"),
        ("sky --sky perez", "--dni and --dhi"),
        ("sky --sky perez --dni 300", "0 to 1500"),
        (
            "sky --sky perez --dni -5 --dhi 100",
            "irradiance must be 0 to 1500 W/m²",
        ),
        (
            "sky --sky perez --dni 5 --dhi 1501",
            "irradiance must be 0 to 1500 W/m²",
        ),
        ("sky --sky perez --dni 300 --dhi 0", "both as measured"),
        (
            "sky --sky perez --dni 1 --dhi 1 --dew-point 41",
            "dew point must be -90 to 40 °C",
        ),
        ("sky --cloud-cover 1.1", "cloud cover must be 0 to 1"),
        ("sky --aod 3", "aerosol optical depth must be 0 to 0.6"),
        (
            "sky --altitude 200000",
            "altitude must be 0 to 10000 metres",
        ),
        ("sky --ozone -1", "ozone must be 0 to 600 Dobson units"),
        ("sky --visual-range 2", "visibility must be 8 to 300 km"),
        ("sky --visibility 2", "visibility must be 8 to 300 km"),
        ("sky --aerosol 0.1,0.76,1.2,1.3", "0.1 is outside 0.8..=1"),
        ("sky --aerosol 0.9", "write four numbers"),
        ("sky --aod 0.1 --turbidity 3", "cannot be used with"),
        ("sky --aod 0.1 --visibility 40", "cannot be used with"),
        ("sky --cloud-cover -0.1", "cloud cover must be 0 to 1"),
        ("sky scene.toml", "scene.toml"),
        ("sky --refraction maybe", "--refraction"),
    ] {
        let output = skylight(line);
        let text = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert_eq!(text.lines().count(), 1, "{line}: {text}");
        assert!(text.contains(part), "{line}: {text}");
        assert!(output.stdout.is_empty(), "{line}");
    }
}

#[test]
fn plots_are_whole_svg_files_with_their_curves() {
    let folder = tempfile::tempdir().expect("a folder");
    for (options, parts) in [
        (
            "",
            [
                "black body, 5800 K",
                "outside the atmosphere",
                "on the ground",
            ],
        ),
        ("--irradiance-study", ["monte-carlo", "quasi", "exact"]),
    ] {
        let path = folder.path().join("plot.svg");
        let output = skylight(&format!("sky {options} --plot {}", path.display()));
        assert!(output.status.success());
        let svg = std::fs::read_to_string(&path).expect("written");
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(parts.iter().all(|part| svg.contains(part)), "{options}");
        assert!(svg.matches("<polyline").count() >= 3, "{options}");
    }
    let output = skylight("sky --plot /no/such/folder/a.svg");
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn options_of_pictures_have_no_effect() {
    let plain = json("--sun 180,45");
    let with = json("--sun 180,45 --size 64x64 --tonemap agx --eye 1,2,3 --quiet");
    assert_eq!(plain, with);
}

#[test]
fn the_study_in_the_documentation_is_what_the_program_prints() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/src/daylight/irradiance.rs");
    let page = std::fs::read_to_string(page).expect("the page");
    let output = skylight("sky --irradiance-study --sky preetham --sun 180,45 --ground-albedo 0");
    let table = String::from_utf8(output.stdout).expect("text");
    assert!(table.lines().count() > 20, "{table}");
    for line in table.lines().filter(|line| !line.is_empty()) {
        assert!(page.contains(&format!("//! {line}\n")), "{line}");
    }
}

#[test]
fn the_air_has_three_words_for_its_haze() {
    let lux = |air: &str| {
        let found = json(&format!("--sky atmosphere --sun 180,30 {air}"));
        at(&found, "sky.diffuse_horizontal_lux")
    };
    let clear = lux("");
    assert!((13_000.0..14_000.0).contains(&clear), "{clear}");
    assert_eq!(lux("--aod 0.1"), clear);
    for other in ["--turbidity 2", "--visual-range 41.2", "--visibility 41.2"] {
        let ratio = lux(other) / clear;
        assert!((ratio - 1.0).abs() < 0.02, "{other}: {ratio}");
    }
    assert!(lux("--aod 0.2") > 1.3 * clear && lux("--altitude 2000") < 0.6 * clear);
}

#[test]
fn twilight_of_the_atmosphere_is_that_of_published_tables() {
    // Explanatory Supplement to the Astronomical Almanac (Seidelmann 1992), clear air.
    for (elevation, lux) in [(0.0, 759.0), (-2.0, 189.0), (-4.0, 29.9), (-6.0, 3.41)] {
        let found = json(&format!("--sky atmosphere --sun 180,{elevation}"));
        let ratio = at(&found, "global_horizontal_lux") / lux;
        assert!((0.75..1.35).contains(&ratio), "{elevation}: {ratio}");
    }
}
