//! The physics of daylight in `f64` on the CPU: the reference against which the shaders are tested.
//!
//! # A tour, in the order of the light
//!
//! 1. [`sun_position`]: a place and a moment give the direction of the sun, by SPA or by the lecture's formulas.
//!    [`place`] and [`moment`] parse both; [`cities`] has places by name; [`sun_path`] the lines of a sun-path diagram.
//! 2. [`sunlight`]: the sun's spectrum through five transmittances of the air gives its disc in cd/m² and its
//!    illuminance in lux. [`spectrum`] integrates, [`colour`] turns XYZ into linear BT.709 RGB.
//! 3. [`preetham`], [`hosek`], [`cie`]: the sky's radiance in a direction.
//! 4. [`sky`]: all of it as one [`Daylight`] with the ground below the horizon; finite and not negative for any input.
//! 5. [`cube`]: cube maps in Vulkan's convention. [`irradiance`]: E(n) of a radiance, by four methods, with the points of
//!    [`sampling`] in the bases of [`tangent_frame`]; [`quadrature`] is their reference, [`convergence`] compares them, and
//!    [`sample_count`] has the samples of the device's map.
//! 6. [`sky_sampler`]: directional lights drawn from the sky by luminance, one shadow map each.
//! 7. [`exposure`] and [`tone_curve`]: from cd/m² to a picture; [`false_colour`]: to a picture of readable values.
//!
//! # Conventions
//!
//! World: right-handed, +Y up, +X east, -Z north. Angles in degrees where a name ends in `_deg`, else radians; azimuth clockwise
//! from north. Colours are linear RGB (BT.709, D65) as [`glam::DVec3`]: radiance in cd/m², irradiance in lux. Directions are
//! unit vectors *toward* what they name.

// A test may panic.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod cie;
pub mod cities;
pub mod colour;
pub mod convergence;
pub mod cube;
mod data;

pub mod exposure;
pub mod false_colour;

pub mod hosek;
pub mod irradiance;
pub mod moment;
pub mod place;
pub mod preetham;
pub mod quadrature;
pub mod sample_count;
pub mod sampling;
pub mod sky;
pub mod sky_sampler;
pub mod spectrum;
pub mod sun_path;
pub mod sun_position;
pub mod sunlight;
pub mod tangent_frame;
pub mod tone_curve;

pub use irradiance::IrradianceMethod;
pub use sky::{Conditions, Daylight, SkyModel};
pub use sun_position::{SunPosition, SunPositionMethod};
pub use tone_curve::ToneCurve;
