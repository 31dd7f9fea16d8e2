//! The atmosphere against a spectral Monte Carlo solution on the sphere (`shared/sky`, with its own error), and against itself.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, OnceLock};

use glam::{DVec3, DVec4};
use skylight::daylight::atmosphere::aerial::AirBefore;
use skylight::daylight::atmosphere::air::{Aerosol, Air};
use skylight::daylight::atmosphere::colour::WAVELENGTHS;
use skylight::daylight::atmosphere::scattered_sky::ScatteredSky;
use skylight::daylight::atmosphere::sky_view::SkyView;
use skylight::daylight::atmosphere::{Atmosphere, solve::Effort};
use skylight::daylight::colour::{clip_negative, luminance, xyz_from_rgb};
use skylight::daylight::sun_position::direction;

use crate::common::{Row, Table, Worst, at_share};

type Shared = Arc<OnceLock<Arc<Atmosphere>>>;

/// The atmosphere of a row; each air is solved once for all tests.
fn atmosphere(row: Row) -> Arc<Atmosphere> {
    static SOLVED: LazyLock<Mutex<BTreeMap<String, Shared>>> = LazyLock::new(Mutex::default);
    let names = ["aod550", "albedo", "ozone_du"];
    let key = names.map(|name| row.text(name)).join(" ");
    let air = Air {
        aod: row.get("aod550"),
        ground_albedo: row.get("albedo"),
        ozone_du: row.get("ozone_du"),
        ..Air::default()
    };
    let cell = SOLVED.lock().unwrap().entry(key).or_default().clone();
    cell.get_or_init(|| Arc::new(Atmosphere::new(&air))).clone()
}

/// The same at the altitude of the row.
fn observer(row: Row, solved: &Atmosphere) -> Atmosphere {
    let mut atmosphere = solved.clone();
    atmosphere.air.altitude_m = 1000.0 * row.get("altitude_km");
    atmosphere
}

/// u', v' of CIE 1976.
fn chromaticity(xyz: DVec3) -> [f64; 2] {
    let sum = xyz.x + 15.0 * xyz.y + 3.0 * xyz.z;
    [4.0 * xyz.x / sum, 9.0 * xyz.y / sum]
}

/// Ranges of the sun's elevation with the bounds of luminance (median, 95 %) and u'v' (95 %) for AOD up to 0.2.
const GROUPS: [(&str, f64, f64, [f64; 3]); 4] = [
    ("10..90", 10.0, 90.0, [0.025, 0.08, 0.005]),
    ("1..9", 1.0, 9.9, [0.03, 0.12, 0.006]),
    ("-6..0", -6.0, 0.9, [0.04, 0.16, 0.012]),
    ("-12..-7", -12.0, -6.1, [0.12, f64::INFINITY, f64::INFINITY]),
];

/// Errors of directions: of luminance beyond twice the standard error, and of u'v'.
#[derive(Default)]
struct Errors {
    luminance: Vec<f64>,
    chromaticity: Vec<f64>,
    skipped: usize,
}

#[test]
fn the_sky_is_that_of_a_monte_carlo_solution() {
    let Some(table) = Table::at("sky/sky_radiance.csv") else {
        return;
    };
    let mut errors: BTreeMap<(bool, usize), Errors> = BTreeMap::new();
    let mut last = (String::new(), None);
    for row in table.rows() {
        let sun = row.get("sun_elevation");
        let Some(group) = GROUPS.iter().position(|g| sun >= g.1 && sun <= g.2) else {
            continue;
        };
        let hazy = row.get("aod550") > 0.3;
        let entry = errors.entry((hazy, group)).or_default();
        let (expected, error) = (row.get("Y_cd_m2"), row.get("Y_stderr"));
        if error > 0.1 * expected {
            entry.skipped += 1;
            continue;
        }
        let key = ["aod550", "albedo", "ozone_du", "altitude_km"].map(|name| row.text(name));
        if last.0 != key.join(" ") {
            let solved = atmosphere(row);
            last = (key.join(" "), Some(observer(row, &solved)));
        }
        let sky = last.1.as_ref().unwrap();
        let azimuth = row.get("view_azimuth_from_sun");
        let view = direction(azimuth, row.get("view_elevation"));
        let found = sky.radiance(direction(0.0, sun), view);
        let off = (luminance(found) / expected - 1.0).abs() - 2.0 * error / expected;
        entry.luminance.push(off.max(0.0));
        let reference = DVec3::new(row.get("X"), expected, row.get("Z"));
        let ([u, v], [u0, v0]) = (chromaticity(xyz_from_rgb(found)), chromaticity(reference));
        entry.chromaticity.push((u - u0).hypot(v - v0));
    }
    let mut failures = Vec::new();
    for ((hazy, group), entry) in &mut errors {
        let (name, _, _, bounds) = GROUPS[*group];
        let found = [
            at_share(&mut entry.luminance, 0.5),
            at_share(&mut entry.luminance, 0.95),
            at_share(&mut entry.chromaticity, 0.95),
        ];
        let aod = if *hazy { "0.4" } else { "<= 0.2" };
        println!(
            "sun {name:>8}, AOD {aod:>6}: {:3} directions, {:3} skipped; luminance {:.2} % {:.2} %, u'v' {:.4}",
            entry.luminance.len(),
            entry.skipped,
            100.0 * found[0],
            100.0 * found[1],
            found[2]
        );
        let factor = if *hazy { 2.0 } else { 1.0 };
        if found
            .iter()
            .zip(bounds)
            .any(|(f, bound)| *f > factor * bound)
        {
            failures.push(name);
        }
    }
    assert!(errors.len() >= 8 && failures.is_empty(), "{failures:?}");
}

/// Bound of the sky's illuminance for AOD up to 0.2, by the sun's elevation.
fn illuminance_bound(sun: f64) -> f64 {
    match sun {
        5.0.. => 0.015,
        1.0.. => 0.02,
        -5.0.. => 0.04,
        -6.0.. => 0.06,
        -9.0.. => 0.1,
        -12.0.. => 0.15,
        _ => f64::INFINITY,
    }
}

#[test]
fn illuminances_are_those_of_a_monte_carlo_solution() {
    let Some(table) = Table::at("sky/illuminance.csv") else {
        return;
    };
    let mut direct = Worst::new("illuminance of the sun above 1 lux", 0.002);
    let mut worst: BTreeMap<(bool, u64), f64> = BTreeMap::new();
    let mut failures = Vec::new();
    for row in table.rows() {
        let sky = observer(row, &atmosphere(row));
        let (sun, hazy) = (row.get("sun_elevation"), row.get("aod550") > 0.3);
        let sine = sun.to_radians().sin();
        let (expected, error) = (row.get("E_diffuse_lux"), row.get("E_stderr"));
        let off = luminance(sky.diffuse_illuminance(sine)) / expected - 1.0;
        let bound = illuminance_bound(sun) * if hazy { 2.0 } else { 1.0 };
        let beyond = (off.abs() - 2.0 * error / expected).max(0.0);
        let group = worst.entry((hazy, (1e3 * bound) as u64)).or_default();
        *group = group.max(beyond);
        if beyond > bound {
            failures.push(format!("{} {sun}: {off:+.4}", row.text("aod550")));
        }
        let expected = row.get("direct_normal_lux");
        // The reference has no disc: at 0 degrees half of ours is below the horizon.
        let whole = if sun == 0.0 && row.get("altitude_km") == 0.0 {
            2.0
        } else {
            1.0
        };
        let found = whole * luminance(sky.sun_illuminance(sine));
        if expected > 1.0 {
            let at = format!("AOD {} at {sun}", row.text("aod550"));
            direct.see(found / expected - 1.0, at);
        } else {
            assert!(found < 1.0, "{found} lux at {sun}");
        }
    }
    let judged = worst.iter().filter(|((_, bound), _)| *bound < 1000);
    for ((hazy, bound), off) in judged {
        println!(
            "hazy {hazy}, bound {bound} permille: worst {:.2} % beyond twice the standard error",
            100.0 * off
        );
    }
    direct.finish();
    assert!(failures.is_empty(), "{failures:?}");
}

#[test]
fn the_air_before_a_mountain_is_that_of_a_monte_carlo_solution() {
    let Some(table) = Table::at("sky/aerial.csv") else {
        return;
    };
    let white = luminance_of_transfer(DVec3::ONE);
    let mut errors = Vec::new();
    let (mut of_table, mut tables) = (Vec::new(), BTreeMap::new());
    let mut skipped = 0;
    // Beyond 4 in optical depth nothing is seen.
    let mut transmittance = Worst::new("transmittance above 0.01", 0.015);
    for row in table.rows() {
        let sky = atmosphere(row);
        let view = direction(row.get("view_azimuth_from_sun"), row.get("view_elevation"));
        let sun = direction(0.0, row.get("sun_elevation"));
        let air = sky.aerial(sun, view, row.get("distance_km"));
        let key = ["aod550", "sun_elevation"].map(|name| row.text(name));
        let table = tables.entry(key).or_insert_with(|| {
            AirBefore::new(
                &ScatteredSky::new((*sky).clone(), sun),
                row.get("altitude_km"),
            )
        });
        let looked_up = table.between(view, row.get("distance_km"));
        let expected = row.get("transmittance_Y");
        for air in [&air, &looked_up] {
            let through = luminance_of_transfer(air.transmittance) / white;
            if expected > 0.01 {
                transmittance.see(through / expected - 1.0, row.text("distance_km"));
            }
        }
        let (expected, error) = (row.get("inscatter_Y_cd_m2"), row.get("Y_stderr"));
        if error > 0.1 * expected {
            skipped += 1;
            continue;
        }
        for (air, errors) in [(&air, &mut errors), (&looked_up, &mut of_table)] {
            let off = (luminance(air.inscatter) / expected - 1.0).abs() - 2.0 * error / expected;
            errors.push(off.max(0.0));
        }
    }
    for (what, mut errors) in [("path by path", errors), ("from the table", of_table)] {
        let found = [0.5, 0.95].map(|share| at_share(&mut errors, share));
        println!(
            "in-scatter, {what}: {} paths, {skipped} skipped; {:.2} % {:.2} %",
            errors.len(),
            100.0 * found[0],
            100.0 * found[1]
        );
        assert!(found[0] <= 0.05 && found[1] <= 0.2, "{what}");
    }
    transmittance.finish();
}

/// Luminance of the sun outside the air times a transmittance by channel.
fn luminance_of_transfer(transmittance: DVec3) -> f64 {
    use skylight::daylight::{atmosphere::colour::xyz, colour::rgb_from_xyz};
    luminance(rgb_from_xyz(xyz(DVec4::ONE)) * transmittance)
}

#[test]
fn nothing_is_negative_infinite_or_nan_in_any_air() {
    let ends =
        |low: f64, high: f64, bit: usize, i: usize| if i >> bit & 1 == 0 { low } else { high };
    let mut count = 0;
    for i in 0..16 {
        let air = Air {
            aod: ends(0.0, 0.6, 0, i),
            ozone_du: ends(0.0, 600.0, 1, i),
            altitude_m: ends(0.0, 10_000.0, 2, i),
            ground_albedo: ends(0.0, 1.0, 3, i),
            aerosol: Aerosol {
                single_scattering_albedo: ends(0.8, 1.0, 2, i),
                asymmetry: ends(0.0, 0.85, 3, i),
                scale_height_km: ends(0.5, 8.0, 1, i),
                angstrom: ends(0.0, 2.5, 0, i),
            },
        };
        let sky = Atmosphere::with(&air.valid().unwrap(), WAVELENGTHS, &Effort::COARSE);
        for sun in [
            -90.0, -40.0, -18.0, -9.0, -3.0, -0.2, 0.0, 0.2, 5.0, 40.0, 90.0,
        ] {
            let toward = direction(70.0, sun);
            let mut check = |value: DVec3, what: &str| {
                assert!(value.is_finite(), "{value} of {what} at {sun} in {air:?}");
                let clipped = clip_negative(value);
                assert!(clipped.min_element() >= 0.0, "{value} of {what} at {sun}");
                count += 3;
            };
            check(sky.sun_illuminance(toward.y), "the sun");
            check(sky.diffuse_illuminance(toward.y), "the sky");
            for elevation in [-90.0, -30.0, -3.3, -1e-6, 0.0, 1e-6, 1.0, 20.0, 90.0] {
                for azimuth in [70.0, 71.0, 160.0, 250.0] {
                    let view = direction(azimuth, elevation);
                    check(sky.radiance(toward, view), "a direction");
                    let air = sky.aerial(toward, view, 30.0);
                    check(air.inscatter, "the air before");
                    check(air.transmittance, "its transmittance");
                }
            }
        }
    }
    println!("{count} values");
    assert!(count > 40_000);
}

#[test]
fn the_table_of_the_view_holds_the_sky_that_it_was_made_of() {
    let mut sky = Atmosphere::with(&Air::default(), WAVELENGTHS, &Effort::COARSE);
    for (altitude, sun) in [(0.0, 40.0), (0.0, -5.0), (3000.0, 8.0)] {
        sky.air.altitude_m = altitude;
        let toward = direction(200.0, sun);
        let view = SkyView::new(&sky, toward);
        let mut errors: Vec<f64> = (0..1000)
            .map(|i| {
                let sine = (f64::from(i) + 0.5) / 500.0 - 1.0;
                let dir = direction(f64::from(i) * 137.508, sine.asin().to_degrees());
                let exact = luminance(sky.radiance(toward, dir));
                luminance(view.radiance(dir)) / exact - 1.0
            })
            .map(f64::abs)
            .collect();
        let [middle, most] = [0.5, 0.95].map(|share| at_share(&mut errors, share));
        println!(
            "{altitude} m, sun {sun}: {:.3} % {:.3} %",
            100.0 * middle,
            100.0 * most
        );
        assert!(middle < 0.001 && most < 0.005);
    }
}

#[test]
fn light_falls_without_steps_from_noon_to_night() {
    let sky = Atmosphere::new(&Air::default());
    let lux = |tenth: i32| {
        luminance(sky.diffuse_illuminance((f64::from(tenth) / 10.0).to_radians().sin()))
    };
    let mut before = lux(10);
    for tenth in (-180..10).rev() {
        let now = lux(tenth);
        let ratio = now / before;
        assert!(ratio < 1.0 && ratio > 0.7, "{tenth}: {before} to {now}");
        before = now;
    }
    assert!(before < 1e-4, "{before}");
}

#[test]
fn ozone_makes_the_blue_hour() {
    let zenith = |ozone_du| {
        let sky = Atmosphere::with(
            &Air {
                ozone_du,
                ..Air::default()
            },
            WAVELENGTHS,
            &Effort::COARSE,
        );
        let radiance = sky.radiance(direction(0.0, -4.0), DVec3::Y);
        (luminance(radiance), radiance.z / radiance.x)
    };
    let ((bright, white), (dim, blue)) = (zenith(0.0), zenith(300.0));
    println!(
        "zenith at -4 degrees: {bright:.3} to {dim:.3} cd/m², blue over red {white:.2} to {blue:.2}"
    );
    assert!(bright / dim > 1.8 && blue > 2.0 * white);
}
