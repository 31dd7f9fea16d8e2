//! The air that the moon lights.

use super::tests::conditions;
use super::*;
use crate::daylight::moon::{MEAN_DISTANCE_KM, Moon};
use crate::daylight::quadrature::horizontal_irradiance;

/// An atmosphere under a sun in the south and a full moon in the west.
fn moonlit(sun_deg: f64, moon_deg: f64) -> Daylight {
    clouded_moonlit(sun_deg, moon_deg, 0.0)
}

fn clouded_moonlit(sun_deg: f64, moon_deg: f64, cloud_cover: f64) -> Daylight {
    let moon = Moon {
        azimuth_deg: 270.0,
        elevation_deg: moon_deg,
        apparent_elevation_deg: moon_deg,
        distance_km: MEAN_DISTANCE_KM,
        phase_angle_deg: 0.0,
        sunward: -direction(270.0, moon_deg),
    };
    Daylight::new(&Conditions {
        moon: Some(moon),
        cloud_cover,
        ..conditions(SkyModel::Atmosphere, sun_deg)
    })
}

/// Illuminance by the lit air, without that of airglow and stars, lux.
fn air_lux(day: &Daylight) -> f64 {
    colour::luminance(day.sky_irradiance_up - day.guard.night * PI)
}

#[test]
fn the_air_scatters_the_moons_light_as_the_suns() {
    for elevation in [5.0, 45.0, 80.0] {
        let share = |day: &Daylight| {
            let direct = day.direct_light();
            air_lux(day) / (colour::luminance(direct.illuminance) * direct.direction.y)
        };
        let (moon, sun) = (
            share(&moonlit(-40.0, elevation)),
            share(&Daylight::new(&conditions(SkyModel::Atmosphere, elevation))),
        );
        println!("{elevation}: sky over direct light {moon:.4}");
        assert!((moon / sun - 1.0).abs() < 1e-4, "{elevation}: {moon} {sun}");
        assert!(elevation != 45.0 || (0.1..0.25).contains(&moon));
    }
}

#[test]
fn a_moonlit_sky_sums_up_to_its_illuminance_and_shows_the_ground_of_the_observer() {
    for (sun, moon) in [(-40.0, 45.0), (-40.0, 3.0), (-12.0, -4.0), (-3.0, 20.0)] {
        let day = moonlit(sun, moon);
        let seen = horizontal_irradiance(|dir| day.sky_radiance(dir));
        let ratio = colour::luminance(seen) / colour::luminance(day.sky_irradiance_up);
        assert!((ratio - 1.0).abs() < 3e-3, "{sun} {moon}: {ratio}");
        let ground = colour::luminance(day.radiance(DVec3::NEG_Y));
        let expected = colour::luminance(day.ground_luminance);
        assert!((ground / expected - 1.0).abs() < 1e-6, "{sun} {moon}");
    }
}

/// The value between `low` and `high` at which `is` changes.
fn change(mut low: f64, mut high: f64, is: impl Fn(f64) -> bool) -> [f64; 2] {
    let first = is(low);
    assert_ne!(first, is(high));
    while (high - low).abs() > 1e-6 {
        let middle = 0.5 * (low + high);
        if is(middle) == first {
            low = middle;
        } else {
            high = middle;
        }
    }
    [low, high]
}

#[test]
fn the_moons_sky_comes_and_goes_without_a_visible_step() {
    let has_moon = |day: &Daylight| matches!(&day.sky, Sky::Atmosphere(sky) if sky.moon.is_some());
    // By dusk.
    let [before, after] =
        change(30.0, -20.0, |sun| has_moon(&moonlit(sun, 30.0))).map(|sun| moonlit(sun, 30.0));
    assert!(before.sun_illuminance.y > 0.0 && after.sun_illuminance.y > 0.0);
    assert!((air_lux(&after) / air_lux(&before) - 1.0).abs() < 1e-5);
    for degrees in [0.5, 2.0, 10.0, 60.0] {
        let dir = direction(270.0, 30.0 + degrees);
        let step = after.radiance(dir) / before.radiance(dir) - 1.0;
        println!("{degrees} from the moon: {:.1e}", step.abs().max_element());
        // A tenth of a step of 8 bits.
        assert!(step.abs().max_element() < 4e-4, "{degrees}: {step}");
    }
    // By moonset.
    let [below, above] = change(-30.0, 30.0, |moon| has_moon(&moonlit(-40.0, moon)))
        .map(|moon| moonlit(-40.0, moon));
    for azimuth in [0.0, 90.0, 260.0, 270.0] {
        let dir = direction(azimuth, 2.0);
        let step = above.radiance(dir) / below.radiance(dir) - 1.0;
        println!("{azimuth}: {:.1e}", step.abs().max_element());
        assert!(step.abs().max_element() < 4e-3, "{azimuth}: {step}");
    }
}

#[test]
fn clouds_take_the_moons_direct_light_and_give_it_as_theirs() {
    let clear = moonlit(-40.0, 45.0);
    let cloudy = clouded_moonlit(-40.0, 45.0, 1.0);
    assert!(cloudy.moon.is_none());
    let ratio = air_lux(&cloudy) / (colour::luminance(clear.horizontal()) - PI * NIGHT_LUMINANCE);
    assert!((ratio - 0.25).abs() < 1e-6, "{ratio}");
}
