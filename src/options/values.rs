//! Types of option values, their parsers with error messages, and their text forms.

use std::fmt;
use std::ops::RangeInclusive;

use super::{Bounces, ByMaterial, Choice, SunDates, choice_enum};
use crate::daylight::atmosphere::air::{
    ALTITUDE_RANGE_M, AOD_RANGE, Aerosol, Air, OZONE_RANGE_DU, VISIBILITY_RANGE_KM,
};
use crate::daylight::false_colour::Range;
use crate::daylight::hdr::PQ_PEAK;
pub use crate::daylight::moment::When;
use crate::daylight::perez::{DEW_POINTS, MOST_IRRADIANCE_W};
pub use crate::daylight::place::Place;
use crate::frame::FrameSettings;
use crate::gpu::Route;

/// Width and height of a picture, pixels, 1..=32 768 each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Pixels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

/// Time input of the lecture: day and solar time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolarTime {
    /// Day of the year, 1..366.
    pub day: u32,
    /// Solar time, hours, 0..24; the sun culminates at 12.
    pub hours: f64,
}

/// A direction to the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Degrees clockwise from north, 0..360.
    pub azimuth_deg: f64,
    /// Degrees above the horizon, −90..90.
    pub elevation_deg: f64,
}

/// An aerosol as the option's text gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AerosolInput(pub Aerosol);

impl From<Aerosol> for AerosolInput {
    fn from(aerosol: Aerosol) -> Self {
        Self(aerosol)
    }
}

/// In the form that the parser of `--aerosol` reads.
impl fmt::Display for AerosolInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Aerosol {
            single_scattering_albedo,
            asymmetry,
            scale_height_km,
            angstrom,
        } = self.0;
        write!(
            f,
            "{single_scattering_albedo},{asymmetry},{scale_height_km},{angstrom}"
        )
    }
}

choice_enum! {
    /// Values of `--exposure`, the alternative to `--ev100`.
    #[derive(Default)]
    pub enum ExposureMode {
        #[default]
        Auto = "auto": "From the luminance of the picture",
    }
}

choice_enum! {
    /// A set of defaults.
    pub enum Preset {
        Lecture = "lecture": "The lecture's sun, sky, Monte Carlo integration and linear scale",
    }
}

choice_enum! {
    /// A switch whose default is not necessarily off.
    #[derive(Default)]
    pub enum Switch {
        #[default]
        On = "on": "On",
        Off = "off": "Off",
    }
}

choice_enum! {
    /// Whether the window has an HDR signal.
    #[derive(Default)]
    pub enum Hdr {
        #[default]
        Off = "off": "Tone-mapped, 0 to white, on every screen",
        Auto = "auto": "Where the window's surface offers HDR10 or scRGB",
        On = "on": "The same, and an error where it offers neither",
    }
}

choice_enum! {
    /// How full-screen passes are run.
    #[derive(Default)]
    pub enum RouteChoice {
        #[default]
        Auto = "auto": "The faster one: measured when a device is first used, and kept; fragments on software devices",
        Fragment = "fragment": "Fragments of a triangle, as in the lecture",
        Compute = "compute": "Compute shaders, many times faster on cards with few raster units",
    }
}

impl RouteChoice {
    /// The route that is asked for, if any.
    pub fn route(self) -> Option<Route> {
        match self {
            Self::Auto => None,
            Self::Fragment => Some(Route::Fragment),
            Self::Compute => Some(Route::Compute),
        }
    }
}

choice_enum! {
    /// How specular reflectance depends on the angle.
    #[derive(Default)]
    pub enum Fresnel {
        #[default]
        Off = "off": "No dependence on the angle: the lecture's ρ_s",
        Schlick = "schlick": "Schlick's approximation of Fresnel's equations",
    }
}

choice_enum! {
    /// Width of the sun's shadow edges in a single frame.
    #[derive(Default)]
    pub enum Penumbra {
        #[default]
        Map = "map": "One texel of the shadow map; averaged samples converge to the true penumbra",
        Sun = "sun": "The penumbra of the sun's disc",
    }
}

choice_enum! {
    /// Resolution of ambient occlusion.
    #[derive(Default)]
    pub enum AoResolution {
        #[default]
        Auto = "auto": "Half from 720 rows on, full below",
        Full = "full": "Occluders at full resolution, occlusion at half resolution",
        Half = "half": "Occluders at half resolution, occlusion at a quarter",
    }
}

impl AoResolution {
    /// Pixels per occluder along each axis, for a picture with `rows` rows.
    pub fn downscale(self, rows: u32) -> u32 {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Auto => 1 + u32::from(rows >= 720),
        }
    }
}

impl Default for Size {
    fn default() -> Self {
        let [width, height] = FrameSettings::default().size.to_array();
        Self { width, height }
    }
}

/// In the form that the parser of `--size` reads.
impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

/// In the form that the parser of `--sun` reads.
impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.azimuth_deg, self.elevation_deg)
    }
}

/// In the form that the parser of `--solar` reads.
impl fmt::Display for SolarTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.day, self.hours)
    }
}

/// Text form of an option value, the inverse of its parser; `None` if the option is not set.
pub(super) trait Written {
    fn written(&self) -> Option<String>;
}

impl<T: Choice> Written for T {
    fn written(&self) -> Option<String> {
        Some(self.option_name().to_owned())
    }
}

impl<T: Written> Written for Option<T> {
    fn written(&self) -> Option<String> {
        self.as_ref().and_then(Written::written)
    }
}

/// A flag has a text only if it is set.
impl Written for bool {
    fn written(&self) -> Option<String> {
        self.then(|| "true".to_owned())
    }
}

impl Written for Place {
    fn written(&self) -> Option<String> {
        Some(format!("{},{}", self.latitude, self.longitude))
    }
}

impl Written for When {
    fn written(&self) -> Option<String> {
        Some(match self {
            Self::Moment(moment) => moment.to_rfc3339(),
            Self::Local(local) => local.to_string(),
        })
    }
}

impl Written for [f64; 3] {
    fn written(&self) -> Option<String> {
        Some(self.map(|v| v.to_string()).join(","))
    }
}

impl Written for Range {
    fn written(&self) -> Option<String> {
        Some(format!("{},{}", self.min, self.max))
    }
}

/// In the form that the parser of `--bounces` reads.
impl fmt::Display for Bounces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::UpTo(count) => write!(f, "{count}"),
        }
    }
}

/// Types whose parser reads their [`fmt::Display`] form.
macro_rules! written_as_displayed {
    ($($type:ty)*) => {
        $(impl Written for $type {
            fn written(&self) -> Option<String> {
                Some(self.to_string())
            }
        })*
    };
}

written_as_displayed! { u32 f64 String Size Direction SolarTime Bounces AerosolInput ByMaterial SunDates }

/// A finite number.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text
        .trim()
        .parse()
        .map_err(|_| format!("\"{}\" is not a number", text.trim()))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("\"{}\" is not a finite number", text.trim()))
    }
}

fn within(name: &str, unit: &str, range: RangeInclusive<f64>, value: f64) -> Result<f64, String> {
    if range.contains(&value) {
        return Ok(value);
    }
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    };
    Err(format!(
        "{name} must be {} to {}{unit}",
        range.start(),
        range.end()
    ))
}

/// Defines a parser of a number within a range.
macro_rules! ranged {
    ($($function:ident: $name:literal, $unit:literal, $range:expr;)*) => {
        $(pub(crate) fn $function(text: &str) -> Result<f64, String> {
            within($name, $unit, $range, number(text)?)
        })*
    };
}

ranged! {
    turbidity: "turbidity", "", -100.0..=100.0;
    aod: "aerosol optical depth", "", AOD_RANGE;
    visual_range: "visibility", "km", VISIBILITY_RANGE_KM;
    ozone: "ozone", "Dobson units", OZONE_RANGE_DU;
    altitude: "altitude", "metres", ALTITUDE_RANGE_M;
    sky_illuminance: "illuminance of the sky", "lux", 0.0..=1e6;
    cloud_cover: "cloud cover", "", 0.0..=1.0;
    irradiance_w: "irradiance", "W/m²", 0.0..=MOST_IRRADIANCE_W;
    dew_point: "dew point", "°C", DEW_POINTS.0..=DEW_POINTS.1;
    ground_albedo: "ground albedo", "", 0.0..=1.0;
    fov: "field of view", "degrees", 1.0..=170.0;
    ev100: "exposure value", "", -20.0..=40.0;
    gamma: "gamma", "", 0.1..=10.0;
    hdr_peak: "peak of the screen", "cd/m²", 100.0..=PQ_PEAK;
    scale: "scale", "", 0.0..=1e6;
    exposure_factor: "exposure", "", 1e-9..=1e9;
    ratio: "ratio", "", 0.0..=1e9;
    threshold: "threshold", "lux", 1.0..=1e6;
    plane_height: "height above the floor", "m", 0.0..=100.0;
    spacing: "spacing", "m", 0.02..=100.0;
    plan_width: "width of a plan", "m", 0.0..=1e5;
    inset: "distance from walls", "m", 0.0..=100.0;
    offset: "distance from a façade", "m", 0.001..=10.0;
    elevation: "elevation", "degrees", 0.0..=90.0;
    noise: "noise", "", 1e-6..=1.0;
    irradiance_error: "error", "percent", 0.0..=100.0;
    ao_radius: "radius", "metres", 0.0..=1000.0;
    specular: "specular scale", "", 0.0..=100.0;
    emission_scale: "emission scale", "", 0.0..=1e9;
    crease: "crease angle", "degrees", 0.0..=180.0;
}

fn list<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let values: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    values.try_into().map_err(|_| format!("write {form}"))
}

/// `X,Y,Z`, metres.
pub(super) fn point(text: &str) -> Result<[f64; 3], String> {
    let point = list(text, "three numbers, for instance -17.5,3,13")?;
    for value in point {
        within("a coordinate", "metres", -1e9..=1e9, value)?;
    }
    Ok(point)
}

/// `SSA,ASYMMETRY,SCALE_HEIGHT_KM,ANGSTROM`.
pub(super) fn aerosol(text: &str) -> Result<AerosolInput, String> {
    let [albedo, asymmetry, height, angstrom] = list(
        text,
        "four numbers: single-scattering albedo, asymmetry, scale height in km, Ångström exponent, for instance 0.93,0.76,1.2,1.3",
    )?;
    let aerosol = Aerosol {
        single_scattering_albedo: albedo,
        asymmetry,
        scale_height_km: height,
        angstrom,
    };
    let air = Air {
        aerosol,
        ..Air::default()
    };
    air.valid().map(|_| AerosolInput(aerosol))
}

/// `MIN,MAX` of false colours.
pub(super) fn colour_range(text: &str) -> Result<Range, String> {
    let [min, max] = list(text, "MIN,MAX, for instance 100,10000")?;
    for value in [min, max] {
        within("a value of the range", "", 0.0..=1e12, value)?;
    }
    if max < 1e-9 || (min > 0.0 && min < 1e-9) {
        return Err("a value of the range must be 0 or at least 1e-9".to_owned());
    }
    if min >= max {
        return Err("the first value of the range must be less than the second".to_owned());
    }
    Ok(Range { min, max })
}

/// `3-21,12-21`, or `year`.
pub(super) fn sun_dates(text: &str) -> Result<SunDates, String> {
    text.parse()
}

/// Minutes, of which a day has a whole number.
pub(super) fn sun_step(text: &str) -> Result<u32, String> {
    let minutes = text.trim().parse().ok();
    let minutes = minutes.filter(|m| (1..=60).contains(m) && 1440 % m == 0);
    minutes.ok_or_else(|| {
        "write minutes of which a day has a whole number, for instance 1, 5, 10 or 30".to_owned()
    })
}

/// `AZIMUTH,ELEVATION`, degrees.
pub(crate) fn sun(text: &str) -> Result<Direction, String> {
    let [azimuth, elevation] = list(text, "AZIMUTH,ELEVATION in degrees, for instance 135,40")?;
    within("azimuth", "degrees", -360.0..=360.0, azimuth)?;
    within("elevation", "degrees", -90.0..=90.0, elevation)?;
    Ok(Direction {
        azimuth_deg: azimuth.rem_euclid(360.0),
        elevation_deg: elevation,
    })
}

/// `J,T`: day of the year and solar time in hours.
pub(super) fn solar(text: &str) -> Result<SolarTime, String> {
    let [day, hours] = list(
        text,
        "J,T: day of the year and solar time in hours, for instance 172,15",
    )?;
    if day.fract() != 0.0 || !(1.0..=366.0).contains(&day) {
        return Err("the day of the year must be a whole number from 1 to 366".to_owned());
    }
    within("solar time", "hours", 0.0..=24.0, hours)?;
    Ok(SolarTime {
        day: day as u32,
        hours,
    })
}

/// Most bounces that can be asked for by number: paths have as many segments.
const MOST_BOUNCES: u32 = 64;

/// Parses `all` or a number of bounces.
pub(super) fn bounces(text: &str) -> Result<Bounces, String> {
    if text == "all" {
        return Ok(Bounces::All);
    }
    match text.parse() {
        Ok(count) if count <= MOST_BOUNCES => Ok(Bounces::UpTo(count)),
        _ => Err(format!("use all, or a number from 0 to {MOST_BOUNCES}")),
    }
}

/// `1280x720`.
pub(super) fn size(text: &str) -> Result<Size, String> {
    let form = || "write WIDTHxHEIGHT in pixels, for instance 1280x720".to_owned();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(form)?;
    let edge = |text: &str| match text.trim().parse::<u32>() {
        Ok(edge @ 1..=32_768) => Ok(edge),
        Ok(_) => Err("width and height must be 1 to 32768 pixels".to_owned()),
        Err(_) => Err(form()),
    };
    let (width, height) = (edge(width)?, edge(height)?);
    Ok(Size { width, height })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_have_an_occluder_at_every_pixel() {
        let of = |rows| AoResolution::Auto.downscale(rows);
        assert_eq!([of(360), of(719), of(720), of(2160)], [1, 1, 2, 2]);
    }

    #[test]
    fn numbers_are_finite_and_in_range() {
        assert_eq!(
            size("1280x720"),
            Ok(Size {
                width: 1280,
                height: 720
            })
        );
        assert_eq!(point("-17.5, 3,13"), Ok([-17.5, 3.0, 13.0]));
        assert_eq!(
            sun("-90,10"),
            Ok(Direction {
                azimuth_deg: 270.0,
                elevation_deg: 10.0
            })
        );
        for text in [
            "0x0",
            "0x720",
            "32769x1",
            "12",
            "axb",
            "-1x5",
            "1x",
            "99999999999x1",
        ] {
            assert!(size(text).is_err(), "{text}");
        }
        for text in [
            "1,2",
            "1,2,3,4",
            "1,2,nan",
            "1,2,inf",
            "1,2,1e400",
            "",
            "a,b,c",
        ] {
            assert!(point(text).is_err(), "{text}");
        }
        assert_eq!(
            colour_range("10,2e3"),
            Ok(Range {
                min: 10.0,
                max: 2000.0
            })
        );
        for text in [
            "10", "0,0", "-1,10", "10,10", "20,10", "1,inf", "a,b", "1,2,3",
        ] {
            assert!(colour_range(text).is_err(), "{text}");
        }
        for text in ["0,12", "367,12", "1.5,12", "172,25", "172"] {
            assert!(solar(text).is_err(), "{text}");
        }
        for text in ["abc", "inf", "101", "-101"] {
            assert!(turbidity(text).is_err(), "{text}");
        }
    }
}
