//! The sky of an [`Atmosphere`] under the sun, and under the moon.

use std::fmt;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::Atmosphere;
use super::sky_view::SkyView;
use crate::daylight::colour;

/// The moon's light in the air is left out while the moon's illuminance outside the air is below this share of the illuminance by the
/// sunlit sky. What the air scatters down is less than a third of it, so that less than 1e-5 of the sky is missing.
pub const FAINT: f64 = 3e-5;

/// Elevation below which the moon's twilight is left out, degrees: that of a full moon is then 1e-7 lux, of 8e-4 lux of the night, and less
/// than 0.4 % of the night in every direction.
pub const MOON_TWILIGHT_DEG: f64 = -10.0;

/// A light outside the air, and what the air that it lights looks like, which is found when it is first asked for.
#[derive(Clone)]
pub struct AirLight {
    /// Unit vector toward the true light.
    pub direction: DVec3,
    /// Illuminance outside the air over the sun's; the spectrum is the sun's.
    pub share: f64,
    irradiance_up: Arc<OnceLock<DVec3>>,
    view: Arc<OnceLock<SkyView>>,
}

impl AirLight {
    fn new(direction: DVec3, share: f64) -> Self {
        Self {
            direction,
            share,
            irradiance_up: Arc::default(),
            view: Arc::default(),
        }
    }

    /// Illuminance by the lit air of a horizontal plane that faces up, linear BT.709 RGB, lux, not clipped. Found when it is first asked for: a
    /// picture from the eye's own altitude needs the light, but not this.
    pub fn irradiance_up(&self, atmosphere: &Atmosphere) -> DVec3 {
        let find = || atmosphere.diffuse_illuminance(self.direction.y) * self.share;
        *self.irradiance_up.get_or_init(find)
    }

    /// The view of the air under the sun in this direction; this light's is [`Self::share`] of it.
    pub fn view(&self, atmosphere: &Atmosphere) -> &SkyView {
        self.view
            .get_or_init(|| SkyView::new(atmosphere, self.direction))
    }
}

impl PartialEq for AirLight {
    fn eq(&self, other: &Self) -> bool {
        (self.direction, self.share) == (other.direction, other.share)
    }
}

/// The sky of an atmosphere under the sun, and under the moon where that counts.
#[derive(Clone)]
pub struct ScatteredSky {
    /// The atmosphere.
    pub atmosphere: Atmosphere,
    /// The sun; its share is 1.
    pub sun: AirLight,
    /// The moon, if its light in the air is not far below that of the sun and of the night.
    pub moon: Option<AirLight>,
}

impl ScatteredSky {
    /// The sky under the true sun in the unit direction `sun`.
    pub fn new(atmosphere: Atmosphere, sun: DVec3) -> Self {
        Self {
            sun: AirLight::new(sun, 1.0),
            moon: None,
            atmosphere,
        }
    }

    /// This sky with the light of a moon in the unit direction `direction` (true, not refracted) and of `lux` outside the air, unless it
    /// is too [`FAINT`] or too far below the horizon ([`MOON_TWILIGHT_DEG`]).
    #[must_use]
    pub fn with_moon(mut self, direction: DVec3, lux: f64) -> Self {
        let is_bright = lux > FAINT * colour::luminance(self.sun.irradiance_up(&self.atmosphere));
        let counts = is_bright && direction.y > MOON_TWILIGHT_DEG.to_radians().sin();
        self.moon = counts.then(|| {
            let share = lux / Atmosphere::sun_outside_lux();
            AirLight::new(direction, share)
        });
        self
    }

    /// The light of which the air scatters more: the sun or the moon.
    pub fn brighter(&self) -> &AirLight {
        let lux = |light: &AirLight| colour::luminance(light.irradiance_up(&self.atmosphere));
        let moon = self.moon.as_ref();
        moon.filter(|moon| lux(moon) > lux(&self.sun))
            .unwrap_or(&self.sun)
    }

    /// The sky of the same air under the same lights from another altitude, metres.
    #[must_use]
    pub fn from_altitude(&self, altitude_m: f64) -> Self {
        let mut atmosphere = self.atmosphere.clone();
        atmosphere.air.altitude_m = altitude_m;
        let seen = |light: &AirLight| AirLight::new(light.direction, light.share);
        Self {
            sun: seen(&self.sun),
            moon: self.moon.as_ref().map(seen),
            atmosphere,
        }
    }

    /// The lights, the sun first.
    fn lights(&self) -> impl Iterator<Item = &AirLight> {
        std::iter::once(&self.sun).chain(&self.moon)
    }

    /// Radiance in a unit direction, above the horizon or below, linear BT.709 RGB, cd/m², not clipped.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        let of = |light: &AirLight| light.view(&self.atmosphere).radiance(dir) * light.share;
        self.lights().map(of).sum()
    }

    /// Whether the ground is in this direction.
    pub fn is_ground(&self, dir: DVec3) -> bool {
        self.sun.view(&self.atmosphere).is_ground(dir)
    }

    /// Illuminance of a horizontal plane that faces up, linear BT.709 RGB, lux, not clipped.
    pub fn irradiance_up(&self) -> DVec3 {
        self.lights()
            .map(|light| light.irradiance_up(&self.atmosphere))
            .sum()
    }

    /// Radiance of the ground at sea level, direct light included, linear BT.709 RGB, cd/m², not clipped.
    pub fn ground_rgb(&self) -> DVec3 {
        let of = |light: &AirLight| self.atmosphere.ground_rgb(light.direction.y) * light.share;
        self.lights().map(of).sum()
    }
}

/// Of the same air under the same lights.
impl PartialEq for ScatteredSky {
    fn eq(&self, other: &Self) -> bool {
        self.atmosphere.air == other.atmosphere.air
            && self.sun == other.sun
            && self.moon == other.moon
    }
}

impl fmt::Debug for ScatteredSky {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ScatteredSky")
            .field("air", &self.atmosphere.air)
            .field("sun", &self.sun.direction)
            .field(
                "moon",
                &self.moon.as_ref().map(|moon| (moon.direction, moon.share)),
            )
            .finish_non_exhaustive()
    }
}
