//! Resolves options into a sun position and a daylight. `sky` and `bake` need nothing else.

use crate::daylight::atmosphere::air::{Air, aod_of_turbidity, aod_of_visibility};
use crate::daylight::sky::{Conditions, Daylight};
use crate::daylight::sun_position::{SunPosition, lecture};
use crate::error::Result;
use crate::options::{OptionValues, Options, SunInput, Switch};
use crate::scene::{Loaded, Scene};

/// A sun position and a daylight, without a scene.
pub struct Light {
    /// The options; those that concern images have no effect here.
    pub settings: Options,
    /// Position of the sun.
    pub sun: SunPosition,
    /// Inputs of the daylight.
    pub conditions: Conditions,
    /// The daylight.
    pub daylight: Daylight,
}

impl Light {
    /// Resolves the options.
    ///
    /// # Errors
    /// Invalid options, or a moment that the ephemeris does not cover.
    pub fn new(options: &OptionValues) -> Result<Self> {
        let nothing = Loaded {
            scene: Scene::default(),
            options: Vec::new(),
            cameras: Vec::new(),
            moments: Vec::new(),
            path: std::path::PathBuf::new(),
        };
        let settings = Options::resolve(options, &nothing)?;
        let sun = sun_position(&settings)?;
        let conditions = conditions(&settings, &sun);
        Ok(Self {
            daylight: Daylight::new(&conditions),
            settings,
            sun,
            conditions,
        })
    }
}

/// Position of the sun according to the options. Images use its apparent elevation.
pub fn sun_position(settings: &Options) -> Result<SunPosition> {
    let mut sun = match settings.sun {
        SunInput::Place {
            latitude,
            longitude,
            when,
        } => settings.sun_position.position(when, latitude, longitude)?,
        SunInput::Solar {
            day,
            hours,
            latitude,
        } => lecture(day, hours, latitude),
        // A sun direction given by the user is apparent: no refraction is added.
        SunInput::Direction {
            azimuth_deg,
            elevation_deg,
        } => SunPosition {
            azimuth_deg,
            elevation_deg,
            apparent_elevation_deg: elevation_deg,
        },
    };
    if settings.refraction == Switch::Off {
        sun.apparent_elevation_deg = sun.elevation_deg;
    }
    Ok(sun)
}

/// Inputs of the daylight for this position of the sun.
pub fn conditions(settings: &Options, sun: &SunPosition) -> Conditions {
    Conditions {
        model: settings.sky,
        turbidity: settings
            .turbidity
            .unwrap_or(Conditions::default().turbidity),
        ground_albedo: settings.ground_albedo,
        sun_azimuth_deg: sun.azimuth_deg,
        sun_elevation_deg: sun.apparent_elevation_deg,
        refraction_deg: sun.apparent_elevation_deg - sun.elevation_deg,
        air: air(settings),
        horizontal_illuminance: settings.sky_illuminance,
    }
}

/// The air of the options.
pub fn air(settings: &Options) -> Air {
    let aerosol = settings.aerosol.0;
    let of_visibility = |km| aod_of_visibility(km, aerosol.scale_height_km);
    let other = settings.visual_range.map(of_visibility);
    let other = other.or_else(|| settings.turbidity.map(aod_of_turbidity));
    Air {
        aod: settings.aod.or(other).unwrap_or(Air::default().aod),
        ozone_du: settings.ozone,
        altitude_m: settings.altitude,
        aerosol,
        ground_albedo: settings.ground_albedo,
    }
}
