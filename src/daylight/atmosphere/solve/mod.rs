//! The field by orders of scattering: order n lights the air for order n + 1, and a geometric tail stands for the orders beyond the last.
//!
//! A ray's points, densities and transmittances depend on altitude and inclination alone, so they are made once for all suns and azimuths. The
//! four wavelengths are the lanes of a vector.

mod light;
mod rays;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec4;
use wide::f32x4;

use self::light::Before;
use self::rays::Directions;
use super::columns::Columns;
use super::field::{COEFFICIENTS, Field, Grid, LEAST_LN};
use super::medium::{GROUND_RADIUS, Medium};

/// How finely the field is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Sizes of the tables.
    pub grid: Grid,
    /// Inclinations (even) and azimuths over half a turn, of the first order.
    pub first_directions: [usize; 2],
    /// The same, of the further orders.
    pub directions: [usize; 2],
    /// Cells of a ray.
    pub cells: usize,
    /// Orders of scattering that are computed, at least 2.
    pub orders: usize,
}

impl Effort {
    /// What the program uses.
    pub const FULL: Self = Self {
        grid: Grid {
            altitudes: 16,
            suns: 56,
        },
        first_directions: [32, 12],
        directions: [12, 5],
        cells: 20,
        orders: 4,
    };

    /// [`Effort::FULL`] with more orders for more haze. The geometric tail alone is 6 to 60 % too bright beyond -8° at an AOD of 0.6.
    pub fn of_haze(aod: f64) -> Self {
        // At most five.
        let more = (9.0 * aod.clamp(0.0, 0.6)) as usize;
        Self {
            orders: Self::FULL.orders + more,
            ..Self::FULL
        }
    }

    /// A fortieth of the work: the spectrum is right to a hundredth of what four wavelengths make of it, the directions are not.
    pub const COARSE: Self = Self {
        grid: Grid {
            altitudes: 8,
            suns: 24,
        },
        first_directions: [10, 5],
        directions: [8, 4],
        cells: 10,
        orders: 3,
    };
}

/// Light that enters the air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// The sun, of irradiance 1.
    Sun,
    /// Radiance 1 from all of space: in air and over ground that absorb nothing, the radiance is 1 everywhere (white furnace).
    #[cfg(test)]
    Space,
}

/// A field of one order: coefficients (not their logarithm), and the irradiance of the ground.
struct Order {
    texels: Vec<[f32x4; COEFFICIENTS]>,
    ground: Vec<f32x4>,
}

/// The field of `light` in the `medium`, whose columns are `columns`.
pub fn solve(medium: &Medium, columns: &Columns, effort: &Effort, light: Light) -> Field {
    let solver = Solver {
        medium,
        effort,
        depths: columns
            .entries
            .iter()
            .map(|entry| {
                let columns = glam::Vec3::from_array(*entry).as_dvec3();
                lanes(medium.optical_depth(columns))
            })
            .collect(),
        light,
    };
    let mut last = solver.order(None, effort.first_directions);
    let mut total = last.copy();
    for n in 2..=effort.orders {
        let next = solver.order(Some(&last), effort.directions);
        total.add(&next);
        if n == effort.orders {
            total.add(&next.tail(&last));
        }
        last = next;
    }
    total.field(effort.grid)
}

impl Order {
    fn copy(&self) -> Self {
        Self {
            texels: self.texels.clone(),
            ground: self.ground.clone(),
        }
    }

    fn add(&mut self, other: &Self) {
        for (sum, term) in self.texels.iter_mut().zip(&other.texels) {
            sum.iter_mut().zip(term).for_each(|(s, t)| *s += *t);
        }
        let ground = self.ground.iter_mut().zip(&other.ground);
        ground.for_each(|(s, t)| *s += *t);
    }

    /// All orders after this one, if each is to the one before as this is to `before`.
    fn tail(&self, before: &Self) -> Self {
        let tail = |now: f32x4, before: f32x4| {
            let ratio = now / before.max(f32x4::splat(1e-37));
            let ratio = ratio.max(f32x4::ZERO).min(f32x4::splat(0.95));
            ratio / (f32x4::ONE - ratio)
        };
        let texels = self.texels.iter().zip(&before.texels).map(|(now, before)| {
            let factor = tail(now[0], before[0]);
            now.map(|c| c * factor)
        });
        let ground = self.ground.iter().zip(&before.ground);
        Self {
            texels: texels.collect(),
            ground: ground
                .map(|(now, before)| *now * tail(*now, *before))
                .collect(),
        }
    }

    /// In the form of [`Field`].
    fn field(&self, grid: Grid) -> Field {
        Field {
            grid,
            texels: self
                .texels
                .iter()
                .map(|t| logarithmic(t).map(f32x4::to_array))
                .collect(),
            ground: self.ground.iter().map(|e| ln(*e).to_array()).collect(),
        }
    }
}

fn ln(x: f32x4) -> f32x4 {
    let least = (LEAST_LN as f32).exp();
    f32x4::from(x.to_array().map(|x| x.max(least).ln()))
}

/// ln J and the other coefficients over J.
fn logarithmic(texel: &[f32x4; COEFFICIENTS]) -> [f32x4; COEFFICIENTS] {
    let least = (LEAST_LN as f32).exp();
    let mean = texel[0].max(f32x4::splat(least));
    std::array::from_fn(|c| if c == 0 { ln(mean) } else { texel[c] / mean })
}

fn lanes(v: DVec4) -> f32x4 {
    f32x4::from(v.as_vec4().to_array())
}

struct Solver<'a> {
    medium: &'a Medium,
    effort: &'a Effort,
    /// Optical depths to the top of the air, as [`Columns`] holds them.
    depths: Vec<f32x4>,
    light: Light,
}

impl Solver<'_> {
    /// The next order after `before`, or the first: all altitudes, on all cores.
    fn order(&self, before: Option<&Order>, directions: [usize; 2]) -> Order {
        let Grid { altitudes, suns } = self.effort.grid;
        let before = before.map(Before::new);
        let next = AtomicUsize::new(0);
        let done = Mutex::new(Vec::new());
        let work = || {
            loop {
                let i = next.fetch_add(1, Ordering::Relaxed);
                if i >= altitudes {
                    return;
                }
                let result = self.altitude(i, before.as_ref(), directions);
                if let Ok(mut done) = done.lock() {
                    done.push((i, result));
                }
            }
        };
        let cores = std::thread::available_parallelism().map_or(1, |n| n.get().min(8));
        std::thread::scope(|scope| {
            for _ in 1..cores {
                scope.spawn(work);
            }
            work();
        });
        let mut done = done.into_inner().unwrap_or_default();
        done.sort_unstable_by_key(|(i, _)| *i);
        let mut order = Order {
            texels: Vec::with_capacity(altitudes * suns),
            ground: Vec::new(),
        };
        for (i, (texels, irradiance)) in done {
            order.texels.extend(texels);
            if i == 0 {
                order.ground = irradiance;
            }
        }
        order
    }

    /// Coefficients by sun at altitude `i`, and the irradiance of a plane that faces up there.
    fn altitude(
        &self,
        i: usize,
        before: Option<&Before>,
        [inclinations, azimuths]: [usize; 2],
    ) -> (Vec<[f32x4; COEFFICIENTS]>, Vec<f32x4>) {
        let grid = self.effort.grid;
        let r = GROUND_RADIUS + grid.altitude(i);
        let mut texels = vec![[f32x4::ZERO; COEFFICIENTS]; grid.suns];
        let mut irradiance = vec![f32x4::ZERO; grid.suns];
        for ray in self.rays(r, inclinations) {
            let directions = Directions::new(self.medium, &ray, grid, azimuths);
            let mut light = vec![f32x4::ZERO; grid.suns * azimuths];
            match before {
                None => self.first(&ray, &directions, &mut light),
                Some(before) => self.further(&ray, &directions, before, &mut light),
            }
            let solid_angle = ray.solid_angle / azimuths as f64;
            for (j, sun) in directions.suns.iter().enumerate() {
                for (direction, light) in sun.azimuths.iter().zip(&light[j * azimuths..]) {
                    let light = *light * f32x4::splat(solid_angle as f32);
                    for (sum, value) in texels[j].iter_mut().zip(&direction.norms) {
                        *sum += light * f32x4::splat(*value);
                    }
                    irradiance[j] += light * f32x4::splat(ray.path.mu.max(0.0) as f32);
                }
            }
        }
        (texels, irradiance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::atmosphere::air::{Aerosol, Air};
    use std::f64::consts::PI;

    #[test]
    fn nothing_that_absorbs_makes_a_white_furnace() {
        // Each order loses a little where its logarithm is interpolated over altitude: the more, the denser the air.
        for (aod, altitudes) in [(0.0, 16), (0.2, 16), (0.6, 40)] {
            let air = Air {
                aod,
                ozone_du: 0.0,
                ground_albedo: 1.0,
                aerosol: Aerosol {
                    single_scattering_albedo: 1.0,
                    ..Aerosol::default()
                },
                ..Air::default()
            };
            let medium = Medium::new(&air, DVec4::new(445.0, 515.0, 565.0, 635.0));
            let columns = Columns::new(1.2);
            let effort = Effort {
                grid: Grid { altitudes, suns: 4 },
                directions: [16, 5],
                orders: 12,
                ..Effort::FULL
            };
            let field = solve(&medium, &columns, &effort, Light::Space);
            let (mut least, mut most) = (f32::MAX, 0f32);
            for texel in &field.texels {
                for ln in texel[0] {
                    (least, most) = (least.min(ln.exp()), most.max(ln.exp()));
                }
            }
            let ground = f64::from(field.ground[0][0]).exp() / PI;
            println!("AOD {aod}: mean radiance {least}..{most}, ground {ground}");
            assert!(least > 0.99 && most < 1.01 && (ground - 1.0).abs() < 0.01);
        }
    }
}
