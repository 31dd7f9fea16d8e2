//! Table E: the air between an eye and what it sees, in every direction and to every distance, under one sun.
//!
//! Along a ray the optical depth is a mean density times the distance, and the light scattered into it is 1 - transmittance times a mean
//! source, at each of the four wavelengths. These factors hold most of the dependence on the distance; what the table holds changes little from
//! entry to entry. Light that the aerosol scatters once is kept without its phase function, which is the same along the whole ray.
//!
//! Entries lie along the azimuth from the sun; rows along the elevation above the horizon of the ground and then below it, close to the
//! horizon; steps along the ray to the ceiling or to the ground. Nothing is interpolated across the horizon. The table holds for every
//! direction of the view and every distance: it is made again only when the sun or the altitude of the eye change.

use std::ops::{Add, Mul};

use glam::{DVec2, DVec3, DVec4};

use super::columns::{distance_to_ground, horizon_cosine};
use super::medium::{GROUND_RADIUS, THICKNESS, densities};
use super::path::{Path, mean_transmittance};
use super::scattered_sky::ScatteredSky;
use super::sky_view::toward;
use super::{Aerial, Atmosphere, each};

/// Entries along half a turn of azimuth.
pub const AZIMUTHS: usize = 32;
/// Rows of sources above the horizon, and as many below.
pub const SOURCE_ROWS: usize = 24;
/// Rows of densities above the horizon, and as many below.
pub const DENSITY_ROWS: usize = 96;
/// Steps along a ray, its two ends included.
pub const STEPS: usize = 24;
/// Least altitude at which rays above the horizon end, km: no mountain is higher.
const CEILING: f64 = 12.0;

/// The rays of an eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rays {
    /// Altitude of the eye, km, from 0 to one less than [`THICKNESS`].
    pub altitude: f64,
    /// Altitude at which rays above the horizon end, km.
    pub ceiling: f64,
    /// Sine of the elevation of the horizon of the ground.
    pub horizon: f64,
}

impl Rays {
    /// The rays of an eye at this altitude, km, which is clamped to the air.
    pub fn new(altitude: f64) -> Self {
        let altitude = altitude.clamp(0.0, THICKNESS - 1.0);
        Self {
            altitude,
            ceiling: CEILING.max(altitude + 1.0),
            horizon: horizon_cosine(GROUND_RADIUS + altitude),
        }
    }

    /// Whether the ray whose elevation has this sine meets the ground.
    pub fn meets_ground(&self, sine: f64) -> bool {
        sine < self.horizon
    }

    /// Length of the ray whose elevation has this sine, km: to the ground or to the ceiling.
    pub fn length(&self, sine: f64, meets_ground: bool) -> f64 {
        let r = GROUND_RADIUS + self.altitude;
        if meets_ground {
            return distance_to_ground(r, sine);
        }
        let sum = 2.0 * GROUND_RADIUS + self.altitude + self.ceiling;
        let (height, along) = ((self.ceiling - self.altitude) * sum, r * sine);
        let root = (height + along * along).sqrt();
        // The form without cancellation.
        if along > 0.0 {
            height / (root + along)
        } else {
            root - along
        }
    }

    /// Row of an elevation, fractional, in twice `rows`; never between the two halves.
    ///
    /// 1 - sqrt(1 - sine) is linear in the angle both at the horizon and at the zenith.
    fn row(&self, sine: f64, rows: usize) -> f64 {
        let share = |sine: f64, horizon: f64| {
            let root = (1.0 - horizon).sqrt();
            let height = (sine - horizon) / (root + (1.0 - sine).max(0.0).sqrt());
            (height / root).clamp(0.0, 1.0).sqrt() * (rows - 1) as f64
        };
        if self.meets_ground(sine) {
            rows as f64 + share(-sine, -self.horizon)
        } else {
            share(sine, self.horizon)
        }
    }

    /// Sine of the elevation of row `j` of twice `rows`, and whether the ray meets the ground.
    fn of_row(&self, j: usize, rows: usize) -> (f64, bool) {
        let below = j >= rows;
        let sign = if below { -1.0 } else { 1.0 };
        let y = (j % rows) as f64 / (rows - 1) as f64;
        let horizon = self.horizon * sign;
        let sine = horizon + (1.0 - horizon) * y * y * (2.0 - y * y);
        (sine * sign, below)
    }
}

/// Step, fractional, at a share of a ray: closer where the air is denser, at the eye or at the ground.
fn step_at(share: f64, meets_ground: bool) -> f64 {
    let last = (STEPS - 1) as f64;
    if meets_ground {
        last * (1.0 - (1.0 - share).max(0.0).sqrt())
    } else {
        last * share.min(1.0).sqrt()
    }
}

/// Share of a ray at a step, fractional.
fn share_at(step: f64, meets_ground: bool) -> f64 {
    let x = step / (STEPS - 1) as f64;
    if meets_ground { x * (2.0 - x) } else { x * x }
}

/// Entry, fractional, of the cosine of an azimuth from the sun; about linear in the azimuth.
fn entry_of(cosine: f64) -> f64 {
    let from_middle = 1.0 - (1.0 - cosine.abs()).max(0.0).sqrt();
    0.5 * (1.0 + from_middle.copysign(cosine)) * (AZIMUTHS - 1) as f64
}

/// Cosine of the azimuth of entry `i`.
fn azimuth_of(i: usize) -> f64 {
    let from_middle = 2.0 * i as f64 / (AZIMUTHS - 1) as f64 - 1.0;
    (1.0 - (1.0 - from_middle.abs()).powi(2)).copysign(from_middle)
}

/// Scattered light, over the irradiance of the sun outside the air: at a point 1/(km sr), of a ray over 1 - transmittance 1/sr.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// All but what the aerosol scatters once.
    pub rest: DVec4,
    /// What the aerosol scatters once, over its phase function.
    pub aerosol: DVec4,
}

/// The air before an eye under one light, the brighter of sun and moon.
#[derive(Clone, Debug)]
pub struct AirBefore {
    /// The rays of the eye.
    pub rays: Rays,
    /// Mean densities of air, aerosol and ozone from the eye to each of the [`STEPS`], over their reference; twice [`DENSITY_ROWS`] rows of them.
    pub densities: Vec<DVec3>,
    /// Mean sources from the eye to each step: twice [`SOURCE_ROWS`] rows of [`STEPS`] of [`AZIMUTHS`].
    pub sources: Vec<Source>,
    sky: ScatteredSky,
}

impl AirBefore {
    /// The air of `sky`, under the [brighter](ScatteredSky::brighter) of its lights, before an eye at `altitude` km above the sea.
    pub fn new(sky: &ScatteredSky, altitude: f64) -> Self {
        let (air, rays) = (&sky.atmosphere, Rays::new(altitude));
        let light = sky.brighter();
        let densities = (0..2 * DENSITY_ROWS).flat_map(|j| mean_densities(air, &rays, j));
        let row = |j: usize| {
            let along: Vec<Vec<Source>> = (0..AZIMUTHS)
                .map(|i| mean_sources(air, &rays, light.direction.y, j, i))
                .collect();
            (0..STEPS).flat_map(move |k| along.iter().map(|ray| ray[k]).collect::<Vec<_>>())
        };
        Self {
            rays,
            densities: densities.collect(),
            sources: (0..2 * SOURCE_ROWS).flat_map(row).collect(),
            sky: sky.clone(),
        }
    }

    /// The air between the eye and a point `distance` km away in the unit direction `dir`, or the end of the ray if it is nearer.
    pub fn between(&self, dir: DVec3, distance: f64) -> Aerial {
        let below = self.rays.meets_ground(dir.y);
        let length = self.rays.length(dir.y, below);
        let distance = distance.clamp(0.0, length);
        let step = step_at(distance / length.max(1e-9), below);
        let medium = &self.sky.atmosphere.medium;
        let row = self.rays.row(dir.y, DENSITY_ROWS);
        let density = linear(row, 2 * DENSITY_ROWS, |j| {
            linear(step, STEPS, |k| self.densities[j * STEPS + k])
        });
        let depth = medium.optical_depth(density * distance);
        let source = self.source(dir, step);
        let light = self.sky.brighter();
        let phase = medium.aerosol_phase(light.direction.dot(dir).clamp(-1.0, 1.0));
        let lost = depth * each(depth, mean_transmittance);
        Aerial::new(
            each(depth, |d| (-d).exp()),
            (source.rest + source.aerosol * phase) * lost * light.share,
        )
    }

    fn source(&self, dir: DVec3, step: f64) -> Source {
        let row = self.rays.row(dir.y, SOURCE_ROWS);
        let horizontal = DVec2::new(dir.x, dir.z).normalize_or_zero();
        let entry = entry_of(toward(self.sky.brighter().direction).dot(horizontal));
        let of = |part: fn(&Source) -> DVec4| {
            linear(row, 2 * SOURCE_ROWS, |j| {
                linear(step, STEPS, |k| {
                    let first = (j * STEPS + k) * AZIMUTHS;
                    linear(entry, AZIMUTHS, |i| part(&self.sources[first + i]))
                })
            })
        };
        Source {
            rest: of(|source| source.rest),
            aerosol: of(|source| source.aerosol),
        }
    }
}

/// Between the entries below and above `at`, of `count`.
fn linear<T: Mul<f64, Output = T> + Add<Output = T>>(
    at: f64,
    count: usize,
    entry: impl Fn(usize) -> T,
) -> T {
    let i = (at as usize).min(count - 2);
    let share = at - i as f64;
    entry(i) * (1.0 - share) + entry(i + 1) * share
}

/// Parts of a ray of `length` km, two before each step but the first: middle and length of each, km.
fn parts(length: f64, meets_ground: bool) -> impl Iterator<Item = [(f64, f64); 2]> {
    let at = move |half_steps: usize| length * share_at(0.5 * half_steps as f64, meets_ground);
    (1..STEPS).map(move |k| {
        let [a, b, c] = [2 * k - 2, 2 * k - 1, 2 * k].map(at);
        [(0.5 * (a + b), b - a), (0.5 * (b + c), c - b)]
    })
}

fn mean_densities(air: &Atmosphere, rays: &Rays, row: usize) -> Vec<DVec3> {
    let (sine, below) = rays.of_row(row, DENSITY_ROWS);
    let path = Path::of_length(
        GROUND_RADIUS + rays.altitude,
        sine,
        rays.length(sine, below),
    );
    let height = air.medium.scale_height;
    let (mut column, mut distance) = (DVec3::ZERO, 0.0);
    let mut means = vec![densities(rays.altitude, height)];
    for parts in parts(path.length, below) {
        for (t, length) in parts {
            column += densities(path.point(t).altitude, height) * length;
            distance += length;
        }
        means.push(if distance > 0.0 {
            column / distance
        } else {
            means[0]
        });
    }
    means
}

fn mean_sources(
    air: &Atmosphere,
    rays: &Rays,
    sun_sine: f64,
    row: usize,
    entry: usize,
) -> Vec<Source> {
    let (sine, below) = rays.of_row(row, SOURCE_ROWS);
    let path = Path::of_length(
        GROUND_RADIUS + rays.altitude,
        sine,
        rays.length(sine, below),
    );
    let across = ((1.0 - sine * sine) * (1.0 - sun_sine * sun_sine))
        .max(0.0)
        .sqrt();
    let cos_gamma = (sine * sun_sine + across * azimuth_of(entry)).clamp(-1.0, 1.0);
    // Source and extinction at a point.
    let at = |t: f64| {
        let point = path.point(t);
        let density = densities(point.altitude, air.medium.scale_height);
        let sun = path.sun_sine(t, &point, sun_sine, cos_gamma);
        let source = air.source(&point, density, sun, cos_gamma);
        (source, air.medium.optical_depth(density))
    };
    let over = |source: Source, by: DVec4| Source {
        rest: source.rest / by,
        aerosol: source.aerosol / by,
    };
    let (here, extinction) = at(0.0);
    let mut means = vec![over(here, extinction)];
    let (mut depth, mut sum) = (
        DVec4::ZERO,
        Source {
            rest: DVec4::ZERO,
            aerosol: DVec4::ZERO,
        },
    );
    for parts in parts(path.length, below) {
        for (t, length) in parts {
            let (source, extinction) = at(t);
            let own = extinction * length;
            let weight = each(depth, |d| (-d).exp()) * each(own, mean_transmittance) * length;
            sum.rest += weight * source.rest;
            sum.aerosol += weight * source.aerosol;
            depth += own;
        }
        let lost = depth * each(depth, mean_transmittance);
        let is_empty = lost.min_element() <= 0.0;
        means.push(if is_empty { means[0] } else { over(sum, lost) });
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_steps_and_entries_are_undone() {
        for altitude in [0.0, 0.002, 3.0, 60.0] {
            let rays = Rays::new(altitude);
            for rows in [SOURCE_ROWS, DENSITY_ROWS] {
                for j in 0..2 * rows {
                    let (sine, below) = rays.of_row(j, rows);
                    // The first row below is the horizon itself.
                    let found = rays.row(if j == rows { sine - 1e-15 } else { sine }, rows);
                    assert!((found - j as f64).abs() < 1e-3, "{altitude} {j} {found}");
                    assert!(below == (j >= rows) && rays.length(sine, below).is_finite());
                }
            }
        }
        for below in [false, true] {
            for k in 0..STEPS {
                let share = share_at(k as f64, below);
                assert!((step_at(share, below) - k as f64).abs() < 1e-9);
            }
        }
        for i in 0..AZIMUTHS {
            assert!((entry_of(azimuth_of(i)) - i as f64).abs() < 1e-9);
        }
    }

    #[test]
    fn parts_fill_the_ray() {
        for below in [false, true] {
            let sum: f64 = parts(80.0, below).flatten().map(|(_, length)| length).sum();
            assert!((sum - 80.0).abs() < 1e-9);
        }
    }
}
