//! Rays from a point, and their directions under all suns.

use std::f64::consts::PI;

use glam::DVec4;
use wide::f32x4;

use super::super::columns::horizon_cosine;
use super::super::field::{
    COEFFICIENTS, Grid, NORMS, legendre_3_to_6, polynomials_2, scattering_by_degree,
};
use super::super::medium::{Medium, densities, rayleigh_phase};
use super::super::path::{Path, Point, mean_transmittance};
use super::{Solver, lanes};
use crate::daylight::quadrature::gauss_legendre;

/// A cell of a ray.
pub(super) struct Cell {
    pub(super) t: f64,
    pub(super) point: Point,
    /// Transmittance to the cell's light times its length, km.
    pub(super) weight: f32x4,
    pub(super) scattering: [f32x4; 7],
    /// Scattering by air and by aerosol, 1/km.
    pub(super) species: [f32x4; 2],
}

pub(super) struct Ray {
    pub(super) path: Path,
    /// Solid angle per azimuth's share of half a turn, both halves together, sr.
    pub(super) solid_angle: f64,
    pub(super) meets_ground: bool,
    pub(super) end: f32x4,
    pub(super) cells: Vec<Cell>,
}

impl Solver<'_> {
    /// Rays from the radius `r`: Gauss's points in the square root of the angle from the horizon, above it and below.
    pub(super) fn rays(&self, r: f64, inclinations: usize) -> Vec<Ray> {
        let horizon = horizon_cosine(r).asin();
        let nodes = gauss_legendre(inclinations / 2);
        let side = |meets_ground: bool| {
            let reach = if meets_ground { -1.0 } else { 1.0 } * PI / 2.0 - horizon;
            nodes.iter().map(move |(x, weight)| {
                let elevation = horizon + reach * x * x;
                let solid_angle = 2.0 * PI * elevation.cos() * reach.abs() * 2.0 * x * weight;
                self.ray(r, elevation.sin(), solid_angle, meets_ground)
            })
        };
        side(true).chain(side(false)).collect()
    }

    fn ray(&self, r: f64, mu: f64, solid_angle: f64, meets_ground: bool) -> Ray {
        let path = Path::new(r, mu, meets_ground);
        let n = self.effort.cells;
        let mut depth = DVec4::ZERO;
        let mut cells = Vec::with_capacity(n);
        for k in 0..n {
            let cell = path.cell(k, n);
            let point = path.point(cell.t);
            let density = densities(point.altitude, self.medium.scale_height);
            // Of the density that scatters: what is lost and what is scattered then agree.
            let own = self.medium.optical_depth(density) * cell.length;
            let weight = (0..4).map(|l| (-depth[l]).exp() * mean_transmittance(own[l]));
            let mut weights = [0.0; 4];
            weights.iter_mut().zip(weight).for_each(|(a, b)| *a = b);
            cells.push(Cell {
                t: cell.t,
                point,
                weight: lanes(DVec4::from_array(weights) * cell.length),
                scattering: scattering_by_degree(self.medium, density.x, density.y).map(lanes),
                species: [
                    lanes(self.medium.rayleigh * density.x),
                    lanes(self.medium.aerosol_scattering() * density.y),
                ],
            });
            depth += own;
        }
        Ray {
            path,
            solid_angle,
            meets_ground,
            end: lanes(DVec4::from_array(depth.to_array().map(|d| (-d).exp()))),
            cells,
        }
    }
}

/// The directions of a ray by sun and azimuth.
pub(super) struct Directions {
    pub(super) suns: Vec<SunDirections>,
    pub(super) azimuths: usize,
}

pub(super) struct SunDirections {
    pub(super) sine: f64,
    pub(super) azimuths: Vec<Direction>,
}

pub(super) struct Direction {
    pub(super) cos_gamma: f64,
    pub(super) polynomials: [f32; 4],
    /// Phase functions of air and aerosol.
    pub(super) phases: [f32; 2],
    /// Norm times value of each basis function.
    pub(super) norms: [f32; COEFFICIENTS],
}

impl Direction {
    pub(super) fn values(&self, low: [f64; 5]) -> [f32; COEFFICIENTS - 1] {
        let [a, b, c, d, e] = low.map(|value| value as f32);
        let [p3, p4, p5, p6] = self.polynomials;
        [a, b, c, d, e, p3, p4, p5, p6]
    }
}

impl Directions {
    pub(super) fn new(medium: &Medium, ray: &Ray, grid: Grid, azimuths: usize) -> Self {
        let mu = ray.path.mu;
        let sun = |j: usize| {
            let sine = grid.sun_sine(j);
            let across = ((1.0 - mu * mu).max(0.0) * (1.0 - sine * sine)).sqrt();
            let direction = |m: usize| {
                let azimuth = PI * (m as f64 + 0.5) / azimuths as f64;
                let cos_gamma = (mu * sine + across * azimuth.cos()).clamp(-1.0, 1.0);
                let polynomials = legendre_3_to_6(cos_gamma).map(|p| p as f32);
                let mut direction = Direction {
                    cos_gamma,
                    polynomials,
                    phases: [rayleigh_phase(cos_gamma), medium.aerosol_phase(cos_gamma)]
                        .map(|phase| phase as f32),
                    norms: [NORMS[0] as f32; COEFFICIENTS],
                };
                // Toward the sun's own plane, which `basis` cannot tell where the sun is at the zenith.
                let x = (1.0 - mu * mu).max(0.0).sqrt() * azimuth.cos();
                let values = direction.values(polynomials_2(mu, x));
                for (c, value) in (1..).zip(values) {
                    direction.norms[c] = NORMS[c] as f32 * value;
                }
                direction
            };
            SunDirections {
                sine,
                azimuths: (0..azimuths).map(direction).collect(),
            }
        };
        Self {
            suns: (0..grid.suns).map(sun).collect(),
            azimuths,
        }
    }
}
