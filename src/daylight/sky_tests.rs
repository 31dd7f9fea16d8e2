//! Every model at every sun: finite, without steps, with its published levels.

use super::*;
use crate::daylight::atmosphere::air::Air;
use crate::daylight::perez::Measured;
use crate::daylight::quadrature::horizontal_irradiance;

const MODELS: [SkyModel; 5] = [
    SkyModel::Preetham,
    SkyModel::Hosek,
    SkyModel::Overcast,
    SkyModel::CieClear,
    SkyModel::Cie8,
];

pub(super) fn conditions(model: SkyModel, elevation: f64) -> Conditions {
    Conditions {
        model,
        sun_elevation_deg: elevation,
        ..Conditions::default()
    }
}

/// Counts the values it is given; each one must be finite and not negative.
#[derive(Default)]
struct Seen(usize);

impl Seen {
    fn check(&mut self, value: DVec3, what: impl Fn() -> String) {
        assert!(
            value.is_finite() && value.min_element() >= 0.0,
            "{value} in {}",
            what()
        );
        self.0 += 3;
    }
}

fn directions() -> Vec<DVec3> {
    let mut all = vec![
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::X,
        DVec3::NEG_X,
        DVec3::Z,
        DVec3::NEG_Z,
    ];
    let elevations = [
        -89.9, -45.0, -1.0, -1e-9, 0.0, 1e-9, 1e-3, 0.1, 1.0, 5.0, 20.0, 50.0, 80.0, 89.9,
    ];
    for elevation in elevations {
        all.extend((0..12).map(|i| direction(30.0 * f64::from(i), elevation)));
    }
    all
}

#[test]
fn nothing_is_ever_negative_infinite_or_nan() {
    let mut seen = Seen::default();
    let directions = directions();
    let turbidities = [-5.0, 0.0, 1.0, 1.7, 2.0, 2.5, 4.0, 7.0, 10.0, 20.0, 50.0];
    for model in MODELS.into_iter().chain([SkyModel::Perez]) {
        for turbidity in turbidities {
            for half_degrees in (-180..=180).filter(|e: &i32| e.abs() < 20 || e % 10 == 0) {
                let elevation = f64::from(half_degrees) / 2.0;
                let mut given = conditions(model, elevation);
                given.turbidity = turbidity;
                given.horizontal_illuminance = (half_degrees % 4 == 0).then_some(1e4);
                given.cloud_cover = f64::from(half_degrees.rem_euclid(3)) / 2.0;
                given.measured.direct_normal_w = 200.0;
                given.measured.diffuse_horizontal_w = 100.0;
                let day = Daylight::new(&given);
                for &dir in directions.iter().chain([&day.sun_direction]) {
                    seen.check(day.radiance(dir), || format!("{dir} of {given:?}"));
                }
                let totals = [
                    day.sun_illuminance,
                    day.sun_luminance,
                    day.sky_irradiance_up,
                    day.ground_luminance,
                ];
                for value in totals {
                    seen.check(value, || format!("the totals of {given:?}"));
                }
            }
        }
    }
    println!("checked {} values", seen.0);
    assert!(seen.0 > 1_000_000, "only {} values", seen.0);
}

#[test]
fn absurd_inputs_are_replaced_and_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for model in MODELS.into_iter().chain([SkyModel::Perez]) {
            let given = Conditions {
                model,
                turbidity: bad,
                ground_albedo: bad,
                sun_azimuth_deg: bad,
                sun_elevation_deg: bad,
                horizontal_illuminance: Some(bad),
                cloud_cover: bad,
                moon: None,
                stars: None,
                measured: Measured {
                    direct_normal_w: bad,
                    diffuse_horizontal_w: bad,
                    dew_point_c: Some(bad),
                    day_of_year: Some(u32::MAX),
                },
                refraction_deg: bad,
                air: Air {
                    aod: bad,
                    ..Air::default()
                },
            };
            let day = Daylight::new(&given);
            let mut seen = Seen::default();
            directions()
                .into_iter()
                .for_each(|dir| seen.check(day.radiance(dir), || format!("{given:?}")));
            assert!(day.warnings.len() >= 5, "{:?}", day.warnings);
            assert!(day.sun_direction.is_normalized());
        }
    }
}

#[test]
fn ordinary_days_have_no_warnings_and_the_models_own_numbers() {
    for model in MODELS {
        let day = Daylight::new(&conditions(model, 45.0));
        assert!(day.warnings.is_empty(), "{:?}", day.warnings);
        assert_eq!(
            (day.guard.scale, day.guard.clouds, day.guard.night),
            (1.0, 0.0, DVec3::ZERO)
        );
        let dir = direction(100.0, 30.0);
        assert_eq!(
            day.sky_radiance(dir),
            colour::clip_negative(day.sky.radiance(dir))
        );
    }
}

#[test]
fn the_sky_fades_without_steps_from_day_to_night() {
    for model in MODELS {
        let mut before: Option<f64> = None;
        for tenth in (-200..=30).rev() {
            let day = Daylight::new(&conditions(model, f64::from(tenth) / 10.0));
            let lux = colour::luminance(day.sky_irradiance_up);
            if let Some(before) = before {
                assert!(
                    lux <= before * 1.001 && lux > before * 0.5,
                    "{model:?} {tenth} {before} {lux}"
                );
            }
            before = Some(lux);
        }
        let night = Daylight::new(&conditions(model, -40.0));
        let all_night = Daylight::new(&conditions(model, -90.0));
        assert!((night.sky_irradiance_up - all_night.sky_irradiance_up).length() < 1e-6);
        assert!(
            (colour::luminance(night.sky_irradiance_up) / (PI * NIGHT_LUMINANCE) - 1.0).abs()
                < 1e-3
        );
        assert_eq!(night.sun_illuminance, DVec3::ZERO);
    }
}

#[test]
fn twilight_has_its_published_illuminances_whatever_the_model() {
    for model in MODELS {
        for (elevation, lux) in [(-6.0, 2.65), (-12.0, 0.008), (-18.0, 6e-4)] {
            let day = Daylight::new(&conditions(model, elevation));
            let sunlight = colour::luminance(day.sky_irradiance_up - day.guard.night * PI);
            assert!(
                (sunlight / lux - 1.0).abs() < 1e-6,
                "{model:?} {elevation} {sunlight}"
            );
        }
    }
    assert_eq!(twilight_illuminance(0.0, 800.0), 800.0);
}

#[test]
fn the_ground_reflects_sun_and_sky() {
    let mut given = conditions(SkyModel::Preetham, 30.0);
    given.ground_albedo = 0.5;
    let day = Daylight::new(&given);
    let expected = (day.sun_illuminance * 0.5 + day.sky_irradiance_up) * 0.5 / PI;
    assert!(
        (day.radiance(DVec3::NEG_Y) / expected - 1.0)
            .abs()
            .max_element()
            < 1e-12
    );
    given.ground_albedo = 0.0;
    assert_eq!(
        Daylight::new(&given).radiance(direction(12.0, -0.1)),
        DVec3::ZERO
    );
}

#[test]
fn a_given_illuminance_is_met() {
    for model in MODELS {
        for elevation in [-20.0, 0.0, 40.0] {
            let mut given = conditions(model, elevation);
            given.horizontal_illuminance = Some(8000.0);
            let lux = colour::luminance(Daylight::new(&given).sky_irradiance_up);
            assert!(
                (lux / 8000.0 - 1.0).abs() < 1e-9,
                "{model:?} {elevation} {lux}"
            );
        }
    }
}

#[test]
fn a_setting_sun_is_in_gamut_and_half_as_bright_on_the_horizon() {
    let day = |elevation| Daylight::new(&conditions(SkyModel::Preetham, elevation));
    let (up, half) = (day(0.27), day(0.0));
    assert!(half.sun_illuminance.min_element() >= 0.0);
    let sunlight = Sunlight::new(3.0, 0.0);
    let ratio = colour::luminance(half.sun_illuminance) / colour::luminance(sunlight.illuminance());
    assert!((ratio - 0.5).abs() < 1e-9, "{ratio}");
    assert!(colour::luminance(up.sun_illuminance) > colour::luminance(half.sun_illuminance));
    assert_eq!(day(-0.27).sun_luminance, DVec3::ZERO);
}

#[test]
fn the_horizontal_illuminance_is_integrated_finely_enough() {
    use crate::daylight::quadrature::SphereQuadrature;
    let fine = SphereQuadrature::upper(256, 512);
    for model in MODELS {
        for (turbidity, elevation) in [
            (2.0, 1.0),
            (2.0, 30.0),
            (3.0, 60.0),
            (8.0, 10.0),
            (3.0, 90.0),
        ] {
            let given = Conditions {
                turbidity,
                ..conditions(model, elevation)
            };
            let day = Daylight::new(&given);
            let reference = fine.irradiance(DVec3::Y, |dir| day.sky_radiance(dir));
            let error = (day.sky_irradiance_up / reference - 1.0)
                .abs()
                .max_element();
            println!(
                "{model:?} T {turbidity} el {elevation}: {:.0} lux, error {error:.1e}, sun {:.0} lux",
                colour::luminance(day.sky_irradiance_up),
                colour::luminance(day.sun_illuminance)
            );
            assert!(error < 1e-4, "{given:?} {error:e}");
        }
    }
}

#[test]
fn an_atmosphere_has_its_own_twilight_and_always_the_night() {
    for elevation in [50.0, 0.0, -8.0, -30.0] {
        let given = conditions(SkyModel::Atmosphere, elevation);
        let day = Daylight::new(&given);
        assert!(day.warnings.is_empty(), "{:?}", day.warnings);
        assert_eq!(day.guard.scale, 1.0);
        assert_eq!(day.guard.night, DVec3::splat(NIGHT_LUMINANCE));
        // The table of the view and the sum over directions are two ways to the same light.
        let seen = horizontal_irradiance(|dir| day.sky_radiance(dir));
        let ratio = colour::luminance(seen) / colour::luminance(day.sky_irradiance_up);
        println!("{elevation}: {ratio}");
        assert!((ratio - 1.0).abs() < 3e-3, "{elevation}: {ratio}");
        let ground = day.radiance(DVec3::NEG_Y);
        let expected = colour::luminance(day.ground_luminance);
        assert!((colour::luminance(ground) / expected - 1.0).abs() < 1e-6);
    }
}

#[test]
fn an_atmosphere_follows_the_true_sun_and_its_disc_the_apparent_one() {
    let lifted = Conditions {
        refraction_deg: 0.48,
        ..conditions(SkyModel::Atmosphere, 0.48)
    };
    let (lifted, plain) = (
        Daylight::new(&lifted),
        Daylight::new(&conditions(SkyModel::Atmosphere, 0.0)),
    );
    let up = |day: &Daylight| colour::luminance(day.sky_irradiance_up);
    assert!((up(&lifted) / up(&plain) - 1.0).abs() < 1e-9);
    let sun = |day: &Daylight| colour::luminance(day.sun_illuminance);
    assert!(sun(&lifted) > 2.0 * sun(&plain) && lifted.sun_direction.y > plain.sun_direction.y);
}

#[test]
fn a_given_illuminance_and_clouds_change_an_atmosphere_too() {
    let mut given = conditions(SkyModel::Atmosphere, 20.0);
    given.horizontal_illuminance = Some(8000.0);
    let lux = colour::luminance(Daylight::new(&given).sky_irradiance_up);
    assert!((lux / 8000.0 - 1.0).abs() < 1e-9, "{lux}");
    given.horizontal_illuminance = None;
    let clear = Daylight::new(&given);
    given.cloud_cover = 1.0;
    let cloudy = Daylight::new(&given);
    assert!(cloudy.sun_illuminance.max_element() < 0.01 * clear.sun_illuminance.max_element());
    let ratio = |day: &Daylight| {
        let seen = horizontal_irradiance(|dir| day.sky_radiance(dir));
        colour::luminance(seen) / colour::luminance(day.sky_irradiance_up)
    };
    assert!((ratio(&cloudy) - 1.0).abs() < 3e-3);
}
