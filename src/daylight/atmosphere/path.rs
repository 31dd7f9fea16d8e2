//! Straight paths through the air, cut into cells that are small where the air is dense.

use super::columns::{altitude_along, distance_to_ground, distance_to_top};
use super::medium::GROUND_RADIUS;

/// A straight path from a point to the top of the air, to the ground, or to a given distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// Radius of the start, km.
    pub r: f64,
    /// Cosine of the direction with the vertical at the start.
    pub mu: f64,
    /// Length, km.
    pub length: f64,
    lowest: f64,
    from: f64,
    to: f64,
}

/// A cell of a [`Path`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Distance of the point that stands for it from the start, km.
    pub t: f64,
    /// Length, km.
    pub length: f64,
    /// Distance of its end from the start, km.
    pub end: f64,
}

/// A point of a [`Path`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Altitude, km.
    pub altitude: f64,
    /// Distance from the centre of the earth, km.
    pub radius: f64,
    /// Cosine of the path's direction with the vertical here.
    pub mu: f64,
}

impl Path {
    /// The whole path from the radius `r` (km): to the ground if `meets_ground`, else to the top of the air.
    pub fn new(r: f64, mu: f64, meets_ground: bool) -> Self {
        let length = if meets_ground {
            distance_to_ground(r, mu)
        } else {
            distance_to_top(r, mu)
        };
        Self::of_length(r, mu, length)
    }

    /// The path of `length` km. Its cells are uniform in the square root of the distance from its lowest point.
    pub fn of_length(r: f64, mu: f64, length: f64) -> Self {
        let lowest = (-r * mu).clamp(0.0, length);
        Self {
            r,
            mu,
            length,
            lowest,
            from: -lowest.sqrt(),
            to: (length - lowest).sqrt(),
        }
    }

    /// Cell `k` of `n`.
    ///
    /// With y the signed root of the distance from the lowest point, light along a cell is ∫ f(t) 2|y| dy. The mean of y|y| over the cell makes f there
    /// times the cell's length right to the fourth order of the cell's width, at the ends of the path too; its middle would not.
    pub fn cell(&self, k: usize, n: usize) -> Cell {
        let width = (self.to - self.from) / n as f64;
        let (a, b) = (
            self.from + width * k as f64,
            self.from + width * (k + 1) as f64,
        );
        let mean = (b.abs().powi(3) - a.abs().powi(3)) / (3.0 * width).max(1e-30);
        let at = |t: f64| (self.lowest + t).clamp(0.0, self.length);
        let (start, end) = (at(a * a.abs()), at(b * b.abs()));
        Cell {
            t: at(mean),
            length: end - start,
            end,
        }
    }

    /// The point at the distance `t` km.
    pub fn point(&self, t: f64) -> Point {
        let altitude = altitude_along(self.r, self.mu, t);
        let radius = GROUND_RADIUS + altitude;
        Point {
            altitude,
            radius,
            mu: ((self.r * self.mu + t) / radius).clamp(-1.0, 1.0),
        }
    }

    /// Sine of the sun's elevation at the distance `t`, from that at the start and the cosine between the path and the sun.
    pub fn sun_sine(&self, t: f64, point: &Point, sun_sine: f64, cos_gamma: f64) -> f64 {
        ((self.r * sun_sine + t * cos_gamma) / point.radius).clamp(-1.0, 1.0)
    }
}

/// (1 - exp(-x))/x: the mean transmittance along a cell of the optical depth `x`.
pub fn mean_transmittance(x: f64) -> f64 {
    if x.abs() < 1e-3 {
        1.0 - x * (0.5 - x / 6.0)
    } else {
        (1.0 - (-x).exp()) / x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::atmosphere::columns::horizon_cosine;

    #[test]
    fn cells_fill_the_path() {
        for (altitude, mu, meets_ground) in [
            (0.0, 0.0, false),
            (0.0, 1.0, false),
            (0.0, -0.5, true),
            (8.0, -0.01, false),
            (8.0, -0.2, true),
        ] {
            let path = Path::new(GROUND_RADIUS + altitude, mu, meets_ground);
            let cells: Vec<Cell> = (0..24).map(|k| path.cell(k, 24)).collect();
            let sum: f64 = cells.iter().map(|cell| cell.length).sum();
            assert!((sum - path.length).abs() < 1e-9 && (cells[23].end - path.length).abs() < 1e-9);
            assert!(
                cells
                    .iter()
                    .all(|c| c.t <= c.end + 1e-9 && c.t >= c.end - c.length - 1e-9)
            );
        }
    }

    #[test]
    fn few_cells_find_the_column_of_a_thin_layer() {
        // exp(-h/H) along a path that starts, ends or dips in the layer.
        let r = GROUND_RADIUS + 3.0;
        let cases = [
            (GROUND_RADIUS, 0.3, false),
            (r, horizon_cosine(r) + 1e-4, false),
            (r, -0.3, true),
        ];
        for (r, mu, meets_ground) in cases {
            let path = Path::new(r, mu, meets_ground);
            let column = |n: usize| -> f64 {
                let density = |t| (-path.point(t).altitude / 1.2).exp();
                (0..n)
                    .map(|k| path.cell(k, n))
                    .map(|c| density(c.t) * c.length)
                    .sum()
            };
            let error = column(24) / column(4000) - 1.0;
            println!("{mu}: {error:.1e}");
            assert!(error.abs() < 0.01, "{mu}: {error:e}");
        }
    }

    #[test]
    fn the_mean_transmittance_has_no_step() {
        for x in [0.0, 1e-9, 9.999e-4, 1e-3, 1.001e-3, 0.1, 5.0, 500.0] {
            let exact = if x == 0.0 { 1.0 } else { -f64::exp_m1(-x) / x };
            assert!((mean_transmittance(x) / exact - 1.0).abs() < 1e-9, "{x}");
        }
    }
}
