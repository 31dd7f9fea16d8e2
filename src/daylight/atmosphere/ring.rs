//! Radiance in many directions of one elevation under one sun: [`Atmosphere::transfer`], where what the directions share is computed once.
//!
//! Their paths pass the same altitudes, so densities, optical depths and the rows of the tables are the same. Only the cosine with the sun
//! and the sun's elevation along the path differ, the latter so little that most points of a cell lie in the same column of the field.

use glam::DVec4;

use super::columns::{self, horizon_cosine};
use super::field::{self, legendre_3_to_6, scattering_by_degree};
use super::medium::{densities, rayleigh_phase};
use super::path::{Cell, Path, Point, mean_transmittance};
use super::{Atmosphere, GROUND_CELLS, VIEW_CELLS, each, share_of_disc};

/// A direction, and the light scattered into its path so far.
struct Direction {
    /// Cosine with the sun.
    cos_gamma: f64,
    /// Phase functions of air and aerosol there.
    phases: [f64; 2],
    /// [`legendre_3_to_6`] of it.
    polynomials: [f64; 4],
    scattered: DVec4,
}

impl Direction {
    fn new(atmosphere: &Atmosphere, cos_gamma: f64) -> Self {
        let aerosol = atmosphere.medium.aerosol_phase(cos_gamma);
        Self {
            cos_gamma,
            phases: [rayleigh_phase(cos_gamma), aerosol],
            polynomials: legendre_3_to_6(cos_gamma),
            scattered: DVec4::ZERO,
        }
    }
}

impl Atmosphere {
    /// [`Self::transfer`] in the directions whose elevation has the sine `mu`, by their cosines with the sun.
    pub(super) fn transfers(
        &self,
        sun_sine: f64,
        mu: f64,
        cos_gammas: impl Iterator<Item = f64>,
        meets_ground: bool,
    ) -> Vec<DVec4> {
        let path = Path::new(self.observer(), mu, meets_ground);
        let mut ring: Vec<Direction> = cos_gammas.map(|c| Direction::new(self, c)).collect();
        let cells = if meets_ground {
            GROUND_CELLS
        } else {
            VIEW_CELLS
        };
        let transmittance = self.along_ring(&path, sun_sine, &mut ring, cells);
        let end = path.point(path.length);
        let transfer = |direction: &Direction| {
            if !meets_ground {
                return direction.scattered;
            }
            let sine = path.sun_sine(path.length, &end, sun_sine, direction.cos_gamma);
            direction.scattered + transmittance * self.ground_radiance(sine)
        };
        ring.iter().map(transfer).collect()
    }

    /// Adds the light scattered along `path` to each direction, and returns the path's transmittance: [`Self::along`] for all of them.
    fn along_ring(
        &self,
        path: &Path,
        sun_sine: f64,
        ring: &mut [Direction],
        cells: usize,
    ) -> DVec4 {
        let mut depth = DVec4::ZERO;
        let cells = if path.length == 0.0 { 0 } else { cells };
        for k in 0..cells {
            let cell = path.cell(k, cells);
            let point = path.point(cell.t);
            let mut here = Place::new(self, &cell, point, depth);
            for direction in &mut *ring {
                let sine = path.sun_sine(cell.t, &point, sun_sine, direction.cos_gamma);
                direction.scattered += here.scattered(self, sine, direction);
            }
            depth += here.depth;
        }
        each(depth, |d| (-d).exp())
    }
}

/// The air in a cell of a path.
struct Place<'f> {
    /// Cosine of the path with the vertical.
    mu: f64,
    /// Optical depth of the cell.
    depth: DVec4,
    /// Light that arrives at the eye over what is scattered toward it.
    weight: DVec4,
    /// Scattering by air and aerosol, 1/km.
    scattering: [DVec4; 2],
    /// Sine of the elevation of the horizon, and one over its cosine.
    horizon: [f64; 2],
    columns: columns::Level<'f>,
    field: field::Level<'f>,
}

impl<'f> Place<'f> {
    /// `before` is the optical depth from the eye to the cell.
    fn new(atmosphere: &'f Atmosphere, cell: &Cell, point: Point, before: DVec4) -> Self {
        let medium = &atmosphere.medium;
        let density = densities(point.altitude, medium.scale_height);
        let depth = medium.optical_depth(density) * cell.length;
        let horizon = horizon_cosine(point.radius);
        let factors = scattering_by_degree(medium, density.x, density.y);
        Self {
            mu: point.mu,
            depth,
            weight: each(before, |d| (-d).exp()) * each(depth, mean_transmittance) * cell.length,
            scattering: [
                medium.rayleigh * density.x,
                medium.aerosol_scattering() * density.y,
            ],
            horizon: [horizon, 1.0 / (1.0 - horizon * horizon).sqrt()],
            columns: atmosphere.columns.level(point.radius),
            field: atmosphere.field.level(point.altitude, factors),
        }
    }

    /// Light of this cell in a direction, where the sun's elevation has the sine `sine`.
    fn scattered(&mut self, atmosphere: &Atmosphere, sine: f64, direction: &Direction) -> DVec4 {
        let Direction {
            cos_gamma,
            phases: [air, aerosol],
            polynomials,
            ..
        } = direction;
        let low = field::basis(self.mu, sine, *cos_gamma);
        let more = self.field.scattered(sine, &low, polynomials);
        let once = self.scattering[0] * *air + self.scattering[1] * *aerosol;
        self.weight * (once * self.sun(atmosphere, sine) + more)
    }

    /// As [`Atmosphere::sun_through`].
    fn sun(&self, atmosphere: &Atmosphere, sine: f64) -> DVec4 {
        let [horizon, per_cosine] = self.horizon;
        let share = share_of_disc((sine - horizon) * per_cosine);
        if share == 0.0 {
            return DVec4::ZERO;
        }
        let depth = atmosphere.medium.optical_depth(self.columns.to_top(sine));
        each(depth, |d| (-d).exp()) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::atmosphere::air::Air;

    /// The sun above the horizon, on it, and in twilight; an eye at sea level and on a mountain.
    #[test]
    fn a_ring_is_its_directions_one_by_one() {
        let sea = Atmosphere::of(&Air::default());
        let mut mountain = sea.clone();
        mountain.air.altitude_m = 2500.0;
        let cosines = [1.0f64, 0.97, 0.5, 0.0, -0.3, -0.99, -1.0];
        for atmosphere in [&sea, &mountain] {
            let horizon = horizon_cosine(atmosphere.observer());
            for sun in [60f64, 20.0, 3.0, 0.1, -0.2, -4.0, -12.0].map(f64::to_radians) {
                let (sun, across) = sun.sin_cos();
                for mu in [1.0, 0.7, 0.1, 0.001, horizon, horizon - 1e-4, -0.2, -1.0] {
                    let below = mu < horizon;
                    let flat = (1.0 - mu * mu).max(0.0).sqrt() * across;
                    let gammas = cosines.map(|c| (mu * sun + flat * c).clamp(-1.0, 1.0));
                    let ring = atmosphere.transfers(sun, mu, gammas.into_iter(), below);
                    for (gamma, found) in gammas.into_iter().zip(ring) {
                        let one = atmosphere.transfer(sun, mu, gamma, below);
                        let off = (found - one).abs().max_element();
                        assert!(
                            off <= 1e-12 * one.max_element(),
                            "{sun} {mu} {gamma} {off:e}"
                        );
                    }
                }
            }
        }
    }
}
