//! Sun and sky in numbers, without a device: `cargo run --release --example sun_and_sky`.

use glam::DVec3;
use skylight::daylight::colour::luminance;
use skylight::daylight::sky::{Conditions, Daylight};

fn main() {
    for elevation in [60.0, 30.0, 10.0, 0.0, -6.0] {
        let daylight = Daylight::new(&Conditions {
            sun_elevation_deg: elevation,
            ..Conditions::default()
        });
        let sun = luminance(daylight.sun_illuminance);
        let sky = luminance(daylight.sky_irradiance_up);
        let zenith = luminance(daylight.radiance(DVec3::Y));
        println!("{elevation:4}°: sun {sun:7.0} lux, sky {sky:6.0} lux, zenith {zenith:6.1} cd/m²");
    }
}
