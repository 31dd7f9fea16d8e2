//! Columns of air, aerosol and ozone from a point to the top of the air: the table A, for any wavelength and amount.

use glam::DVec3;

use super::medium::{GROUND_RADIUS, OZONE_KINKS, THICKNESS, TOP_RADIUS, densities};
use crate::daylight::quadrature::gauss_legendre;

/// Entries of [`Columns`] along the distance to the top.
pub const WIDTH: usize = 256;
/// Entries of [`Columns`] along the distance to the horizon.
pub const HEIGHT: usize = 64;

/// Distance to the top of the air, km, from the radius `r` (km) along a ray whose cosine with the vertical is `mu`.
pub fn distance_to_top(r: f64, mu: f64) -> f64 {
    let (height, along) = ((TOP_RADIUS - r) * (TOP_RADIUS + r), r * mu);
    let root = (height + along * along).max(0.0).sqrt();
    // The form without cancellation.
    if along > 0.0 {
        height / (root + along)
    } else {
        root - along
    }
}

/// Distance to the ground, km, along a ray that meets it.
pub fn distance_to_ground(r: f64, mu: f64) -> f64 {
    let (height, along) = (((r - GROUND_RADIUS) * (r + GROUND_RADIUS)).max(0.0), r * mu);
    let root = (along * along - height).max(0.0).sqrt();
    if root - along > 0.0 {
        height / (root - along)
    } else {
        0.0
    }
}

/// Cosine with the vertical of the ray that touches the ground, seen from the radius `r` (km).
pub fn horizon_cosine(r: f64) -> f64 {
    -((r - GROUND_RADIUS).max(0.0) * (r + GROUND_RADIUS)).sqrt() / r
}

/// Columns along `length` km of a ray, km at the reference densities, by Gauss-Legendre with `nodes` (on 0..=1): in the square root of the distance
/// from the lowest point, on each side of it, in pieces that end where the profile of ozone has its kinks.
pub fn exact(r: f64, mu: f64, length: f64, scale_height: f64, nodes: &[(f64, f64)]) -> DVec3 {
    let lowest = (-r * mu).clamp(0.0, length);
    let side = |reach: f64| -> DVec3 {
        if reach == 0.0 {
            return DVec3::ZERO;
        }
        let edge = |altitude: f64| {
            let radius = GROUND_RADIUS + altitude;
            let root = ((radius - r) * (radius + r) + (r * mu).powi(2))
                .max(0.0)
                .sqrt();
            let t = -r * mu + root.copysign(reach);
            ((t - lowest) / reach).clamp(0.0, 1.0).sqrt()
        };
        let [a, b, c] = OZONE_KINKS.map(edge);
        let pieces = [(0.0, a), (a, b), (b, c), (c, 1.0)];
        let within = |&(start, end): &(f64, f64)| -> DVec3 {
            let at = |&(x, weight): &(f64, f64)| {
                let x = start + (end - start) * x;
                let altitude = altitude_along(r, mu, lowest + reach * x * x);
                densities(altitude, scale_height) * (2.0 * reach.abs() * x * weight)
            };
            nodes.iter().map(at).sum::<DVec3>() * (end - start)
        };
        let pieces = pieces.iter().filter(|(start, end)| end > start);
        pieces.map(within).sum()
    };
    side(-lowest) + side(length - lowest)
}

/// Columns to the top of the air by altitude and direction above the horizon; depends on the scale height of the aerosol alone.
///
/// Bruneton & Neyret 2008, in the form of 2017: rows are uniform in the distance to the horizon, entries in the distance to the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// [`HEIGHT`] rows of [`WIDTH`] entries: air, aerosol, ozone, km at the reference densities.
    pub entries: Vec<[f32; 3]>,
}

impl Columns {
    /// The table for an aerosol of `scale_height` km.
    pub fn new(scale_height: f64) -> Self {
        let nodes = gauss_legendre(14);
        let entry = |row: usize, i: usize| {
            let horizon = horizon_distance(TOP_RADIUS) * row as f64 / (HEIGHT - 1) as f64;
            let r = (horizon * horizon + GROUND_RADIUS * GROUND_RADIUS).sqrt();
            let [least, most] = [TOP_RADIUS - r, horizon + horizon_distance(TOP_RADIUS)];
            let d = least + (most - least) * i as f64 / (WIDTH - 1) as f64;
            if d < 1e-6 {
                return [0.0; 3];
            }
            let mu = ((TOP_RADIUS - r) * (TOP_RADIUS + r) - d * d) / (2.0 * r * d);
            let columns = exact(r, mu.clamp(-1.0, 1.0), d, scale_height, &nodes);
            columns.to_array().map(|column| column as f32)
        };
        let rows = (0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |i| (row, i)));
        Self {
            entries: rows.map(|(row, i)| entry(row, i)).collect(),
        }
    }

    /// Columns from the radius `r` (km) to the top of the air, km; a ray below the horizon is treated as the one that touches it.
    pub fn to_top(&self, r: f64, mu: f64) -> DVec3 {
        self.level(r).to_top(mu)
    }

    /// The table at the radius `r` (km).
    pub fn level(&self, r: f64) -> Level<'_> {
        let row = row(r);
        Level {
            r,
            least: TOP_RADIUS - r,
            most: horizon_distance(r) + horizon_distance(TOP_RADIUS),
            row,
            entries: &self.entries[(row as usize).min(HEIGHT - 2) * WIDTH..],
        }
    }
}

/// Row, fractional, of [`Columns`] at the radius `r` (km).
pub fn row(r: f64) -> f64 {
    let share = horizon_distance(r) / horizon_distance(TOP_RADIUS);
    share.clamp(0.0, 1.0) * (HEIGHT - 1) as f64
}

/// [`Columns`] at one radius.
#[derive(Clone, Copy, Debug)]
pub struct Level<'t> {
    r: f64,
    /// Distances to the top: upward, and past the horizon.
    least: f64,
    most: f64,
    /// Row, fractional.
    row: f64,
    /// The table from that row on.
    entries: &'t [[f32; 3]],
}

impl Level<'_> {
    /// As [`Columns::to_top`].
    pub fn to_top(&self, mu: f64) -> DVec3 {
        let x = (distance_to_top(self.r, mu) - self.least) / (self.most - self.least);
        let x = x.clamp(0.0, 1.0) * (WIDTH - 1) as f64;
        let (i, j) = (
            (x as usize).min(WIDTH - 2),
            (self.row as usize).min(HEIGHT - 2),
        );
        let at = |i: usize| DVec3::from_array(self.entries[i].map(f64::from));
        let row = |start: usize| at(start + i).lerp(at(start + i + 1), x - i as f64);
        row(0).lerp(row(WIDTH), self.row - j as f64)
    }
}

/// Distance to the point where a ray from the radius `r` touches the ground, km.
fn horizon_distance(r: f64) -> f64 {
    ((r - GROUND_RADIUS).max(0.0) * (r + GROUND_RADIUS)).sqrt()
}

/// Altitude, km, at the distance `t` (km) along a ray from the radius `r`; by a difference, as r² and t² nearly cancel.
pub fn altitude_along(r: f64, mu: f64, t: f64) -> f64 {
    let above = (r - GROUND_RADIUS) * (r + GROUND_RADIUS) + t * (t + 2.0 * r * mu);
    (above / ((above + GROUND_RADIUS * GROUND_RADIUS).sqrt() + GROUND_RADIUS)).clamp(0.0, THICKNESS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertical_columns_are_those_of_the_profiles() {
        let nodes = gauss_legendre(64);
        let columns = exact(GROUND_RADIUS, 1.0, THICKNESS, 1.2, &nodes);
        // The exponential; the tent; the sum of the log-linear pieces of the table.
        let expected = DVec3::new(8.443_898, 1.2 * (1.0 - (-100f64).exp()), 15.0);
        let error = (columns / expected - 1.0).abs().max_element();
        assert!(error < 1e-5, "{columns} {error:e}");
    }

    #[test]
    fn the_table_holds_the_columns() {
        let table = Columns::new(1.2);
        let nodes = gauss_legendre(64);
        let mut worst: f64 = 0.0;
        for altitude in [0.0, 0.3, 1.0, 3.0, 8.0, 20.0, 60.0] {
            let r = GROUND_RADIUS + altitude;
            for degrees in [0.05, 0.5, 2.0, 5.0, 15.0, 40.0, 90.0] {
                let mu = (horizon_cosine(r).asin() + f64::to_radians(degrees)).sin();
                let length = distance_to_top(r, mu);
                let columns = exact(r, mu, length, 1.2, &nodes);
                // Transmittance at 445 nm, with an AOD of 0.6, with 600 DU.
                let through =
                    |columns: DVec3| (-columns * DVec3::new(0.0274, 0.65, 0.005)).map(f64::exp);
                let error = (through(table.to_top(r, mu)) - through(columns)).abs();
                worst = worst.max(error.max_element());
            }
        }
        println!("largest error of a transmittance: {worst:.1e}");
        // Most of it is where a ray 60 km up grazes the aerosol.
        assert!(worst < 0.01);
    }

    #[test]
    fn distances_are_those_of_the_sphere() {
        let r = GROUND_RADIUS + 2.0;
        assert!((distance_to_top(r, 1.0) - 118.0).abs() < 1e-9);
        assert!((distance_to_ground(r, -1.0) - 2.0).abs() < 1e-9);
        let horizon = horizon_cosine(r);
        let touch = (r * r - GROUND_RADIUS * GROUND_RADIUS).sqrt();
        assert!((distance_to_ground(r, horizon - 1e-12) - touch).abs() < 0.1);
        assert!(altitude_along(r, horizon, touch) < 1e-6);
    }
}
