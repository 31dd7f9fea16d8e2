//! Four wavelengths that stand for the spectrum, and the sun itself by 40.

use glam::{DVec3, DVec4};

use crate::daylight::data::atmosphere::{FIRST_NM, SUN_XYZ};

/// The four wavelengths, nm.
pub const WAVELENGTHS: DVec4 = DVec4::new(445.0, 515.0, 565.0, 635.0);

/// XYZ, lux, of a transfer of 1 at each of the [`WAVELENGTHS`]: least squares over the skies of 48 random airs solved at 40 wavelengths
/// (`fit_of_the_wavelengths` in `tests/daylight/wavelengths.rs` prints it).
pub const XYZ: [DVec3; 4] = [
    DVec3::new(22670.2, 3719.0, 115533.8),
    DVec3::new(-2905.8, 35968.8, 25647.2),
    DVec3::new(66847.4, 74755.4, -3865.1),
    DVec3::new(42325.5, 18605.4, 321.8),
];

/// XYZ of a transfer (radiance or irradiance over the sun's irradiance outside the air) at the [`WAVELENGTHS`].
pub fn xyz(transfer: DVec4) -> DVec3 {
    let parts = XYZ.iter().zip(transfer.to_array());
    parts.map(|(xyz, transfer)| *xyz * transfer).sum()
}

/// The 40 wavelengths of the sun, nm, by fours.
pub fn all_wavelengths() -> impl Iterator<Item = DVec4> {
    let nm = |i: usize| FIRST_NM + 10.0 * i as f64;
    (0..10).map(move |i| DVec4::from_array(std::array::from_fn(|lane| nm(4 * i + lane))))
}

/// XYZ of a transfer at [`all_wavelengths`].
pub fn xyz_of_all(transfer: impl Iterator<Item = DVec4>) -> DVec3 {
    let each = transfer.flat_map(|four| four.to_array());
    let parts = each.zip(SUN_XYZ);
    parts.map(|(t, xyz)| DVec3::from_array(xyz) * t).sum()
}
