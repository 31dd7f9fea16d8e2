//! Resolves options into a sun position and a daylight. `sky` and `bake` need nothing else.

use crate::daylight::atmosphere::air::{
    Air, aod_of_turbidity, aod_of_visibility, turbidity_of_aod,
};
use crate::daylight::moon::Moon;
use crate::daylight::perez::Measured;
use crate::daylight::sky::{Conditions, Daylight};
use crate::daylight::stars::StarrySky;
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

    /// Turbidity used by the model. A warning reports when it differs from the option.
    pub fn turbidity(&self) -> f64 {
        let (low, high) = self.conditions.model.turbidity_range();
        self.conditions.turbidity.clamp(low, high)
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

/// The moon of the place and the moment; `None` without them, without an ephemeris for them, or if it is switched off.
fn moon(settings: &Options) -> Option<Moon> {
    let (latitude, longitude, when) = settings.sun.place()?;
    let is_on = settings.moon == Switch::On;
    let mut moon = is_on.then(|| Moon::at(when, latitude, longitude).ok())??;
    if settings.refraction == Switch::Off {
        moon.apparent_elevation_deg = moon.elevation_deg;
    }
    Some(moon)
}

/// The stars of the place and the moment; `None` without them, or if they are switched off.
fn stars(settings: &Options) -> Option<StarrySky> {
    let (latitude, longitude, when) = settings.sun.place()?;
    let is_on = settings.stars == Switch::On;
    let stars = is_on.then(|| StarrySky::at(when, latitude, longitude).ok())??;
    Some(StarrySky {
        is_refracted: settings.refraction == Switch::On,
        ..stars
    })
}

/// Inputs of the daylight for this position of the sun.
pub fn conditions(settings: &Options, sun: &SunPosition) -> Conditions {
    Conditions {
        model: settings.sky,
        turbidity: turbidity(settings),
        ground_albedo: settings.ground_albedo,
        sun_azimuth_deg: sun.azimuth_deg,
        sun_elevation_deg: sun.apparent_elevation_deg,
        refraction_deg: sun.apparent_elevation_deg - sun.elevation_deg,
        air: air(settings),
        horizontal_illuminance: settings.sky_illuminance,
        cloud_cover: settings.cloud_cover,
        moon: moon(settings),
        stars: stars(settings),
        measured: Measured {
            direct_normal_w: settings.dni.unwrap_or_default(),
            diffuse_horizontal_w: settings.dhi.unwrap_or_default(),
            dew_point_c: settings.dew_point,
            day_of_year: settings.sun.day_of_year(),
        },
    }
}

/// The turbidity of the options: as given, or that of the given air.
pub fn turbidity(settings: &Options) -> f64 {
    let given = settings.turbidity;
    let is_air_given = settings.aod.is_some() || settings.visual_range.is_some();
    let of_air = || is_air_given.then(|| turbidity_of_aod(air(settings).aod));
    let default = Conditions::default().turbidity;
    given.or_else(of_air).unwrap_or(default)
}

/// The air of the options, over their ground.
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
