//! Published tables, as Rust data.

pub mod atmosphere;
pub mod cie_1931_2deg;
pub mod cities;
pub mod perez_1993;
pub mod preetham_spectra;
