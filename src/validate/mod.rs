//! Proof on the device that is there: what it draws against the CPU, reference values and closed forms.
//!
//! Each check is the largest of many errors ([`check::Check`]). [`CHECKS`] has those of a device; [`sun`] needs none. The tests of the
//! device compare by the same functions, with more cases.

pub mod check;
pub mod device;
pub mod light;
pub mod model;
pub mod picture;
pub mod shadow;
pub mod sky;
pub mod sun;
pub mod surfaces;

use check::Check;
use device::Device;

use crate::gpu::Result;

/// Checks that are drawn together.
pub type Group = fn(&mut Device) -> Result<Vec<Check>>;

/// The checks of a device.
pub const CHECKS: [Group; 9] = [
    sky::formulas,
    sky::atmosphere,
    light::irradiance,
    light::furnace,
    shadow::square,
    surfaces::cells,
    surfaces::panes,
    picture::curves,
    picture::formats,
];
