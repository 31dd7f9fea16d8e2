//! The stars against facts that are not in the table.

use super::*;
use crate::daylight::atmosphere::air::Air;
use crate::daylight::colour::luminance;

/// The star nearest to right ascension (hours, minutes) and declination (degrees), which must be within half a degree.
fn near(hours: f64, minutes: f64, declination_deg: f64) -> Star {
    let (ra, dec) = (
        ((hours + minutes / 60.0) * 15.0).to_radians(),
        declination_deg.to_radians(),
    );
    let place = DVec3::new(ra.cos() * dec.cos(), ra.sin() * dec.cos(), dec.sin());
    let bright = catalogue().iter().filter(|star| star.magnitude < 3.0);
    let found = *bright
        .max_by(|a, b| a.direction.dot(place).total_cmp(&b.direction.dot(place)))
        .unwrap();
    assert!(
        apart(found.direction, place) < 0.5,
        "{hours}h {declination_deg}"
    );
    found
}

fn apart(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

fn when(text: &str) -> DateTime<FixedOffset> {
    DateTime::parse_from_rfc3339(text).unwrap()
}

#[test]
fn known_stars_stand_where_they_are_and_as_far_apart_as_they_are() {
    let stars = catalogue();
    assert_eq!(stars.len(), 1608);
    assert!(stars.is_sorted_by(|a, b| a.magnitude <= b.magnitude));
    // Sirius, Canopus, Arcturus, Alpha Centauri A, Vega.
    let bright = [
        (near(6.0, 45.1, -16.7), -1.46),
        (near(6.0, 24.0, -52.7), -0.74),
        (near(14.0, 15.7, 19.2), -0.05),
        (near(14.0, 39.6, -60.8), 0.0),
        (near(18.0, 36.9, 38.8), 0.03),
    ];
    for ((star, magnitude), first) in bright.iter().zip(stars) {
        assert!(*star == *first && (star.magnitude - magnitude).abs() < 0.15);
    }
    // The pointers of the Great Bear, 5.4° apart, lead to Polaris, 28.7° from Dubhe; Orion's belt is 2.7° long.
    let (dubhe, merak) = (near(11.0, 3.7, 61.8), near(11.0, 1.8, 56.4));
    let polaris = near(2.0, 31.8, 89.3);
    let (alnitak, mintaka) = (near(5.0, 40.8, -1.9), near(5.0, 32.0, -0.3));
    for (a, b, degrees) in [
        (dubhe, merak, 5.4),
        (dubhe, polaris, 28.7),
        (alnitak, mintaka, 2.7),
    ] {
        let found = apart(a.direction, b.direction);
        assert!((found - degrees).abs() < 0.06, "{found} {degrees}");
    }
    // Betelgeuse is red and Rigel blue, as bright as each other within half a magnitude.
    let (red, blue) = (near(5.0, 55.2, 7.4), near(5.0, 14.5, -8.2));
    let share = |star: Star| star.illuminance.x / star.illuminance.z;
    assert!(
        share(red) > 2.5 && share(blue) < 0.9,
        "{} {}",
        share(red),
        share(blue)
    );
    for star in [red, blue] {
        let expected = MAGNITUDE_ZERO_LUX * 10f64.powf(-0.4 * star.magnitude);
        assert!((luminance(star.illuminance) / expected - 1.0).abs() < 1e-3);
    }
}

#[test]
fn the_pole_star_stands_as_high_as_the_latitude_and_north() {
    let polaris = near(2.0, 31.8, 89.3);
    for (latitude, longitude) in [(55.68, 12.57), (20.0, -155.0), (80.0, 100.0)] {
        for hour in 0..24 {
            let moment = when(&format!("2026-03-05T{hour:02}:30:00Z"));
            let mut sky = StarrySky::at(moment, latitude, longitude).unwrap();
            sky.is_refracted = false;
            let (azimuth, elevation) = azimuth_elevation(sky.toward(&polaris));
            assert!((elevation - latitude).abs() < 0.7, "{elevation} {latitude}");
            assert!(azimuth.to_radians().sin().abs() * latitude.to_radians().cos() < 0.013);
        }
    }
}

#[test]
fn stars_culminate_when_the_sidereal_time_is_their_right_ascension() {
    // Greenwich's sidereal time at 2000-01-01T12:00 UT1 is 18 h 41 min 50.5 s (Explanatory Supplement): 280.46°. A day has 360.98565°.
    let sirius = near(6.0, 45.1, -16.7);
    let days: f64 = 9555.0;
    let sidereal = 280.46062 + 360.985_647_37 * days;
    // 2026-02-28T12:00 is 9555 days later; over this longitude Sirius, at 101.29 + 0.29° of precession, is in the south.
    let longitude = (101.287 + 0.290 - sidereal + 180.0).rem_euclid(360.0) - 180.0;
    let moment = when("2026-02-28T12:00:00Z");
    let mut sky = StarrySky::at(moment, 40.0, longitude).unwrap();
    sky.is_refracted = false;
    let (azimuth, elevation) = azimuth_elevation(sky.toward(&sirius));
    println!("Sirius culminates at {azimuth:.3} {elevation:.3}");
    assert!((azimuth - 180.0).abs() < 0.05, "{azimuth}");
    assert!((elevation - (50.0 - 16.75)).abs() < 0.05, "{elevation}");
    // Refraction lifts it by 1.5 minutes of arc there.
    sky.is_refracted = true;
    let lifted = azimuth_elevation(sky.toward(&sirius)).1 - elevation;
    assert!((lifted - 1.5 / 60.0).abs() < 0.005, "{lifted}");
}

#[test]
fn the_air_dims_low_stars_most_and_hides_those_that_have_set() {
    let atmosphere = Atmosphere::of(&Air::default());
    let sky = StarrySky::at(when("2026-02-28T22:00:00+01:00"), 55.68, 12.57).unwrap();
    let seen = sky.seen(&atmosphere);
    assert!((600..1100).contains(&seen.len()), "{}", seen.len());
    let all = catalogue().iter();
    let up: Vec<&Star> = all.filter(|star| sky.toward(star).y > 0.0).collect();
    assert_eq!(up.len(), seen.len());
    for (star, seen) in up.iter().zip(&seen) {
        let share = luminance(seen.illuminance) / luminance(star.illuminance);
        // Some 0.24 magnitudes in the zenith, 5 and more at the horizon.
        assert!(share > 0.0 && share < 0.85, "{share}");
        assert!(seen.direction.y < 0.9 || share > 0.76, "{share}");
        assert!(seen.direction.y > 0.05 || share < 0.3, "{share}");
    }
    let lux: f64 = seen
        .iter()
        .map(|s| luminance(s.illuminance) * s.direction.y)
        .sum();
    println!("{} stars, {lux:.1e} lux on the ground", seen.len());
    // Of the 8e-4 lux of the night.
    assert!(lux < 1e-4 && lux > 1e-5);
    let clouded = StarrySky { clear: 0.5, ..sky }.seen(&atmosphere);
    assert_eq!(clouded[0].illuminance, seen[0].illuminance * 0.5);
}

#[test]
fn nonsense_is_refused() {
    let moment = when("2026-01-03T10:00:00Z");
    assert!(StarrySky::at(moment, 91.0, 0.0).is_err());
    assert!(StarrySky::at(moment, 0.0, f64::NAN).is_err());
}
