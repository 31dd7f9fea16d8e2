//! Radiance along rays: sunlight scattered once, and the light of an order scattered once more.

use std::f64::consts::PI;

use wide::f32x4;

use super::super::columns::{self, horizon_cosine};
use super::super::field::{COEFFICIENTS, DEGREES, Grid, basis};
use super::super::medium::{GROUND_RADIUS, TOP_RADIUS};
use super::super::share_of_disc;
use super::rays::{Cell, Directions, Ray};
use super::{Light, Order, Solver, ln, logarithmic};
use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;

impl Solver<'_> {
    /// Light scattered once, and the sun's light off the ground.
    pub(super) fn first(&self, ray: &Ray, directions: &Directions, light: &mut [f32x4]) {
        match self.light {
            Light::Sun => {}
            #[cfg(test)]
            Light::Space => {
                let end = if ray.meets_ground {
                    f32x4::ZERO
                } else {
                    ray.end
                };
                light.fill(end);
                return;
            }
        }
        let azimuths = directions.azimuths;
        for cell in &ray.cells {
            let sunlight = self.sunlight_at(cell.point.radius);
            let species = cell.species.map(|species| species * cell.weight);
            for (j, sun) in directions.suns.iter().enumerate() {
                for (direction, light) in sun.azimuths.iter().zip(&mut light[j * azimuths..]) {
                    let sine =
                        ray.path
                            .sun_sine(cell.t, &cell.point, sun.sine, direction.cos_gamma);
                    if let Some(reached) = sunlight.reaching(sine) {
                        let phase = direction.phases.map(f32x4::splat);
                        *light += (species[0] * phase[0] + species[1] * phase[1]) * reached;
                    }
                }
            }
        }
        if ray.meets_ground {
            let sunlight = self.sunlight_at(GROUND_RADIUS);
            let t = ray.path.length;
            let ground = ray.path.point(t);
            let albedo = f32x4::splat((self.medium.ground_albedo / PI) as f32);
            for (j, sun) in directions.suns.iter().enumerate() {
                for (direction, light) in sun.azimuths.iter().zip(&mut light[j * azimuths..]) {
                    let sine = ray.path.sun_sine(t, &ground, sun.sine, direction.cos_gamma);
                    if let Some(reached) = sunlight.reaching(sine) {
                        let cosine = f32x4::splat(sine.max(0.0) as f32);
                        *light += albedo * cosine * reached * ray.end;
                    }
                }
            }
        }
    }

    /// Sunlight at the radius `r`, for all elevations of the sun.
    fn sunlight_at(&self, r: f64) -> SunlightAt {
        let y = columns::row(r);
        let row = (y as usize).min(columns::HEIGHT - 2);
        let f = f32x4::splat((y - row as f64) as f32);
        let (a, b) = (row * columns::WIDTH, (row + 1) * columns::WIDTH);
        let pairs = self.depths[a..b].iter().zip(&self.depths[b..]);
        let horizon = horizon_cosine(r);
        let least = TOP_RADIUS - r;
        let most = columns::distance_to_top(r, horizon);
        SunlightAt {
            r,
            horizon,
            per_sine: 1.0 / (1.0 - horizon * horizon).sqrt(),
            below_top: (TOP_RADIUS - r) * (TOP_RADIUS + r),
            least,
            per_distance: (columns::WIDTH - 1) as f64 / (most - least).max(1e-6),
            depths: pairs.map(|(low, high)| *low + (*high - *low) * f).collect(),
        }
    }

    /// Light of the order before scattered once more.
    pub(super) fn further(
        &self,
        ray: &Ray,
        directions: &Directions,
        before: &Before,
        light: &mut [f32x4],
    ) {
        let (grid, azimuths) = (self.effort.grid, directions.azimuths);
        let mut row = vec![[f32x4::ZERO; COEFFICIENTS]; grid.suns];
        for cell in &ray.cells {
            before.row(grid, cell, &mut row);
            let base = cell.scattering[0] * cell.weight;
            for (j, sun) in directions.suns.iter().enumerate() {
                for (direction, light) in sun.azimuths.iter().zip(&mut light[j * azimuths..]) {
                    let cos_gamma = direction.cos_gamma;
                    let sine = ray.path.sun_sine(cell.t, &cell.point, sun.sine, cos_gamma);
                    let values = direction.values(basis(cell.point.mu, sine, cos_gamma));
                    *light += scattered(&row, grid.column(sine), base, &values);
                }
            }
        }
        if ray.meets_ground {
            let t = ray.path.length;
            let ground = ray.path.point(t);
            let albedo = f32x4::splat((self.medium.ground_albedo / PI) as f32) * ray.end;
            for (j, sun) in directions.suns.iter().enumerate() {
                for (direction, light) in sun.azimuths.iter().zip(&mut light[j * azimuths..]) {
                    let sine = ray.path.sun_sine(t, &ground, sun.sine, direction.cos_gamma);
                    *light += albedo * before.irradiance(grid, sine);
                }
            }
        }
    }
}

/// What the sun sends to the points of one radius; as [`sun_share`](super::super::sun_share) and [`columns::Columns::to_top`], with what is the same for all suns in advance.
struct SunlightAt {
    r: f64,
    horizon: f64,
    per_sine: f64,
    below_top: f64,
    least: f64,
    per_distance: f64,
    /// Optical depths to the top by distance to the top.
    depths: Vec<f32x4>,
}

impl SunlightAt {
    /// Sunlight under the sine of the sun's elevation; `None` in the earth's shadow.
    fn reaching(&self, sine: f64) -> Option<f32x4> {
        let above = (sine - self.horizon) * self.per_sine;
        if above <= -SUN_ANGULAR_RADIUS {
            return None;
        }
        let share = share_of_disc(above);
        let along = self.r * sine;
        let distance = (self.below_top + along * along).max(0.0).sqrt() - along;
        let last = (columns::WIDTH - 1) as f64;
        let x = ((distance - self.least) * self.per_distance).clamp(0.0, last);
        let i = (x as usize).min(columns::WIDTH - 2);
        let f = f32x4::splat((x - i as f64) as f32);
        let depth = self.depths[i] + (self.depths[i + 1] - self.depths[i]) * f;
        Some((-depth).exp() * f32x4::splat(share as f32))
    }
}

/// The order before, ready for interpolation.
pub(super) struct Before {
    texels: Vec<[f32x4; COEFFICIENTS]>,
    ground: Vec<f32x4>,
}

impl Before {
    pub(super) fn new(order: &Order) -> Self {
        Self {
            texels: order.texels.iter().map(logarithmic).collect(),
            ground: order.ground.iter().map(|e| ln(*e)).collect(),
        }
    }

    /// The field at a cell's altitude by sun; all but ln J times the cell's scattering and weight.
    fn row(&self, grid: Grid, cell: &Cell, row: &mut [[f32x4; COEFFICIENTS]]) {
        let y = grid.row(cell.point.altitude);
        let i = (y as usize).min(grid.altitudes - 2);
        let f = f32x4::splat((y - i as f64) as f32);
        let factors: [f32x4; COEFFICIENTS] = std::array::from_fn(|c| {
            if c == 0 {
                f32x4::ONE
            } else {
                cell.scattering[DEGREES[c]] * cell.weight
            }
        });
        let (a, b) = (i * grid.suns, (i + 1) * grid.suns);
        let pairs = self.texels[a..b].iter().zip(&self.texels[b..]);
        for (out, (low, high)) in row.iter_mut().zip(pairs) {
            for c in 0..COEFFICIENTS {
                out[c] = (low[c] + (high[c] - low[c]) * f) * factors[c];
            }
        }
    }

    fn irradiance(&self, grid: Grid, sun_sine: f64) -> f32x4 {
        let x = grid.column(sun_sine);
        let j = (x as usize).min(grid.suns - 2);
        let f = f32x4::splat((x - j as f64) as f32);
        let [low, high] = [self.ground[j], self.ground[j + 1]];
        (low + (high - low) * f).exp()
    }
}

/// J (base + Σ coefficient value) at a fractional column of a row.
fn scattered(
    row: &[[f32x4; COEFFICIENTS]],
    column: f64,
    base: f32x4,
    values: &[f32; COEFFICIENTS - 1],
) -> f32x4 {
    let j = (column as usize).min(row.len() - 2);
    let f = f32x4::splat((column - j as f64) as f32);
    let (low, high) = (&row[j], &row[j + 1]);
    let (mut from_low, mut from_high) = (base, base);
    for (c, value) in (1..).zip(values) {
        let value = f32x4::splat(*value);
        from_low += low[c] * value;
        from_high += high[c] * value;
    }
    let sum = from_low + (from_high - from_low) * f;
    let ln = low[0] + (high[0] - low[0]) * f;
    ln.exp() * sum.max(f32x4::ZERO)
}
