//! Table D: the whole view of an observer under one sun, from which cube, background and irradiance are made.
//!
//! Entries lie along the azimuth from the sun, in its square root; rows along the elevation above the horizon of the ground and then below it, in the square
//! root of the angle from it. Nothing is interpolated across the horizon.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::columns::horizon_cosine;
use super::{Atmosphere, colour};
use crate::daylight::colour::rgb_from_xyz;

/// Entries along half a turn of azimuth.
pub const WIDTH: usize = 64;
/// Rows above the horizon, and as many below.
pub const HALF_HEIGHT: usize = 48;

/// Radiance in all directions under one sun.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyView {
    /// Twice [`HALF_HEIGHT`] rows of [`WIDTH`] radiances: linear BT.709 RGB, cd/m², not clipped.
    pub entries: Vec<DVec3>,
    /// Elevation of the horizon of the ground, radians; 0 at sea level, else negative.
    pub horizon: f64,
    /// Horizontal unit vector (x, z) toward the sun's azimuth.
    pub toward_sun: DVec2,
}

impl SkyView {
    /// The view under the (true) sun in the unit direction `sun`.
    pub fn new(atmosphere: &Atmosphere, sun: DVec3) -> Self {
        let horizon = horizon_cosine(atmosphere.observer()).asin();
        let across = (1.0 - sun.y * sun.y).max(0.0).sqrt();
        let row = |j: usize| {
            let (elevation, below) = elevation_of_row(j, horizon);
            let (mu, horizontal) = elevation.sin_cos();
            let cos_gammas = (0..WIDTH).map(|i| {
                let x = i as f64 / (WIDTH - 1) as f64;
                let cos_gamma = mu * sun.y + horizontal * across * (PI * x * x).cos();
                cos_gamma.clamp(-1.0, 1.0)
            });
            atmosphere.transfers(sun.y, mu, cos_gammas, below)
        };
        let transfers = (0..2 * HALF_HEIGHT).flat_map(row);
        Self {
            entries: transfers
                .map(|transfer| rgb_from_xyz(colour::xyz(transfer)))
                .collect(),
            horizon,
            toward_sun: toward(sun),
        }
    }

    /// Radiance in the unit direction `dir`, linear BT.709 RGB, cd/m², not clipped.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        let [x, y] = self.coordinates(dir);
        let (i, j) = (
            (x as usize).min(WIDTH - 2),
            (y as usize).min(2 * HALF_HEIGHT - 2),
        );
        let at = |i: usize, j: usize| self.entries[j * WIDTH + i];
        let row = |j| at(i, j).lerp(at(i + 1, j), x - i as f64);
        row(j).lerp(row(j + 1), y - j as f64)
    }

    /// Whether the ground is in this direction.
    pub fn is_ground(&self, dir: DVec3) -> bool {
        dir.y.atan2(dir.x.hypot(dir.z)) < self.horizon
    }

    /// Entry and row, fractional, of a direction; the row is never between the two halves.
    fn coordinates(&self, dir: DVec3) -> [f64; 2] {
        let horizontal = DVec2::new(dir.x, dir.z);
        let azimuth = self.toward_sun.perp_dot(horizontal).abs();
        let azimuth = azimuth.atan2(self.toward_sun.dot(horizontal));
        let x = (azimuth / PI).clamp(0.0, 1.0).sqrt() * (WIDTH - 1) as f64;
        let above = dir.y.atan2(horizontal.length()) - self.horizon;
        let last = (HALF_HEIGHT - 1) as f64;
        let row = |share: f64| share.clamp(0.0, 1.0).sqrt() * last;
        let y = if above >= 0.0 {
            row(above / (0.5 * PI - self.horizon))
        } else {
            HALF_HEIGHT as f64 + row(-above / (0.5 * PI + self.horizon))
        };
        [x, y]
    }
}

/// Elevation of row `j`, radians, and whether it is of the half below the horizon.
fn elevation_of_row(j: usize, horizon: f64) -> (f64, bool) {
    let below = j >= HALF_HEIGHT;
    let y = (j % HALF_HEIGHT) as f64 / (HALF_HEIGHT - 1) as f64;
    let reach = if below { -0.5 * PI } else { 0.5 * PI } - horizon;
    (horizon + reach * y * y, below)
}

/// Horizontal unit vector (x, z) of a direction; south for the zenith.
pub fn toward(sun: DVec3) -> DVec2 {
    DVec2::new(sun.x, sun.z).try_normalize().unwrap_or(DVec2::Y)
}
