//! A daylight: sun, moon, sky and ground at one moment; finite and not negative for any input.
//!
//! The models are valid for a sun above the horizon and a range of turbidities. [`Daylight::new`] keeps them within that range
//! with the numbers of [`Guard`], which a shader applies in the same way:
//!
//! sky = clip(model(direction, guard.sun_direction)) · guard.scale + guard.clouds · (1 + 2 sin el)/3 + guard.night, where clip is
//! [`colour::clip_negative`].

use std::f64::consts::PI;

use glam::DVec3;

use super::atmosphere::aerial::AirBefore;
use super::atmosphere::scattered_sky::ScatteredSky;
use super::atmosphere::{Aerial, Atmosphere, sun_share};
use super::cie::{self, SkyCover, StandardSky, daylight_availability};
use super::clouds::clouded;
use super::colour;
pub use super::conditions::{Conditions, SkyModel};
use super::grey_sky::GreySky;
use super::hosek::Hosek;
use super::moon::Moonlight;
use super::perez::AllWeather;
use super::preetham::Preetham;
use super::quadrature::irradiance_by_rings;
use super::stars::{MOST_SKY_LUX, PointLight, StarrySky};
use super::sun_position::direction;
use super::sunlight::{SUN_SOLID_ANGLE, Sunlight, air_mass, visible_fraction};

/// Luminance of the night sky without moon and light pollution, cd/m²: 252 µcd/m² of airglow and stars
/// (Cinzano, Falchi & Elvidge 2001).
pub const NIGHT_LUMINANCE: f64 = 2.52e-4;

/// Horizontal illuminances of a clear evening, lux, with the sun at -6°, -12° and -18°: the ends of civil, nautical and
/// astronomical twilight (American Meteorological Society, Glossary of Meteorology, "civil twilight": 3.5..2 lux at -6°,
/// "astronomical twilight": 0.008 lux at -12°, 6e-4 lux of scattered sunlight at -18°).
pub const TWILIGHT_LUX: [f64; 3] = [2.65, 0.008, 6e-4];

/// Luminance of the zenith of the CIE overcast sky over its horizontal illuminance, 1/sr: E = 7π/9 L_z.
const OVERCAST_ZENITH_PER_LUX: f64 = 9.0 / (7.0 * PI);

/// A sky model with evaluated coefficients.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// See [`Preetham`].
    Preetham(Preetham),
    /// See [`Hosek`].
    Hosek(Hosek),
    /// See [`GreySky`].
    Grey(GreySky),
    /// See [`ScatteredSky`].
    Atmosphere(ScatteredSky),
}

impl Sky {
    /// The model's radiance in a unit direction not below the horizon, linear BT.709 RGB, cd/m²; neither clipped nor faded.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        match self {
            Self::Preetham(sky) => sky.radiance(dir),
            Self::Hosek(sky) => sky.radiance(dir),
            Self::Grey(sky) => sky.radiance(dir),
            Self::Atmosphere(sky) => sky.radiance(dir),
        }
    }

    /// Illuminance of a horizontal plane by the clipped model, linear BT.709 RGB, lux.
    fn irradiance_up(&self) -> DVec3 {
        match self {
            Self::Grey(sky) => DVec3::splat(sky.horizontal_illuminance),
            Self::Atmosphere(sky) => colour::clip_negative(sky.irradiance_up()),
            Self::Preetham(sky) => irradiance_by_rings(|sine| clipped(sky.ring(sine))),
            Self::Hosek(sky) => irradiance_by_rings(|sine| clipped(sky.ring(sine))),
        }
    }
}

/// A radiance by direction, clipped.
fn clipped(radiance: impl Fn(DVec3) -> DVec3) -> impl Fn(DVec3) -> DVec3 {
    move |dir| colour::clip_negative(radiance(dir))
}

/// Extends a model beyond its valid range and by clouds: sky = clip(model) · `scale` + `clouds` · (1 + 2 sin el)/3 + `night`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guard {
    /// Unit vector toward the sun for evaluating the model: the sun's own, or on the horizon above a sun that has set.
    pub sun_direction: DVec3,
    /// Factor on the model's radiance: 1 by day, falling with [`twilight_illuminance`] in twilight. With a given horizontal
    /// illuminance, the ratio of that to the model's. Clouds take their share off it.
    pub scale: f64,
    /// Luminance at the zenith of the clouds, which have the luminances of the CIE overcast sky, cd/m².
    pub clouds: f64,
    /// Added radiance, linear BT.709 RGB, cd/m²: 0 by day, [`NIGHT_LUMINANCE`] (white) after twilight, (1 - `scale`) of it between;
    /// the whole of it always with [`SkyModel::Atmosphere`].
    pub night: DVec3,
}

/// A light from one direction: [`Daylight::direct_light`]. Both discs are taken as wide as the sun's for penumbrae.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectLight {
    /// Unit vector toward its centre, which may be below the horizon.
    pub direction: DVec3,
    /// Illuminance at normal incidence, linear BT.709 RGB, lux.
    pub illuminance: DVec3,
}

impl DirectLight {
    /// Illuminance of a horizontal plane that faces up, lux.
    fn horizontal_lux(&self) -> f64 {
        colour::luminance(self.illuminance) * self.direction.y.max(0.0)
    }
}

/// Sun, moon, sky and ground at one moment. Every number is finite and none is negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Daylight {
    /// Unit vector toward the sun's centre, which may be below the horizon.
    pub sun_direction: DVec3,
    /// Illuminance of the sun at normal incidence, linear BT.709 RGB, lux; 0 once its disc has set.
    pub sun_illuminance: DVec3,
    /// Luminance of the sun's disc, linear BT.709 RGB, cd/m²; 0 once it has set entirely.
    pub sun_luminance: DVec3,
    /// The moon, if it is above the horizon and no clouds hide it.
    pub moon: Option<Moonlight>,
    /// The stars, if the sky is an atmosphere and dark enough ([`MOST_SKY_LUX`]).
    pub stars: Option<StarrySky>,
    /// Model of the sky.
    pub sky: Sky,
    /// Parameters that extend the model beyond its valid range.
    pub guard: Guard,
    /// Illuminance of the sky on a horizontal plane that faces up, linear BT.709 RGB, lux.
    pub sky_irradiance_up: DVec3,
    /// Radiance of everything below the horizon, linear BT.709 RGB, cd/m²: albedo/π (E_sun sin el + E_sky), E_sun that of
    /// [`Daylight::direct_light`].
    pub ground_luminance: DVec3,
    /// Corrections of the conditions, one sentence each.
    pub warnings: Vec<String>,
}

impl Daylight {
    /// The daylight of `conditions`. Values out of range are replaced; `warnings` lists them.
    pub fn new(conditions: &Conditions) -> Self {
        let mut warnings = Vec::new();
        let valid = conditions.validated(&mut warnings);
        let elevation = valid.sun_elevation_deg;
        let above = direction(valid.sun_azimuth_deg, elevation.max(0.0));
        let (sky, sun_factor) = sky_and_sun_factor(&valid, above);
        let (sun_illuminance, sun_luminance) = sun(&valid, sun_factor);
        let own = sky.irradiance_up();
        let guard = guard_of(&valid, colour::luminance(own), above);
        let moon = moonlight(&valid);
        let sun_direction = direction(valid.sun_azimuth_deg, elevation);
        let direct_lux = direct(sun_direction, sun_illuminance, moon).horizontal_lux();
        let (guard, share) = under_clouds(&valid, guard, colour::luminance(own), direct_lux);
        let clouds = DVec3::splat(guard.clouds / OVERCAST_ZENITH_PER_LUX);
        let sky_irradiance_up = own * guard.scale + clouds + guard.night * PI;
        let is_dark = colour::luminance(sky_irradiance_up) < MOST_SKY_LUX;
        let shows_stars = is_dark && valid.model == SkyModel::Atmosphere;
        let mut daylight = Self {
            sun_direction,
            sun_illuminance: sun_illuminance * share,
            sun_luminance: sun_luminance * share,
            moon: moon
                .map(|moon| moon.scaled(share))
                .filter(|moon| moon.illuminance != DVec3::ZERO),
            stars: valid.stars.filter(|_| shows_stars).map(|stars| StarrySky {
                clear: stars.clear * share,
                ..stars
            }),
            sky,
            guard,
            sky_irradiance_up,
            ground_luminance: DVec3::ZERO,
            warnings,
        };
        daylight.ground_luminance = daylight.horizontal() * (valid.ground_albedo / PI);
        daylight
    }

    /// The directional light, the one that throws shadows: the sun, or the moon while the sun gives none.
    pub fn direct_light(&self) -> DirectLight {
        direct(self.sun_direction, self.sun_illuminance, self.moon)
    }

    /// Illuminance of open ground by the directional light and the sky, linear BT.709 RGB, lux.
    pub fn horizontal(&self) -> DVec3 {
        let direct = self.direct_light();
        self.sky_irradiance_up + direct.illuminance * direct.direction.y.max(0.0)
    }

    /// The stars in the sky; those behind the moon are left out.
    pub fn stars(&self) -> Vec<PointLight> {
        let (Some(stars), Sky::Atmosphere(sky)) = (&self.stars, &self.sky) else {
            return Vec::new();
        };
        let mut seen = stars.seen(&sky.atmosphere);
        if let Some(moon) = self.moon {
            seen.retain(|s| s.direction.dot(moon.direction) < moon.angular_radius.cos());
        }
        seen
    }

    /// Radiance in the unit direction `dir`, linear BT.709 RGB, cd/m²: sky without the discs of sun and moon and without stars, ground below the
    /// horizon.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        match &self.sky {
            Sky::Atmosphere(sky) if sky.is_ground(dir) => {
                let (scale, added) = self.ground_of(sky);
                colour::clip_negative(sky.radiance(dir)) * scale + added
            }
            Sky::Atmosphere(_) => guarded(&self.sky, &self.guard, dir),
            _ if dir.y < 0.0 => self.ground_luminance,
            _ => self.sky_radiance(dir),
        }
    }

    /// How the ground that an atmosphere shows becomes [`Self::ground_luminance`] at the observer: a factor, and what the night adds,
    /// linear BT.709 RGB, cd/m².
    pub fn ground_of(&self, sky: &ScatteredSky) -> (f64, DVec3) {
        let added = self.guard.night * sky.atmosphere.medium.ground_albedo;
        let own = colour::luminance(colour::clip_negative(sky.ground_rgb()));
        let here = colour::luminance(self.ground_luminance - added).max(0.0);
        (if own > 1e-9 { here / own } else { 1.0 }, added)
    }

    /// What clouds and night scatter into an endless ray, linear BT.709 RGB, cd/m²: their luminance at the horizon, which is that of such
    /// a ray (Koschmieder 1924).
    pub fn veil(&self) -> DVec3 {
        self.guard.night + self.guard.clouds / 3.0
    }

    /// The air before an eye as a picture shows it: [`AirBefore::between`] scaled as the sky is, with the light of clouds and night; not negative.
    pub fn aerial(&self, before: &AirBefore, dir: DVec3, distance_km: f64) -> Aerial {
        let own = before.between(dir, distance_km);
        let transmittance = own.transmittance.max(DVec3::ZERO);
        let veil = (1.0 - transmittance) * self.veil();
        Aerial {
            transmittance,
            inscatter: colour::clip_negative(own.inscatter) * self.guard.scale + veil,
        }
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

/// The directional light under a sun and a moon.
fn direct(sun: DVec3, sun_illuminance: DVec3, moon: Option<Moonlight>) -> DirectLight {
    match moon {
        Some(moon) if sun_illuminance == DVec3::ZERO => DirectLight {
            direction: moon.direction,
            illuminance: moon.illuminance,
        },
        _ => DirectLight {
            direction: sun,
            illuminance: sun_illuminance,
        },
    }
}

fn guarded(sky: &Sky, guard: &Guard, dir: DVec3) -> DVec3 {
    let clouds = guard.clouds * (1.0 + 2.0 * dir.y.max(0.0)) / 3.0;
    colour::clip_negative(sky.radiance(dir)) * guard.scale + guard.night + clouds
}

/// Illuminance (lux) and luminance (cd/m²) of the sun, in gamut, times `factor`; the illuminance fades while the disc sets.
fn sun(valid: &Conditions, factor: f64) -> (DVec3, DVec3) {
    let visible = visible_fraction(valid.sun_elevation_deg);
    if factor == 0.0 || visible == 0.0 {
        return (DVec3::ZERO, DVec3::ZERO);
    }
    if valid.model == SkyModel::Atmosphere {
        return sun_through_air(valid);
    }
    let sunlight = Sunlight::new(valid.turbidity, valid.sun_elevation_deg);
    let clip = colour::clip_negative;
    (
        clip(sunlight.illuminance()) * (visible * factor),
        clip(sunlight.luminance()) * factor,
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
    Atmosphere::of(&valid.air_over_ground())
}

/// The moon through a sky without clouds of its own.
fn moonlight(valid: &Conditions) -> Option<Moonlight> {
    let moon = valid.moon.filter(|_| valid.model.is_clear())?;
    let light = if valid.model == SkyModel::Atmosphere {
        let sine = moon.apparent_elevation_deg.to_radians().sin();
        let through = atmosphere_of(valid).transmittance_to_space(sine);
        moon.light_through(through)
    } else {
        moon.light(valid.turbidity)
    };
    (light.illuminance != DVec3::ZERO).then_some(light)
}

/// The sky, and the factor on the sun's own light that the model's illuminance by the sun asks for.
fn sky_and_sun_factor(valid: &Conditions, sun_direction: DVec3) -> (Sky, f64) {
    let (elevation, given) = (valid.sun_elevation_deg, valid.horizontal_illuminance);
    if let Some(standard) = valid.model.standard() {
        let lux = given.unwrap_or_else(|| daylight_availability(standard.cover, elevation));
        let sky = GreySky::new(standard.distribution, sun_direction, lux);
        return (Sky::Grey(sky), standard_sun_factor(&standard, valid));
    }
    match valid.model {
        SkyModel::Hosek => {
            let hosek = Hosek::new(valid.turbidity, valid.ground_albedo, sun_direction);
            (Sky::Hosek(hosek), 1.0)
        }
        SkyModel::Perez => {
            let weather = AllWeather::new(&valid.measured, elevation);
            let lux = given.unwrap_or(weather.diffuse_horizontal_lux);
            let sky = GreySky::new(weather.distribution, sun_direction, lux);
            (Sky::Grey(sky), sun_factor(valid, weather.direct_normal_lux))
        }
        SkyModel::Atmosphere => {
            let true_deg = elevation - valid.refraction_deg;
            let sun = direction(valid.sun_azimuth_deg, true_deg.max(-90.0));
            let sky = ScatteredSky::new(atmosphere_of(valid), sun);
            let sky = match valid.moon {
                Some(moon) => sky.with_moon(moon.true_direction(), moon.outside_lux()),
                None => sky,
            };
            (Sky::Atmosphere(sky), 1.0)
        }
        _ => {
            let preetham = Preetham::new(valid.turbidity, sun_direction);
            (Sky::Preetham(preetham), 1.0)
        }
    }
}

/// The factor on the sun's own light under a standard sky.
fn standard_sun_factor(standard: &StandardSky, valid: &Conditions) -> f64 {
    match standard.cover {
        _ if !standard.has_sun => 0.0,
        SkyCover::PartlyCloudy => sun_factor(
            valid,
            cie::partly_cloudy_sun(air_mass(valid.sun_elevation_deg)),
        ),
        SkyCover::Clear | SkyCover::Overcast => 1.0,
    }
}

/// The factor that makes the whole disc give `lux` at normal incidence.
fn sun_factor(valid: &Conditions, lux: f64) -> f64 {
    let own = Sunlight::new(valid.turbidity, valid.sun_elevation_deg)
        .luminance_xyz
        .y;
    lux / (own * SUN_SOLID_ANGLE)
}

/// `own_lux` is the horizontal illuminance of the clipped model.
fn guard_of(valid: &Conditions, own_lux: f64, sun_direction: DVec3) -> Guard {
    let by_day = |scale| Guard {
        sun_direction,
        scale,
        clouds: 0.0,
        night: DVec3::ZERO,
    };
    let elevation = valid.sun_elevation_deg;
    match valid.horizontal_illuminance {
        Some(lux) if own_lux > 0.0 => by_day(lux / own_lux),
        // It has a twilight of its own.
        None if valid.model == SkyModel::Atmosphere => Guard {
            night: DVec3::splat(NIGHT_LUMINANCE),
            ..by_day(1.0)
        },
        None if elevation < 0.0 && valid.model != SkyModel::Perez => {
            let scale = twilight_illuminance(elevation, own_lux) / own_lux;
            Guard {
                night: DVec3::splat(NIGHT_LUMINANCE * (1.0 - scale)),
                ..by_day(scale)
            }
        }
        _ => by_day(1.0),
    }
}

/// The guard with clouds before the sky, and the share of the directional light that they leave. `direct_lux` is the horizontal illuminance by that
/// light, the sun's or the moon's.
fn under_clouds(valid: &Conditions, guard: Guard, own_lux: f64, direct_lux: f64) -> (Guard, f64) {
    if valid.cloud_cover == 0.0 || !valid.model.is_clear() {
        return (guard, 1.0);
    }
    let sky_lux = own_lux * guard.scale;
    let light = clouded(valid.cloud_cover, sky_lux, direct_lux);
    let total = light.clear_sky * sky_lux + light.clouds_lux;
    // A given illuminance is that of the whole sky, clouds included.
    let level = match valid.horizontal_illuminance {
        Some(lux) if total > 0.0 => lux / total,
        _ => 1.0,
    };
    let guard = Guard {
        scale: guard.scale * light.clear_sky * level,
        clouds: light.clouds_lux * level * OVERCAST_ZENITH_PER_LUX,
        ..guard
    };
    (guard, light.sun)
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

#[cfg(test)]
#[path = "sky_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "moonlit_sky_tests.rs"]
mod moonlit_tests;
