//! Light that was scattered at least once, everywhere in the air: the tables B (field) and C (irradiance of the ground).
//!
//! At each altitude and elevation of the sun the radiance L around a point is kept as a polynomial of degree 2 of the direction, even about the
//! plane of the sun, and the moments of degree 3..6 about the direction of the sun. The basis is (1, z, x, 3z² - 1, xz, x² - y²) with z up and x
//! horizontal toward the sun, then P_3..P_6 of the cosine with the sun. The first coefficient is the mean radiance J. The table holds ln J and
//! the others over J: light falls by orders of magnitude after sunset, along straight lines in the logarithm.

use std::f64::consts::PI;

use glam::DVec4;

use super::medium::{Medium, RAYLEIGH_MOMENTS, THICKNESS};

/// Coefficients of the field at a point.
pub const COEFFICIENTS: usize = 10;
/// The lowest logarithm that is kept: e^-50 of the sun's irradiance is far darker than any night.
pub const LEAST_LN: f64 = -50.0;
/// Sine of the lowest elevation of the sun in the table, -21.1°; the light that is left below it is far less than the night's.
pub const LEAST_SUN: f64 = -0.36;
/// Sine of the elevation of the sun above which the table is coarser, 10.1°.
pub const HIGH_SUN: f64 = 0.175;
/// Slope of the grid at [`HIGH_SUN`] over its mean above.
pub const HIGH_SLOPE: f64 = 0.25;

/// Sizes of the tables of the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Altitudes 120 v² km, v uniform in 0..=1.
    pub altitudes: usize,
    /// Elevations of the sun.
    pub suns: usize,
}

impl Grid {
    /// Altitude of row `i`, km.
    pub fn altitude(&self, i: usize) -> f64 {
        let v = i as f64 / (self.altitudes - 1) as f64;
        THICKNESS * v * v
    }

    /// Row of an altitude in km, fractional.
    pub fn row(&self, altitude: f64) -> f64 {
        (altitude / THICKNESS).clamp(0.0, 1.0).sqrt() * (self.altitudes - 1) as f64
    }

    /// Steps between elevations below [`HIGH_SUN`].
    pub fn low_steps(&self) -> usize {
        (self.suns - 1) * 3 / 4
    }

    /// Sine of the sun's elevation in column `j`.
    pub fn sun_sine(&self, j: usize) -> f64 {
        let low = self.low_steps();
        if j <= low {
            return LEAST_SUN + (HIGH_SUN - LEAST_SUN) * j as f64 / low as f64;
        }
        let x = (j - low) as f64 / (self.suns - 1 - low) as f64;
        HIGH_SUN + (1.0 - HIGH_SUN) * x * (HIGH_SLOPE + (1.0 - HIGH_SLOPE) * x)
    }

    /// Column of the sine of the sun's elevation, fractional, in the table.
    pub fn column(&self, sun_sine: f64) -> f64 {
        let low = self.low_steps() as f64;
        if sun_sine <= HIGH_SUN {
            return low * ((sun_sine - LEAST_SUN) / (HIGH_SUN - LEAST_SUN)).max(0.0);
        }
        let y = ((sun_sine - HIGH_SUN) / (1.0 - HIGH_SUN)).min(1.0);
        let bend = 1.0 - HIGH_SLOPE;
        let x = 2.0 * y / (HIGH_SLOPE + (HIGH_SLOPE * HIGH_SLOPE + 4.0 * bend * y).sqrt());
        low + (self.suns - 1) as f64 * x - low * x
    }
}

/// Legendre's polynomials of degree 3..6.
pub fn legendre_3_to_6(c: f64) -> [f64; 4] {
    let square = c * c;
    let p3 = c * (2.5 * square - 1.5);
    let p4 = (square * (35.0 * square - 30.0) + 3.0) / 8.0;
    let p5 = c * (square * (63.0 * square - 70.0) + 15.0) / 8.0;
    let p6 = (square * (square * (231.0 * square - 315.0) + 105.0) - 5.0) / 16.0;
    [p3, p4, p5, p6]
}

/// The basis of degree 1 and 2 in the direction with the sine of elevation `z` and the cosine `cos_gamma` to a sun at `sun_sine`.
pub fn basis(z: f64, sun_sine: f64, cos_gamma: f64) -> [f64; 5] {
    let sun_cosine = (1.0 - sun_sine * sun_sine).max(0.0).sqrt();
    let horizontal = (1.0 - z * z).max(0.0).sqrt();
    let x = ((cos_gamma - z * sun_sine) / sun_cosine.max(1e-6)).clamp(-horizontal, horizontal);
    polynomials_2(z, x)
}

/// The basis of degree 1 and 2 in the direction with the components `z` up and `x` toward the sun's azimuth.
pub fn polynomials_2(z: f64, x: f64) -> [f64; 5] {
    let square = z * z;
    [z, x, 3.0 * square - 1.0, x * z, 2.0 * x * x + square - 1.0]
}

/// Norms: coefficient = norm · ∫ L basis dω, of the basis and of P_3..P_6.
pub const NORMS: [f64; COEFFICIENTS] = [
    1.0 / (4.0 * PI),
    3.0 / (4.0 * PI),
    3.0 / (4.0 * PI),
    5.0 / (16.0 * PI),
    15.0 / (4.0 * PI),
    15.0 / (16.0 * PI),
    7.0 / (4.0 * PI),
    9.0 / (4.0 * PI),
    11.0 / (4.0 * PI),
    13.0 / (4.0 * PI),
];

/// Degree of each coefficient.
pub const DEGREES: [usize; COEFFICIENTS] = [0, 1, 1, 2, 2, 2, 3, 4, 5, 6];

/// What scattering makes of each degree: Σ over air and aerosol of density · scattering · moment of the phase function, 1/km.
pub fn scattering_by_degree(medium: &Medium, air: f64, aerosol: f64) -> [DVec4; 7] {
    let aerosol = medium.aerosol_scattering() * aerosol;
    std::array::from_fn(|l| {
        let air = medium.rayleigh * (air * RAYLEIGH_MOMENTS.get(l).copied().unwrap_or(0.0));
        air + aerosol * medium.asymmetry.powi(l as i32)
    })
}

/// The tables B and C: the field and the irradiance of the ground, over the irradiance of the sun outside the air, at four wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Sizes.
    pub grid: Grid,
    /// Rows of altitude by columns of the sun: ln J, then coefficients over J.
    pub texels: Vec<[[f32; 4]; COEFFICIENTS]>,
    /// ln of the irradiance of the ground by scattered light, by column of the sun.
    pub ground: Vec<[f32; 4]>,
}

impl Field {
    /// Light scattered once more toward a direction, 1/(km sr): the field at `altitude` km under a sun of `sun_sine`, seen along the direction of
    /// sine `z` and cosine `cos_gamma` to the sun, by the [`scattering_by_degree`] there.
    pub fn scattered(
        &self,
        altitude: f64,
        sun_sine: f64,
        z: f64,
        cos_gamma: f64,
        scattering: &[DVec4; 7],
    ) -> DVec4 {
        let (row, column) = (self.grid.row(altitude), self.grid.column(sun_sine));
        let i = (row as usize).min(self.grid.altitudes - 2);
        let j = (column as usize).min(self.grid.suns - 2);
        let (fi, fj) = (row - i as f64, column - j as f64);
        let texel = |i: usize, j: usize| &self.texels[i * self.grid.suns + j];
        let corners = [
            (texel(i, j), (1.0 - fi) * (1.0 - fj)),
            (texel(i, j + 1), (1.0 - fi) * fj),
            (texel(i + 1, j), fi * (1.0 - fj)),
            (texel(i + 1, j + 1), fi * fj),
        ];
        let coefficient =
            |c: usize| -> DVec4 { corners.iter().map(|(t, w)| wide(t[c]) * *w).sum() };
        let [z, x, zz, xz, xx] = basis(z, sun_sine, cos_gamma);
        let polynomials = legendre_3_to_6(cos_gamma);
        let values = [z, x, zz, xz, xx]
            .into_iter()
            .chain(polynomials)
            .zip(1..COEFFICIENTS);
        let mut sum = scattering[0];
        for (value, c) in values {
            sum += scattering[DEGREES[c]] * coefficient(c) * value;
        }
        let mean = DVec4::from_array(coefficient(0).to_array().map(f64::exp));
        // A polynomial can dip below 0 where the light is all on one side.
        (mean * sum).max(DVec4::ZERO)
    }

    /// The field at `altitude` km, scattered there by `scattering`.
    pub fn level(&self, altitude: f64, scattering: [DVec4; 7]) -> Level<'_> {
        let row = self.grid.row(altitude);
        let i = (row as usize).min(self.grid.altitudes - 2);
        let at = Row {
            texels: [i, i + 1].map(|i| &self.texels[i * self.grid.suns..][..self.grid.suns]),
            share: row - i as f64,
            scattering,
        };
        Level {
            grid: self.grid,
            at,
            columns: None,
        }
    }

    /// Irradiance of the ground by scattered light where the sun is at `sun_sine`.
    pub fn ground_irradiance(&self, sun_sine: f64) -> DVec4 {
        let column = self.grid.column(sun_sine);
        let j = (column as usize).min(self.grid.suns - 2);
        let [low, high] = [wide(self.ground[j]), wide(self.ground[j + 1])];
        let ln = low.lerp(high, column - j as f64);
        DVec4::from_array(ln.to_array().map(f64::exp))
    }
}

/// [`Field::scattered`] at one altitude, for suns whose elevations differ little.
#[derive(Clone, Debug)]
pub struct Level<'t> {
    grid: Grid,
    at: Row<'t>,
    /// The column of the last sun, and what it and the next one hold here.
    columns: Option<(usize, [[DVec4; COEFFICIENTS]; 2])>,
}

impl Level<'_> {
    /// As [`Field::scattered`], in a direction with the first polynomials `low` ([`basis`]) and the others `high` ([`legendre_3_to_6`]).
    pub fn scattered(&mut self, sun_sine: f64, low: &[f64; 5], high: &[f64; 4]) -> DVec4 {
        let column = self.grid.column(sun_sine);
        let j = (column as usize).min(self.grid.suns - 2);
        let at = &self.at;
        let (_, [a, b]) = match &mut self.columns {
            Some(known) if known.0 == j => known,
            other => other.insert((j, [at.column(j), at.column(j + 1)])),
        };
        let share = column - j as f64;
        let sum = |of: &[DVec4; COEFFICIENTS]| {
            let values = low.iter().chain(high).zip(&of[1..]);
            values.fold(at.scattering[0], |sum, (value, c)| sum + *c * *value)
        };
        let (sum, ln) = (sum(a).lerp(sum(b), share), a[0].lerp(b[0], share));
        (DVec4::from_array(ln.to_array().map(f64::exp)) * sum).max(DVec4::ZERO)
    }
}

/// Two rows of the table and what is scattered between them.
#[derive(Clone, Debug)]
struct Row<'t> {
    texels: [&'t [[[f32; 4]; COEFFICIENTS]]; 2],
    /// Share of the second row.
    share: f64,
    scattering: [DVec4; 7],
}

impl Row<'_> {
    /// ln J in column `j`, then the other coefficients, scattered.
    fn column(&self, j: usize) -> [DVec4; COEFFICIENTS] {
        let [low, high] = self.texels.map(|row| &row[j]);
        std::array::from_fn(|c| {
            let here = wide(low[c]).lerp(wide(high[c]), self.share);
            if c == 0 {
                here
            } else {
                here * self.scattering[DEGREES[c]]
            }
        })
    }
}

fn wide(texel: [f32; 4]) -> DVec4 {
    DVec4::from_array(texel.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::quadrature::SphereQuadrature;

    const GRID: Grid = Grid {
        altitudes: 16,
        suns: 56,
    };

    #[test]
    fn columns_of_the_grid_are_found_again() {
        for j in 0..GRID.suns {
            assert!(
                (GRID.column(GRID.sun_sine(j)) - j as f64).abs() < 1e-9,
                "{j}"
            );
        }
        for i in 0..GRID.altitudes {
            assert!((GRID.row(GRID.altitude(i)) - i as f64).abs() < 1e-9, "{i}");
        }
        assert_eq!(GRID.column(-1.0), 0.0);
    }

    #[test]
    fn the_basis_is_orthogonal_and_the_norms_are_its_own() {
        let sun_sine = 0.37f64;
        let sun = glam::DVec3::new((1.0 - sun_sine * sun_sine).sqrt(), sun_sine, 0.0);
        let values = |dir: glam::DVec3| -> Vec<f64> {
            let c = dir.dot(sun);
            let low = basis(dir.y, sun_sine, c);
            let high = legendre_3_to_6(c);
            std::iter::once(1.0).chain(low).chain(high).collect()
        };
        let sphere = SphereQuadrature::sphere(24, 48);
        for a in 0..COEFFICIENTS {
            for b in 0..COEFFICIENTS {
                let product = sphere.integrate(|dir| {
                    let values = values(dir);
                    glam::DVec3::splat(values[a] * values[b])
                });
                let expected = f64::from(u8::from(a == b));
                assert!(
                    (product.x * NORMS[a] - expected).abs() < 1e-9,
                    "{a} {b} {product}"
                );
            }
        }
    }
}
