//! From options to a sun and a daylight: what every face begins with. `sky` and `bake` need nothing else.

use crate::daylight::sky::{Conditions, Daylight};
use crate::daylight::sun_position::{SunPosition, lecture};
use crate::error::Result;
use crate::scene::{Loaded, Scene};
use crate::settings::{Options, Settings, SunInput, Switch};

/// The options that decide a daylight, and how its irradiance is integrated; the others decide a picture.
const INPUTS: [&str; 12] = [
    "place",
    "when",
    "solar",
    "sun",
    "sun-position",
    "refraction",
    "sky",
    "turbidity",
    "sky-illuminance",
    "ground-albedo",
    "irradiance",
    "irradiance-samples",
];

/// A daylight without a scene.
pub struct Light {
    /// Everything decided; what concerns pictures has no effect here.
    pub settings: Settings,
    /// Where the sun stands.
    pub sun: SunPosition,
    /// What the daylight was made of.
    pub conditions: Conditions,
    /// The daylight.
    pub daylight: Daylight,
}

impl Light {
    /// Decides everything.
    ///
    /// # Errors
    /// Options that make no sense, or a moment the ephemeris does not cover.
    pub fn new(options: Options) -> Result<Self> {
        let nothing = Loaded {
            scene: Scene::default(),
            options: Vec::new(),
            cameras: Vec::new(),
            moments: Vec::new(),
            path: std::path::PathBuf::new(),
        };
        let settings = Settings::resolve(options, &nothing)?;
        let sun = sun_position(&settings)?;
        let conditions = conditions(&settings, &sun);
        Ok(Self {
            daylight: Daylight::new(&conditions),
            settings,
            sun,
            conditions,
        })
    }

    /// What makes this daylight again, by option name.
    pub fn inputs(&self) -> impl Iterator<Item = (&'static str, String)> {
        let parameters = self.settings.parameters().into_iter();
        parameters.filter(|(name, _)| INPUTS.contains(name))
    }
}

/// Where the sun stands; its apparent elevation is what is shown.
pub fn sun_position(settings: &Settings) -> Result<SunPosition> {
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
        // What the user names is what is seen: no refraction on top.
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

/// What determines the daylight under this sun.
pub fn conditions(settings: &Settings, sun: &SunPosition) -> Conditions {
    Conditions {
        model: settings.sky,
        turbidity: settings.turbidity,
        ground_albedo: settings.ground_albedo,
        sun_azimuth_deg: sun.azimuth_deg,
        sun_elevation_deg: sun.apparent_elevation_deg,
        horizontal_illuminance: settings.sky_illuminance,
    }
}
