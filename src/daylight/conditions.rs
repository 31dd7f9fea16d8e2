//! What decides a daylight: the model of the sky and its inputs, and their ranges.

use super::atmosphere::air::Air;
use super::cie::{self, SkyCover, StandardSky, standard_sky};
use super::moon::Moon;
use super::perez::{DEW_POINTS, MOST_IRRADIANCE_W, Measured};
use super::stars::StarrySky;
use super::{hosek, preetham};

/// Model of the sky.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SkyModel {
    /// Clear sky with all orders of scattering on the sphere, from noon to night: [`super::atmosphere`].
    #[default]
    Atmosphere,
    /// Clear sky of Preetham, Shirley & Smits 1999 (the lecture's).
    Preetham,
    /// Clear sky of Hošek & Wilkie 2012.
    Hosek,
    /// CIE standard overcast sky; no sun. The same as [`SkyModel::Cie16`].
    Overcast,
    /// CIE standard clear sky, white. The same as [`SkyModel::Cie12`].
    CieClear,
    /// Sky of measured irradiances, Perez et al. 1993, white.
    Perez,
    /// Overcast, steep gradation toward the zenith, the same in all azimuths.
    Cie1,
    /// Overcast, steep gradation, slightly brighter toward the sun.
    Cie2,
    /// Overcast, moderate gradation, the same in all azimuths.
    Cie3,
    /// Overcast, moderate gradation, slightly brighter toward the sun.
    Cie4,
    /// Uniform luminance.
    Cie5,
    /// Partly cloudy, no gradation toward the zenith, slightly brighter toward the sun.
    Cie6,
    /// Partly cloudy, no gradation, brighter around the sun.
    Cie7,
    /// Partly cloudy, no gradation, distinct corona of the sun.
    Cie8,
    /// Partly cloudy, the sun obscured.
    Cie9,
    /// Partly cloudy, brighter around the sun.
    Cie10,
    /// White-blue, distinct corona of the sun.
    Cie11,
    /// Clear, little turbidity.
    Cie12,
    /// Clear, polluted air.
    Cie13,
    /// Cloudless and turbid, broad corona of the sun.
    Cie14,
    /// White-blue and turbid, broad corona of the sun.
    Cie15,
    /// Traditional overcast.
    Cie16,
}

impl SkyModel {
    /// Turbidities for which the model (or the sun's spectrum, if the model has no turbidity) is valid.
    pub fn turbidity_range(self) -> (f64, f64) {
        match self {
            Self::Preetham => preetham::TURBIDITY_RANGE,
            _ => hosek::TURBIDITY_RANGE,
        }
    }

    /// The standard sky of the CIE, if the model is one.
    pub fn standard(self) -> Option<StandardSky> {
        let number = match self {
            Self::Preetham | Self::Hosek | Self::Perez | Self::Atmosphere => return None,
            Self::Cie1 => 1,
            Self::Cie2 => 2,
            Self::Cie3 => 3,
            Self::Cie4 => 4,
            Self::Cie5 => 5,
            Self::Cie6 => 6,
            Self::Cie7 => 7,
            Self::Cie8 => 8,
            Self::Cie9 => 9,
            Self::Cie10 => 10,
            Self::Cie11 => 11,
            Self::CieClear | Self::Cie12 => cie::CLEAR,
            Self::Cie13 => 13,
            Self::Cie14 => 14,
            Self::Cie15 => 15,
            Self::Overcast | Self::Cie16 => cie::OVERCAST,
        };
        Some(standard_sky(number))
    }

    /// Whether the sky has no clouds of its own, so that [`Conditions::cloud_cover`] may add some.
    pub fn is_clear(self) -> bool {
        self != Self::Perez
            && self
                .standard()
                .is_none_or(|sky| sky.cover == SkyCover::Clear)
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
    /// How far the air lifts the sun, degrees: apparent minus true elevation. [`SkyModel::Atmosphere`] lights the air by the true
    /// sun; the others know the apparent one alone.
    pub refraction_deg: f64,
    /// The air of [`SkyModel::Atmosphere`], with [`Self::ground_albedo`] instead of its own.
    pub air: Air,
    /// Horizontal diffuse illuminance to which the sky is scaled, lux. `None` uses the model's own (for the CIE skies
    /// [`cie::daylight_availability`]). A measured value is used unchanged, without twilight fade.
    pub horizontal_illuminance: Option<f64>,
    /// Share of the sky that clouds cover, 0..=1, see [`super::clouds`]. Only a model that [is clear](SkyModel::is_clear) has use
    /// for it.
    pub cloud_cover: f64,
    /// The moon. It shines through skies without clouds of their own, where it is dimmed by [`Self::cloud_cover`] as the sun is.
    pub moon: Option<Moon>,
    /// The stars, which [`SkyModel::Atmosphere`] alone shows.
    pub stars: Option<StarrySky>,
    /// The irradiances of [`SkyModel::Perez`], which alone has use for them. They are used without twilight fade.
    pub measured: Measured,
}

impl Default for Conditions {
    /// The atmosphere of clear air; for other models turbidity 3; albedo 0.2, sun in the south at 45°.
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
            cloud_cover: 0.0,
            moon: None,
            stars: None,
            measured: Measured::default(),
        }
    }
}

impl Conditions {
    /// The air over the ground.
    pub(super) fn air_over_ground(&self) -> Air {
        Air {
            ground_albedo: self.ground_albedo,
            ..self.air
        }
    }

    /// These conditions with every value within its range; `warnings` takes a sentence for each one that was not.
    pub(super) fn validated(&self, warnings: &mut Vec<String>) -> Self {
        let (mut valid, fallback) = (*self, Self::default());
        let turbidities = self.model.turbidity_range();
        let watts = (0.0, MOST_IRRADIANCE_W);
        let measured = &mut valid.measured;
        let mut no_dew_point = 0.0;
        let dew_point = measured.dew_point_c.as_mut().unwrap_or(&mut no_dew_point);
        let mut no_lux = 0.0;
        let lux = valid.horizontal_illuminance.as_mut().unwrap_or(&mut no_lux);
        for (name, value, range, fallback) in [
            (
                "turbidity",
                &mut valid.turbidity,
                turbidities,
                fallback.turbidity,
            ),
            (
                "ground albedo",
                &mut valid.ground_albedo,
                (0.0, 1.0),
                fallback.ground_albedo,
            ),
            (
                "sun elevation",
                &mut valid.sun_elevation_deg,
                (-90.0, 90.0),
                fallback.sun_elevation_deg,
            ),
            (
                "sun azimuth",
                &mut valid.sun_azimuth_deg,
                (-1e6, 1e6),
                fallback.sun_azimuth_deg,
            ),
            ("refraction", &mut valid.refraction_deg, (0.0, 1.0), 0.0),
            ("horizontal illuminance", lux, (0.0, 1e6), 0.0),
            ("cloud cover", &mut valid.cloud_cover, (0.0, 1.0), 0.0),
            (
                "direct normal irradiance",
                &mut measured.direct_normal_w,
                watts,
                0.0,
            ),
            (
                "diffuse horizontal irradiance",
                &mut measured.diffuse_horizontal_w,
                watts,
                0.0,
            ),
            ("dew point", dew_point, DEW_POINTS, 0.0),
        ] {
            warnings.extend(limit(name, value, range, fallback));
        }
        let (air, moved) = valid.air.clamped();
        valid.air = air;
        warnings.extend(moved);
        warnings.extend(valid.remarks());
        valid
    }

    /// Sentences about values that are in range but not used as one may think.
    fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.cloud_cover > 0.0 && !self.model.is_clear() {
            remarks.push("the cloud cover is not used: this sky has clouds of its own".to_owned());
        }
        let elevation = self.sun_elevation_deg;
        let is_measured = self.horizontal_illuminance.is_some() || self.model == SkyModel::Perez;
        if elevation < 0.0 && !is_measured && self.model != SkyModel::Atmosphere {
            remarks.push(format!(
                "the sun is below the horizon ({elevation:.2} degrees): the sky model ends there and is faded to the night's"
            ));
        }
        remarks
    }
}

/// Moves `value` into its range, NaN to `fallback`, and says so.
fn limit(name: &str, value: &mut f64, (low, high): (f64, f64), fallback: f64) -> Option<String> {
    let asked = *value;
    *value = if asked.is_nan() {
        fallback
    } else {
        asked.clamp(low, high)
    };
    (*value != asked).then(|| format!("{name} {asked} is outside {low}..={high}: {value} is used"))
}
