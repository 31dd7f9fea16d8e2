//! A clear sky with all orders of scattering in a spherical atmosphere of air, aerosol and ozone.
//!
//! 1. [`air`]: what the user says about the air. [`medium`]: its coefficients at four wavelengths, from which [`colour`] makes XYZ.
//! 2. [`columns`]: table A, columns of each species to the top of the air.
//! 3. [`mod@solve`]: the scattered light order by order; [`field`]: the tables B and C that it fills.
//! 4. [`Atmosphere`]: radiance by one more march along [`path`], where the first order is exact.
//!
//!    [`Atmosphere::of`] keeps the tables of the last airs.
//! 5. [`sky_view`]: table D, the whole view under one sun; [`scattered_sky`]: the sky that is read from it. The moon has such
//!    a view of its own.
//! 6. [`aerial`]: table E, the air before an eye.

pub mod aerial;
pub mod air;
pub mod colour;
pub mod columns;
pub mod field;
pub mod medium;
pub mod path;
mod ring;
pub mod scattered_sky;
pub mod sky_view;
pub mod solve;
mod solved;

use std::f64::consts::PI;
use std::sync::{Arc, LazyLock};

use glam::{DVec3, DVec4};

use self::aerial::Source;
use self::air::Air;
use self::columns::{Columns, horizon_cosine};
use self::field::{Field, scattering_by_degree};
use self::medium::{GROUND_RADIUS, Medium, densities, rayleigh_phase};
use self::path::{Path, Point, mean_transmittance};
use self::solve::{Effort, Light, solve};
use super::colour::rgb_from_xyz;
use super::quadrature::gauss_legendre;
use super::sunlight::{SUN_ANGULAR_RADIUS, visible_fraction};

/// Cells of a path to the top of the air.
pub const VIEW_CELLS: usize = 24;
/// Cells of a path to the ground, which is shorter.
pub const GROUND_CELLS: usize = 12;

/// Nodes of the columns toward the sun, and of elevations and azimuths of the sky.
static SUN_NODES: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(64));
static SKY_NODES: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(16));

/// Share of the sun's disc above the horizon of the ground, seen from the radius `r` (km), with its centre at the sine of elevation `sine`.
pub fn sun_share(r: f64, sine: f64) -> f64 {
    let horizon = horizon_cosine(r);
    share_of_disc((sine - horizon) / (1.0 - horizon * horizon).sqrt())
}

/// Share of the sun's disc above a line that its centre is `above`, radians.
fn share_of_disc(above: f64) -> f64 {
    if above.abs() >= SUN_ANGULAR_RADIUS {
        return f64::from(above > 0.0);
    }
    visible_fraction(above.to_degrees())
}

/// Light along a path, over the irradiance of the sun outside the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlongPath {
    /// Light scattered into the path, 1/sr.
    pub scattered: DVec4,
    /// Transmittance of the path.
    pub transmittance: DVec4,
}

/// Air between an eye and what it sees: seen = `transmittance` · radiance + `inscatter`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aerial {
    /// Transmittance of sunlight outside the air, by channel of linear BT.709 RGB.
    pub transmittance: DVec3,
    /// Light scattered on the way, linear BT.709 RGB, cd/m², not clipped.
    pub inscatter: DVec3,
}

impl Aerial {
    /// Of the transmittance of a path and the light scattered into it over the irradiance of the sun, at the four wavelengths.
    pub fn new(transmittance: DVec4, scattered: DVec4) -> Self {
        let white = rgb_from_xyz(colour::xyz(DVec4::ONE));
        Self {
            transmittance: rgb_from_xyz(colour::xyz(transmittance)) / white,
            inscatter: rgb_from_xyz(colour::xyz(scattered)),
        }
    }
}

/// A clear sky: the tables of one air.
#[derive(Clone, Debug, PartialEq)]
pub struct Atmosphere {
    /// The air.
    pub air: Air,
    /// Its coefficients.
    pub medium: Medium,
    /// Table A.
    pub columns: Arc<Columns>,
    /// Tables B and C.
    pub field: Arc<Field>,
}

impl Atmosphere {
    /// The tables of `air`, which is [`Air::clamped`] first.
    pub fn new(air: &Air) -> Self {
        Self::with(air, colour::WAVELENGTHS, &Effort::of_haze(air.aod))
    }

    /// The tables at four other wavelengths, nm, and at another effort.
    pub fn with(air: &Air, wavelengths: DVec4, effort: &Effort) -> Self {
        let air = air.clamped().0;
        let medium = Medium::new(&air, wavelengths);
        let columns = Columns::new(medium.scale_height);
        let field = solve(&medium, &columns, effort, Light::Sun);
        Self {
            air,
            medium,
            columns: Arc::new(columns),
            field: Arc::new(field),
        }
    }

    /// Distance of the observer from the centre of the earth, km.
    pub fn observer(&self) -> f64 {
        GROUND_RADIUS + self.air.altitude_m / 1000.0
    }

    /// Radiance in the unit direction `dir` with the sun (true, not refracted) in the unit direction `sun`, without its disc; linear BT.709 RGB, cd/m², not
    /// clipped. Below the horizon the ground is seen through the air before it.
    pub fn radiance(&self, sun: DVec3, dir: DVec3) -> DVec3 {
        let meets_ground = dir.y < horizon_cosine(self.observer());
        rgb_from_xyz(colour::xyz(self.transfer(
            sun.y,
            dir.y,
            sun.dot(dir).clamp(-1.0, 1.0),
            meets_ground,
        )))
    }

    /// Radiance over the sun's irradiance outside the air, at the four wavelengths.
    pub fn transfer(&self, sun_sine: f64, mu: f64, cos_gamma: f64, meets_ground: bool) -> DVec4 {
        let path = Path::new(self.observer(), mu, meets_ground);
        let cells = if meets_ground {
            GROUND_CELLS
        } else {
            VIEW_CELLS
        };
        let along = self.along(&path, sun_sine, cos_gamma, cells);
        if !meets_ground {
            return along.scattered;
        }
        let ground = path.point(path.length);
        let sine = path.sun_sine(path.length, &ground, sun_sine, cos_gamma);
        along.scattered + along.transmittance * self.ground_radiance(sine)
    }

    /// Radiance of the ground where the sun's elevation has this sine.
    pub fn ground_radiance(&self, sun_sine: f64) -> DVec4 {
        let direct = self.sun_through(GROUND_RADIUS, sun_sine) * sun_sine.max(0.0);
        (direct + self.field.ground_irradiance(sun_sine)) * (self.medium.ground_albedo / PI)
    }

    /// The same as linear BT.709 RGB, cd/m², not clipped.
    pub fn ground_rgb(&self, sun_sine: f64) -> DVec3 {
        rgb_from_xyz(colour::xyz(self.ground_radiance(sun_sine)))
    }

    /// Light along `path`, in `cells` steps.
    pub fn along(&self, path: &Path, sun_sine: f64, cos_gamma: f64, cells: usize) -> AlongPath {
        let medium = &self.medium;
        let phase = medium.aerosol_phase(cos_gamma);
        let mut depth = DVec4::ZERO;
        let mut scattered = DVec4::ZERO;
        // The ground at the feet of the observer has no air before it.
        let cells = if path.length == 0.0 { 0 } else { cells };
        for k in 0..cells {
            let cell = path.cell(k, cells);
            let point = path.point(cell.t);
            let density = densities(point.altitude, medium.scale_height);
            let own = medium.optical_depth(density) * cell.length;
            let weight = each(depth, |d| (-d).exp()) * each(own, mean_transmittance) * cell.length;
            let sine = path.sun_sine(cell.t, &point, sun_sine, cos_gamma);
            let source = self.source(&point, density, sine, cos_gamma);
            scattered += weight * (source.rest + source.aerosol * phase);
            depth += own;
        }
        AlongPath {
            scattered,
            transmittance: each(depth, |d| (-d).exp()),
        }
    }

    /// Light scattered at a point toward a direction, 1/km/sr over the irradiance of the sun; `rest` is all but the light that the aerosol
    /// scatters once, `aerosol` that over its phase function.
    fn source(&self, point: &Point, density: DVec3, sun_sine: f64, cos_gamma: f64) -> Source {
        let medium = &self.medium;
        let sun = self.sun_through(point.radius, sun_sine);
        let factors = scattering_by_degree(medium, density.x, density.y);
        let more = self
            .field
            .scattered(point.altitude, sun_sine, point.mu, cos_gamma, &factors);
        Source {
            rest: medium.rayleigh * (density.x * rayleigh_phase(cos_gamma)) * sun + more,
            aerosol: medium.aerosol_scattering() * density.y * sun,
        }
    }

    /// Transmittance from the sun to a point times the share of the disc that is seen from there.
    fn sun_through(&self, r: f64, sine: f64) -> DVec4 {
        let share = sun_share(r, sine);
        if share == 0.0 {
            return DVec4::ZERO;
        }
        let depth = self.medium.optical_depth(self.columns.to_top(r, sine));
        each(depth, |d| (-d).exp()) * share
    }

    /// Transmittance from the direction of sine `sine`, or from the horizon above it, to the observer.
    pub fn to_space(&self, sine: f64) -> DVec4 {
        let r = self.observer();
        let columns = self.columns.to_top(r, sine.max(horizon_cosine(r)));
        each(self.medium.optical_depth(columns), |d| (-d).exp())
    }

    /// The air between the observer and a point `distance_km` away in the unit direction `dir`, under the (true) sun in the unit direction `sun`. The path ends
    /// at the ground or at the top of the air if these are nearer.
    pub fn aerial(&self, sun: DVec3, dir: DVec3, distance_km: f64) -> Aerial {
        let r = self.observer();
        let meets_ground = dir.y < horizon_cosine(r);
        let whole = Path::new(r, dir.y, meets_ground).length;
        let path = Path::of_length(r, dir.y, distance_km.clamp(0.0, whole));
        let cos_gamma = sun.dot(dir).clamp(-1.0, 1.0);
        let along = self.along(&path, sun.y, cos_gamma, VIEW_CELLS);
        Aerial::new(along.transmittance, along.scattered)
    }

    /// Illuminance of the sun at normal incidence with its centre at the true elevation of sine `sun_sine`: linear BT.709 RGB, lux, by
    /// 40 wavelengths; not clipped. The part of the disc below the horizon is dark.
    pub fn sun_illuminance(&self, sun_sine: f64) -> DVec3 {
        let share = sun_share(self.observer(), sun_sine);
        if share == 0.0 {
            return DVec3::ZERO;
        }
        self.sunlight_along(sun_sine) * share
    }

    /// Transmittance of sunlight from the direction of sine `sine` (or from the horizon above it): linear BT.709 RGB over the luminance
    /// outside the air, not clipped.
    pub fn transmittance_to_space(&self, sine: f64) -> DVec3 {
        self.sunlight_along(sine) / Self::sun_outside_lux()
    }

    /// Illuminance of the sun at normal incidence outside the air, lux.
    pub fn sun_outside_lux() -> f64 {
        colour::xyz_of_all(std::iter::repeat_n(DVec4::ONE, 10)).y
    }

    /// Illuminance at normal incidence of sunlight from the direction of sine `sine`, or from the horizon above it.
    fn sunlight_along(&self, sine: f64) -> DVec3 {
        let r = self.observer();
        let mu = sine.max(horizon_cosine(r));
        let length = columns::distance_to_top(r, mu);
        let columns = columns::exact(r, mu, length, self.medium.scale_height, &SUN_NODES);
        let transmittance = colour::all_wavelengths().map(|nm| {
            let depth = Medium::new(&self.air, nm).optical_depth(columns);
            each(depth, |d| (-d).exp())
        });
        rgb_from_xyz(colour::xyz_of_all(transmittance))
    }

    /// Illuminance of the sky on a horizontal plane that faces up, with the sun at the true elevation of sine `sun_sine`: linear BT.709 RGB, lux; not
    /// clipped.
    pub fn diffuse_illuminance(&self, sun_sine: f64) -> DVec3 {
        let sun_cosine = (1.0 - sun_sine * sun_sine).max(0.0).sqrt();
        let mut sum = DVec4::ZERO;
        for (x, weight) in &*SKY_NODES {
            // Points in the square root of the elevation: the sky changes most at the horizon.
            let elevation = 0.5 * PI * x * x;
            let (mu, across) = elevation.sin_cos();
            let share = PI * x * weight * mu * across;
            let cos_gammas = SKY_NODES.iter().map(|(y, _)| {
                // More points near the sun.
                let azimuth = PI * y * y;
                (mu * sun_sine + across * sun_cosine * azimuth.cos()).clamp(-1.0, 1.0)
            });
            let ring = self.transfers(sun_sine, mu, cos_gammas, false);
            for (transfer, (y, weight)) in ring.into_iter().zip(&*SKY_NODES) {
                // Both halves.
                sum += transfer * (share * 4.0 * PI * y * weight);
            }
        }
        rgb_from_xyz(colour::xyz(sum))
    }
}

fn each(v: DVec4, f: impl Fn(f64) -> f64) -> DVec4 {
    DVec4::from_array(v.to_array().map(f))
}
