//! The physics of daylight in `f64` on the CPU: the reference against which the shaders are tested.
//!
//! # Overview, in the order of the light
//!
//! 1. [`sun_position`]: the direction of the sun from a place and a moment, by SPA or by the lecture's formulas.
//!    [`place`] and [`moment`] parse both; [`cities`] has places by name; [`sun_path`] has the lines of a sun-path diagram,
//!    [`day_times`] the twilights of a day, [`moon`] the position and the light of the moon,
//!    [`stars`] those of the stars.
//! 2. [`sunlight`]: the sun's spectrum times five transmittances of the air gives the luminance of its disc in cd/m² and its
//!    illuminance in lux. [`spectrum`] integrates, [`colour`] turns XYZ into linear BT.709 RGB.
//! 3. [`preetham`], [`hosek`] and [`grey_sky`]: the sky's radiance in a direction. [`cie`] has the standard skies, [`perez`] the
//!    sky of measured irradiances, both of them grey skies; [`clouds`] covers a clear one.
//!    [`atmosphere`] solves the scattering of light in the air, from noon to night.
//! 4. [`sky`]: sun, sky and the ground below the horizon as one [`Daylight`]; finite and not negative for any input.
//!    [`conditions`] has the inputs and their ranges.
//! 5. [`cube`]: cube maps in Vulkan's convention. [`irradiance`]: E(n) of a radiance, by four methods, with the points of
//!    [`sampling`] in the bases of [`tangent_frame`]; [`quadrature`] is their reference, [`convergence`] compares them, and
//!    [`sample_count`] has the samples of the device's map. [`ggx`] filters a sky for reflections of rough metals, with lookups
//!    in a [`cube_pyramid`].
//! 6. [`sky_sampler`]: directional lights drawn from the sky by luminance, one shadow map each.
//! 7. [`glass`]: the transmittance of window panes.
//! 8. [`exposure`] and [`tone_curve`]: from cd/m² to a picture; [`false_colour`]: to a picture with readable values;
//!    [`hdr`]: to the signals of HDR screens.
//!
//! # Conventions
//!
//! World: right-handed, +Y up, +X east, -Z north. Angles are in degrees if a name ends in `_deg`, else in radians; azimuth is
//! clockwise from north. Colours are linear RGB (BT.709, D65) as [`glam::DVec3`]: radiance in cd/m², irradiance in lux.
//! Directions are unit vectors *toward* what they name.

// A test may panic.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod atmosphere;
mod celestial;
pub mod cie;
pub mod cities;
pub mod clouds;
pub mod colour;
pub mod conditions;
pub mod convergence;
pub mod cube;
pub mod cube_pyramid;
mod data;
pub mod day_times;

pub mod exposure;
pub mod false_colour;
pub mod ggx;

pub mod glass;
pub mod grey_sky;
pub mod hdr;
pub mod hosek;
pub mod irradiance;
pub mod lit_hours;
pub mod metrics;
pub mod microfacet;
pub mod moment;
pub mod moon;
pub mod patches;
pub mod perez;
pub mod place;
pub mod preetham;
pub mod quadrature;
pub mod sample_count;
pub mod sampling;
pub mod sky;
pub mod sky_sampler;
pub mod spectrum;
pub mod stars;
pub mod steps;
pub mod sun_hours;
pub mod sun_path;
pub mod sun_position;
pub mod sunlight;
pub mod tangent_frame;
pub mod tone_curve;
pub mod weather;

pub use irradiance::IrradianceMethod;
pub use sky::{Conditions, Daylight, SkyModel};
pub use sun_position::{SunPosition, SunPositionMethod};
pub use tone_curve::ToneCurve;
