//! A daylight: sun, sky and ground at one moment; finite and not negative for any input.
//!
//! The models are valid for a sun above the horizon and a range of turbidities. [`Daylight::new`] keeps them within that range
//! with the numbers of [`Guard`], which a shader applies in the same way:
//!
//! sky = clip(model(direction, guard.sun_direction)) · guard.scale + guard.night, where clip is [`colour::clip_negative`].

use std::f64::consts::PI;

use glam::DVec3;

use super::atmosphere::air::Air;
use super::atmosphere::scattered_sky::ScatteredSky;
use super::atmosphere::{Atmosphere, sun_share};
use super::cie::{CieClear, Overcast, SkyCover, daylight_availability};
use super::colour;
use super::hosek::{self, Hosek};
use super::preetham::{self, Preetham};
use super::quadrature::horizontal_irradiance;
use super::sun_position::direction;
use super::sunlight::{SUN_SOLID_ANGLE, Sunlight, visible_fraction};

/// Luminance of the night sky without moon and light pollution, cd/m²: 252 µcd/m² of airglow and stars
/// (Cinzano, Falchi & Elvidge 2001).
pub const NIGHT_LUMINANCE: f64 = 2.52e-4;

/// Horizontal illuminances of a clear evening, lux, with the sun at -6°, -12° and -18°: the ends of civil, nautical and
/// astronomical twilight (American Meteorological Society, Glossary of Meteorology, "civil twilight": 3.5..2 lux at -6°,
/// "astronomical twilight": 0.008 lux at -12°, 6e-4 lux of scattered sunlight at -18°).
pub const TWILIGHT_LUX: [f64; 3] = [2.65, 0.008, 6e-4];

/// Model of the sky.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SkyModel {
    /// Clear sky of Preetham, Shirley & Smits 1999 (the lecture's).
    #[default]
    Preetham,
    /// Clear sky of Hošek & Wilkie 2012.
    Hosek,
    /// CIE standard overcast sky; no sun.
    Overcast,
    /// CIE standard clear sky, white.
    CieClear,
    /// Clear sky with all orders of scattering on the sphere, from noon to night: [`super::atmosphere`].
    Atmosphere,
}

impl SkyModel {
    /// Turbidities for which the model (or the sun's spectrum, if the model has no turbidity) is valid.
    pub fn turbidity_range(self) -> (f64, f64) {
        match self {
            Self::Preetham => preetham::TURBIDITY_RANGE,
            Self::Hosek | Self::Overcast | Self::CieClear | Self::Atmosphere => {
                hosek::TURBIDITY_RANGE
            }
        }
    }
}

/// Parameters of a daylight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Model of the sky.
    pub model: SkyModel,
    /// Turbidity T: 2 very clear, 3 clear, 6 hazy, 10 murky. Clamped to [`SkyModel::turbidity_range`].
    pub turbidity: f64,
    /// Diffuse reflectance of the ground, 0..=1; 0 is black below the horizon.
    pub ground_albedo: f64,
    /// Azimuth of the sun, degrees clockwise from north.
    pub sun_azimuth_deg: f64,
    /// Apparent elevation of the sun's centre, degrees in -90..=90.
    pub sun_elevation_deg: f64,
    /// How far the air lifts the sun, degrees: apparent minus true elevation. [`SkyModel::Atmosphere`] lights the air by the true sun; the
    /// others know the apparent one alone.
    pub refraction_deg: f64,
    /// The air of [`SkyModel::Atmosphere`], with [`Conditions::ground_albedo`] instead of its own.
    pub air: Air,
    /// Horizontal diffuse illuminance to which the sky is scaled, lux. `None` uses the model's own (for the CIE skies
    /// [`daylight_availability`]). A measured value is used unchanged, without twilight fade.
    pub horizontal_illuminance: Option<f64>,
}

impl Default for Conditions {
    /// Preetham, turbidity 3, albedo 0.2, sun in the south at 45°.
    fn default() -> Self {
        Self {
            model: SkyModel::default(),
            turbidity: 3.0,
            ground_albedo: 0.2,
            sun_azimuth_deg: 180.0,
            sun_elevation_deg: 45.0,
            refraction_deg: 0.0,
            air: Air::default(),
            horizontal_illuminance: None,
        }
    }
}

/// A sky model with evaluated coefficients.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// See [`Preetham`].
    Preetham(Preetham),
    /// See [`Hosek`].
    Hosek(Hosek),
    /// See [`Overcast`].
    Overcast(Overcast),
    /// See [`CieClear`].
    CieClear(CieClear),
    /// See [`ScatteredSky`].
    Atmosphere(ScatteredSky),
}

impl Sky {
    /// The model's radiance in a unit direction not below the horizon, linear BT.709 RGB, cd/m²; neither clipped nor faded.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        match self {
            Self::Preetham(sky) => sky.radiance(dir),
            Self::Hosek(sky) => sky.radiance(dir),
            Self::Overcast(sky) => sky.radiance(dir),
            Self::CieClear(sky) => sky.radiance(dir),
            Self::Atmosphere(sky) => sky.radiance(dir),
        }
    }

    /// Illuminance of a horizontal plane by the clipped model, linear BT.709 RGB, lux.
    fn irradiance_up(&self) -> DVec3 {
        match self {
            Self::Atmosphere(sky) => {
                colour::clip_negative(sky.atmosphere.diffuse_illuminance(sky.sun.y))
            }
            _ => horizontal_irradiance(|dir| colour::clip_negative(self.radiance(dir))),
        }
    }
}

/// Extends a model beyond its valid range: sky = clip(model) · `scale` + `night`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guard {
    /// Unit vector toward the sun for evaluating the model: the sun's own, or on the horizon above a sun that has set.
    pub sun_direction: DVec3,
    /// Factor on the model's radiance: 1 by day, falling with [`twilight_illuminance`] in twilight. With a given horizontal
    /// illuminance, the ratio of that to the model's.
    pub scale: f64,
    /// Added radiance, linear BT.709 RGB, cd/m²: 0 by day, [`NIGHT_LUMINANCE`] (white) after twilight, (1 - `scale`) of it between; with
    /// [`SkyModel::Atmosphere`] always the whole.
    pub night: DVec3,
}

/// Sun, sky and ground at one moment. Every number is finite and none is negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Daylight {
    /// Unit vector toward the sun's centre, which may be below the horizon.
    pub sun_direction: DVec3,
    /// Illuminance of the sun at normal incidence, linear BT.709 RGB, lux; 0 once its disc has set.
    pub sun_illuminance: DVec3,
    /// Luminance of the sun's disc, linear BT.709 RGB, cd/m²; 0 once it has set entirely.
    pub sun_luminance: DVec3,
    /// Model of the sky.
    pub sky: Sky,
    /// Parameters that extend the model beyond its valid range.
    pub guard: Guard,
    /// Illuminance of the sky on a horizontal plane that faces up, linear BT.709 RGB, lux.
    pub sky_irradiance_up: DVec3,
    /// Radiance of everything below the horizon, linear BT.709 RGB, cd/m²: albedo/π (E_sun sin el + E_sky).
    pub ground_luminance: DVec3,
    /// Corrections of the conditions, one sentence each.
    pub warnings: Vec<String>,
}

impl Daylight {
    /// The daylight of `conditions`. Values out of range are replaced; `warnings` lists them.
    pub fn new(conditions: &Conditions) -> Self {
        let mut warnings = Vec::new();
        let valid = validated(conditions, &mut warnings);
        let elevation = valid.sun_elevation_deg;
        let (sun_illuminance, sun_luminance) = sun(&valid);
        let above = direction(valid.sun_azimuth_deg, elevation.max(0.0));
        let sky = sky_of(&valid, above);
        let own = sky.irradiance_up();
        let guard = guard_of(&valid, colour::luminance(own), above);
        let sky_irradiance_up = own * guard.scale + guard.night * PI;
        let sun_on_ground = sun_illuminance * elevation.to_radians().sin().max(0.0);
        Self {
            sun_direction: direction(valid.sun_azimuth_deg, elevation),
            sun_illuminance,
            sun_luminance,
            sky,
            guard,
            sky_irradiance_up,
            ground_luminance: (sun_on_ground + sky_irradiance_up) * (valid.ground_albedo / PI),
            warnings,
        }
    }

    /// Radiance in the unit direction `dir`, linear BT.709 RGB, cd/m²: sky without the sun's disc, ground below the horizon.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        match &self.sky {
            Sky::Atmosphere(sky) if sky.view().is_ground(dir) => {
                let (scale, added) = self.ground_of(sky);
                colour::clip_negative(sky.radiance(dir)) * scale + added
            }
            Sky::Atmosphere(_) => guarded(&self.sky, &self.guard, dir),
            _ if dir.y < 0.0 => self.ground_luminance,
            _ => self.sky_radiance(dir),
        }
    }

    /// How the ground that an atmosphere shows becomes [`Self::ground_luminance`] at the observer: a factor, and what the night adds, cd/m².
    pub fn ground_of(&self, sky: &ScatteredSky) -> (f64, DVec3) {
        let added = self.guard.night * sky.atmosphere.medium.ground_albedo;
        let own = colour::luminance(colour::clip_negative(sky.atmosphere.ground_rgb(sky.sun.y)));
        let here = colour::luminance(self.ground_luminance - added).max(0.0);
        let scale = if own > 1e-9 { here / own } else { 1.0 };
        (scale, added)
    }

    /// Radiance of the sky alone, linear BT.709 RGB, cd/m²; black below the horizon.
    pub fn sky_radiance(&self, dir: DVec3) -> DVec3 {
        if dir.y < 0.0 {
            DVec3::ZERO
        } else {
            guarded(&self.sky, &self.guard, dir)
        }
    }
}

fn guarded(sky: &Sky, guard: &Guard, dir: DVec3) -> DVec3 {
    colour::clip_negative(sky.radiance(dir)) * guard.scale + guard.night
}

/// Illuminance (lux) and luminance (cd/m²) of the sun, in gamut; the illuminance fades while the disc sets.
fn sun(valid: &Conditions) -> (DVec3, DVec3) {
    let visible = visible_fraction(valid.sun_elevation_deg);
    if valid.model == SkyModel::Overcast || visible == 0.0 {
        return (DVec3::ZERO, DVec3::ZERO);
    }
    let clip = colour::clip_negative;
    if valid.model == SkyModel::Atmosphere {
        return sun_through_air(valid);
    }
    let sunlight = Sunlight::new(valid.turbidity, valid.sun_elevation_deg);
    (
        clip(sunlight.illuminance()) * visible,
        clip(sunlight.luminance()),
    )
}

/// The same through the air of the conditions: along the apparent direction, in which the eye sees it.
fn sun_through_air(valid: &Conditions) -> (DVec3, DVec3) {
    let atmosphere = atmosphere_of(valid);
    let sine = valid.sun_elevation_deg.to_radians().sin();
    let illuminance = colour::clip_negative(atmosphere.sun_illuminance(sine));
    let share = sun_share(atmosphere.observer(), sine);
    let luminance = illuminance / (share.max(1e-9) * SUN_SOLID_ANGLE);
    (illuminance, luminance)
}

fn atmosphere_of(valid: &Conditions) -> Atmosphere {
    let ground_albedo = valid.ground_albedo;
    Atmosphere::of(&Air {
        ground_albedo,
        ..valid.air
    })
}

fn sky_of(valid: &Conditions, sun_direction: DVec3) -> Sky {
    let available = |cover| daylight_availability(cover, valid.sun_elevation_deg);
    match valid.model {
        SkyModel::Preetham => Sky::Preetham(Preetham::new(valid.turbidity, sun_direction)),
        SkyModel::Hosek => Sky::Hosek(Hosek::new(
            valid.turbidity,
            valid.ground_albedo,
            sun_direction,
        )),
        SkyModel::Overcast => Sky::Overcast(Overcast::new(available(SkyCover::Overcast))),
        SkyModel::CieClear => {
            Sky::CieClear(CieClear::new(available(SkyCover::Clear), sun_direction))
        }
        SkyModel::Atmosphere => {
            let true_deg = valid.sun_elevation_deg - valid.refraction_deg;
            let sun = direction(valid.sun_azimuth_deg, true_deg.clamp(-90.0, 90.0));
            Sky::Atmosphere(ScatteredSky::new(atmosphere_of(valid), sun))
        }
    }
}

/// `own_lux` is the horizontal illuminance of the clipped model.
fn guard_of(valid: &Conditions, own_lux: f64, sun_direction: DVec3) -> Guard {
    let guard = |scale, night| Guard {
        sun_direction,
        scale,
        night: DVec3::splat(night),
    };
    let elevation = valid.sun_elevation_deg;
    match valid.horizontal_illuminance {
        Some(lux) if own_lux > 0.0 => guard(lux / own_lux, 0.0),
        Some(_) => guard(1.0, 0.0),
        // It has its own twilight.
        None if valid.model == SkyModel::Atmosphere => guard(1.0, NIGHT_LUMINANCE),
        None if elevation < 0.0 => {
            let scale = twilight_illuminance(elevation, own_lux) / own_lux;
            guard(scale, NIGHT_LUMINANCE * (1.0 - scale))
        }
        None => guard(1.0, 0.0),
    }
}

/// Horizontal illuminance of a clear sky, lux, with the sun at `elevation_deg` (-90..=0).
///
/// Starts at `sunset_lux` (above 0), the model's value with the sun on the horizon, and passes through [`TWILIGHT_LUX`]; the
/// logarithm is linear in between, and keeps falling below -18°. Continuous and monotonic. Overcast skies use the same values,
/// since no measured ones are known.
pub fn twilight_illuminance(elevation_deg: f64, sunset_lux: f64) -> f64 {
    let [civil, nautical, astronomical] = TWILIGHT_LUX;
    let lux = [sunset_lux, civil, nautical, astronomical];
    let steps = -elevation_deg.min(0.0) / 6.0;
    // A small whole number: the cast truncates.
    let i = (steps as usize).min(2);
    lux[i] * (lux[i + 1] / lux[i]).powf(steps - i as f64)
}

fn validated(conditions: &Conditions, warnings: &mut Vec<String>) -> Conditions {
    let mut valid = *conditions;
    let fallback = Conditions::default();
    let mut limit = |name: &str, value: &mut f64, range: (f64, f64), fallback: f64| {
        let asked = *value;
        *value = if asked.is_nan() {
            fallback
        } else {
            asked.clamp(range.0, range.1)
        };
        if *value != asked {
            let (low, high) = range;
            warnings.push(format!(
                "{name} {asked} is outside {low}..={high}: {value} is used"
            ));
        }
    };
    let range = conditions.model.turbidity_range();
    limit("turbidity", &mut valid.turbidity, range, fallback.turbidity);
    limit(
        "ground albedo",
        &mut valid.ground_albedo,
        (0.0, 1.0),
        fallback.ground_albedo,
    );
    limit(
        "sun elevation",
        &mut valid.sun_elevation_deg,
        (-90.0, 90.0),
        fallback.sun_elevation_deg,
    );
    limit(
        "sun azimuth",
        &mut valid.sun_azimuth_deg,
        (-1e6, 1e6),
        fallback.sun_azimuth_deg,
    );
    if let Some(lux) = &mut valid.horizontal_illuminance {
        limit("horizontal illuminance", lux, (0.0, 1e6), 0.0);
    }
    limit(
        "refraction",
        &mut valid.refraction_deg,
        (0.0, 1.0),
        fallback.refraction_deg,
    );
    if valid.model == SkyModel::Atmosphere {
        let (air, moved) = valid.air.clamped();
        valid.air = air;
        warnings.extend(moved);
        return valid;
    }
    if valid.sun_elevation_deg < 0.0 && valid.horizontal_illuminance.is_none() {
        let elevation = valid.sun_elevation_deg;
        warnings.push(format!(
            "the sun is below the horizon ({elevation:.2} degrees): the sky model ends there and is faded to the night's"
        ));
    }
    valid
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODELS: [SkyModel; 4] = [
        SkyModel::Preetham,
        SkyModel::Hosek,
        SkyModel::Overcast,
        SkyModel::CieClear,
    ];

    fn conditions(model: SkyModel, elevation: f64) -> Conditions {
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
        for model in MODELS {
            for turbidity in turbidities {
                for half_degrees in (-180..=180).filter(|e: &i32| e.abs() < 20 || e % 10 == 0) {
                    let elevation = f64::from(half_degrees) / 2.0;
                    let mut given = conditions(model, elevation);
                    given.turbidity = turbidity;
                    given.horizontal_illuminance = (half_degrees % 4 == 0).then_some(1e4);
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
            for model in MODELS {
                let given = Conditions {
                    model,
                    turbidity: bad,
                    ground_albedo: bad,
                    sun_azimuth_deg: bad,
                    sun_elevation_deg: bad,
                    refraction_deg: bad,
                    air: Air {
                        aod: bad,
                        ..Air::default()
                    },
                    horizontal_illuminance: Some(bad),
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
            assert_eq!((day.guard.scale, day.guard.night), (1.0, DVec3::ZERO));
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
        let ratio =
            colour::luminance(half.sun_illuminance) / colour::luminance(sunlight.illuminance());
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
}
