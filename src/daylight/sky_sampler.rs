//! Importance sampling of the sky: directional lights drawn with a density proportional to luminance.
//!
//! ∫ V L cos dω ≈ 1/n Σ V(ω_i) cos θ_i L(ω_i)/p(ω_i). Since p is proportional to the luminance, all lights have nearly the same
//! luminance, and L/p keeps the colour.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::colour::luminance;
use super::sampling;
use super::sky::Daylight;

/// Rows of the table, in equal steps of the sine of the elevation, so that all cells have the same solid angle.
const ROWS: usize = 64;
/// Columns of the table, in equal steps of azimuth.
const COLUMNS: usize = 256;
/// Solid angle of a cell, sr.
const CELL: f64 = TAU / (ROWS * COLUMNS) as f64;

/// A directional light: one sample of the sky or of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DomeLight {
    /// Unit vector toward the light.
    pub direction: DVec3,
    /// L/p: illuminance at normal incidence, linear BT.709 RGB, lux. The mean over n lights, not the sum, is the sky's.
    pub illuminance: DVec3,
}

/// Draws directions of the upper hemisphere with a density proportional to the sky's luminance.
///
/// The density is constant in each cell of a table, but L is evaluated at the direction itself, so the estimate is unbiased.
#[derive(Clone, Debug)]
pub struct SkySampler {
    /// Cumulative distribution over the rows, upward from the horizon; the last value is 1.
    rows: Vec<f64>,
    /// Cumulative distribution within each row.
    columns: Vec<Vec<f64>>,
}

impl SkySampler {
    /// Tabulates the luminance of a daylight's sky.
    pub fn new(daylight: &Daylight) -> Self {
        let cell = |row: usize, column: usize| {
            let at = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
            luminance(daylight.sky_radiance(toward(at)))
        };
        let table: Vec<Vec<f64>> = (0..ROWS)
            .map(|row| (0..COLUMNS).map(|column| cell(row, column)).collect())
            .collect();
        let sums: Vec<f64> = table.iter().map(|row| row.iter().sum()).collect();
        Self {
            rows: cumulative(&sums),
            columns: table.iter().map(|row| cumulative(row)).collect(),
        }
    }

    /// Probability density of [`SkySampler::light`] at a unit direction of the upper hemisphere, 1/sr.
    pub fn density(&self, direction: DVec3) -> f64 {
        let (row, column) = cell_of(direction);
        share(&self.rows, row) * share(&self.columns[row], column) / CELL
    }

    /// The light sampled by a point in [0, 1)².
    pub fn light(&self, daylight: &Daylight, xi: DVec2) -> DomeLight {
        let (row, y, row_share) = invert(&self.rows, xi.y);
        let (column, x, column_share) = invert(&self.columns[row], xi.x);
        let direction = toward(DVec2::new(column as f64 + x, row as f64 + y));
        let density = row_share * column_share / CELL;
        DomeLight {
            direction,
            illuminance: daylight.sky_radiance(direction) / density,
        }
    }
}

/// The ground light sampled by a point in [0, 1)²: directions are uniform in the lower hemisphere.
pub fn ground_light(daylight: &Daylight, xi: DVec2) -> DomeLight {
    let up = sampling::uniform_sphere(DVec2::new(0.5 * xi.x, xi.y));
    DomeLight {
        direction: DVec3::new(up.x, -up.z, up.y),
        illuminance: daylight.ground_luminance * TAU,
    }
}

/// Irradiance of the unoccluded ground on a plane: π L (1 − n_y)/2, lux.
pub fn ground_irradiance(daylight: &Daylight, normal: DVec3) -> DVec3 {
    daylight.ground_luminance * (0.5 * PI * (1.0 - normal.y))
}

/// Unit direction of a table position: x in columns, y in rows.
fn toward(at: DVec2) -> DVec3 {
    let sine = at.y / ROWS as f64;
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let (s, c) = (at.x / COLUMNS as f64 * TAU).sin_cos();
    DVec3::new(s * cosine, sine, -c * cosine)
}

/// Row and column of the cell in which a direction of the upper hemisphere lies.
fn cell_of(direction: DVec3) -> (usize, usize) {
    let row = (direction.y.max(0.0) * ROWS as f64) as usize;
    let turn = direction.x.atan2(-direction.z) / TAU;
    let column = (turn.rem_euclid(1.0) * COLUMNS as f64) as usize;
    (row.min(ROWS - 1), column.min(COLUMNS - 1))
}

/// Probability of a cell of a cumulative distribution.
fn share(cumulative: &[f64], cell: usize) -> f64 {
    cumulative[cell] - cell.checked_sub(1).map_or(0.0, |below| cumulative[below])
}

/// Cumulative distribution of `values`; uniform if they sum to 0.
fn cumulative(values: &[f64]) -> Vec<f64> {
    let total: f64 = values.iter().sum();
    let share = |v: &f64| {
        if total > 0.0 {
            v / total
        } else {
            1.0 / values.len() as f64
        }
    };
    let mut sum = 0.0;
    let mut list: Vec<f64> = values
        .iter()
        .map(|v| {
            sum += share(v);
            sum
        })
        .collect();
    if let Some(last) = list.last_mut() {
        *last = 1.0;
    }
    list
}

/// Inverts a cumulative distribution at `xi` in [0, 1): the cell, the position in it (0..=1), and the cell's probability.
fn invert(cumulative: &[f64], xi: f64) -> (usize, f64, f64) {
    let cell = cumulative
        .partition_point(|c| *c <= xi)
        .min(cumulative.len() - 1);
    let low = if cell == 0 { 0.0 } else { cumulative[cell - 1] };
    let share = cumulative[cell] - low;
    (cell, ((xi - low) / share).clamp(0.0, 1.0), share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::quadrature::SphereQuadrature;
    use crate::daylight::sky::{Conditions, SkyModel};

    #[test]
    fn the_density_is_that_of_the_directions_drawn() {
        let daylight = day(SkyModel::Preetham, 30.0);
        let dome = SkySampler::new(&daylight);
        for i in 0..1000 {
            let light = dome.light(&daylight, sampling::r2(i));
            let drawn =
                luminance(daylight.sky_radiance(light.direction)) / luminance(light.illuminance);
            let ratio = dome.density(light.direction) / drawn;
            // On the border of two cells rounding may tell the other.
            assert!((ratio - 1.0).abs() < 1e-9 || i == 0, "{i}: {ratio}");
        }
        let upper = SphereQuadrature::upper(256, 512);
        let total = upper.integrate(|d| DVec3::splat(dome.density(d))).x;
        assert!((total - 1.0).abs() < 0.01, "{total}");
    }

    fn day(model: SkyModel, elevation: f64) -> Daylight {
        Daylight::new(&Conditions {
            model,
            sun_elevation_deg: elevation,
            ..Conditions::default()
        })
    }

    fn estimate(daylight: &Daylight, count: u32, normal: DVec3) -> DVec3 {
        let dome = SkySampler::new(daylight);
        let sum: DVec3 = (0..count)
            .map(|i| dome.light(daylight, sampling::r2(i)))
            .map(|l| l.illuminance * l.direction.dot(normal).max(0.0))
            .sum();
        sum / f64::from(count)
    }

    #[test]
    fn the_lights_add_up_to_the_skys_irradiance() {
        let quadrature = SphereQuadrature::upper(256, 512);
        for model in [SkyModel::Preetham, SkyModel::Hosek, SkyModel::Overcast] {
            for elevation in [3.0, 40.0, 85.0] {
                let daylight = day(model, elevation);
                for normal in [DVec3::Y, DVec3::X, DVec3::new(0.6, 0.0, 0.8)] {
                    let exact = quadrature.irradiance(normal, |d| daylight.sky_radiance(d));
                    let scale = luminance(daylight.sky_irradiance_up);
                    for (count, tolerance) in [(64, 0.12), (4096, 2e-3), (65_536, 5e-4)] {
                        let error = (estimate(&daylight, count, normal) - exact)
                            .abs()
                            .max_element()
                            / scale;
                        assert!(
                            error < tolerance,
                            "{model:?} {elevation} {normal} {count}: {error}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn lights_are_of_nearly_equal_luminance() {
        let daylight = day(SkyModel::Preetham, 20.0);
        let dome = SkySampler::new(&daylight);
        let mean = (0..1024)
            .map(|i| luminance(dome.light(&daylight, sampling::r2(i)).illuminance))
            .sum::<f64>()
            / 1024.0;
        for i in 0..1024 {
            let l = luminance(dome.light(&daylight, sampling::r2(i)).illuminance);
            assert!((l / mean - 1.0).abs() < 0.2, "{i}: {l} of {mean}");
        }
    }

    #[test]
    fn a_black_sky_is_black_and_finite() {
        let daylight = Daylight::new(&Conditions {
            horizontal_illuminance: Some(0.0),
            ..Conditions::default()
        });
        assert_eq!(estimate(&daylight, 16, DVec3::Y), DVec3::ZERO);
    }

    #[test]
    fn the_ground_lights_what_looks_down() {
        let daylight = day(SkyModel::Preetham, 40.0);
        for normal in [DVec3::NEG_Y, DVec3::X, DVec3::Y] {
            let sum: DVec3 = (0..4096)
                .map(|i| ground_light(&daylight, sampling::r2(i)))
                .map(|l| l.illuminance * l.direction.dot(normal).max(0.0))
                .sum();
            let error = sum / 4096.0 - ground_irradiance(&daylight, normal);
            let largest = ground_irradiance(&daylight, DVec3::NEG_Y).max_element();
            assert!(error.abs().max_element() < 2e-3 * largest, "{normal}");
        }
    }
}
