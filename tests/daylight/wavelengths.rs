//! Four wavelengths stand for 40: the fit of their matrix, and its error for airs that the fit has not seen.
//!
//! A sample is a direction of a sky of a random air, solved at all 40 wavelengths.

#![allow(clippy::unwrap_used)]

use crate::common::at_share;
use glam::{DMat4, DVec3, DVec4};
use skylight::daylight::atmosphere::air::{Aerosol, Air};
use skylight::daylight::atmosphere::colour::{WAVELENGTHS, XYZ, all_wavelengths, xyz, xyz_of_all};
use skylight::daylight::atmosphere::columns::horizon_cosine;
use skylight::daylight::atmosphere::{Atmosphere, solve::Effort};

/// Airs of the fit.
const FITTED: usize = 48;
/// Elevations of the sun, degrees.
const SUNS: [f64; 14] = [
    88.0, 60.0, 35.0, 20.0, 10.0, 5.0, 2.0, 0.0, -2.0, -4.0, -6.0, -8.0, -10.0, -12.0,
];
/// Directions for each sun.
const DIRECTIONS: usize = 6;

struct Sample {
    transfer: [f64; 40],
    xyz: DVec3,
    sun: f64,
}

/// Number `i` of Roberts's sequence in dimension `d` of 8, in 0..1.
fn quasi_random(i: usize, d: i32) -> f64 {
    // The root of x^9 = x + 1.
    const BASE: f64 = 1.085_070_245_491_450_8;
    (0.5 + (i as f64 + 1.0) * BASE.powi(-d - 1)).fract()
}

/// Air number `i`: every number anywhere in a wide part of its range.
fn random_air(i: usize) -> Air {
    let between = |d: i32, low: f64, high: f64| low + (high - low) * quasi_random(i, d);
    Air {
        aod: between(0, 0.0, 0.77).powi(2),
        ozone_du: between(1, 0.0, 550.0),
        altitude_m: between(2, 0.0, 2.0).powi(2) * 2000.0,
        ground_albedo: between(3, 0.0, 1.0),
        aerosol: Aerosol {
            single_scattering_albedo: between(4, 0.8, 1.0),
            asymmetry: between(5, 0.5, 0.85),
            scale_height_km: between(6, 0.6, 4.0),
            angstrom: between(7, 0.0, 2.2),
        },
    }
}

/// Spectra of directions under all [`SUNS`] in air number `i`.
fn samples(i: usize) -> Vec<Sample> {
    let air = random_air(i);
    let skies: Vec<_> = all_wavelengths()
        .map(|nm| Atmosphere::with(&air, nm, &Effort::COARSE))
        .collect();
    let horizon = horizon_cosine(skies[0].observer()).asin();
    let mut samples = Vec::new();
    for (k, sun) in SUNS.iter().enumerate() {
        for d in 0..DIRECTIONS {
            let at = |dimension| quasi_random(i * 1000 + k * DIRECTIONS + d, dimension);
            let above = at(0) * 1.1 - 0.1;
            let reach = if above < 0.0 { 1.0 } else { 1.5 };
            let mu = (horizon + reach * above * above.abs()).sin();
            let sine = sun.to_radians().sin();
            let across = ((1.0 - mu * mu) * (1.0 - sine * sine)).sqrt();
            let cos_gamma = mu * sine + across * (std::f64::consts::PI * at(1) * at(1)).cos();
            let four = skies
                .iter()
                .map(|sky| sky.transfer(sine, mu, cos_gamma, above < 0.0));
            let four: Vec<DVec4> = four.collect();
            let transfer: Vec<f64> = four.iter().flat_map(|v| v.to_array()).collect();
            samples.push(Sample {
                transfer: transfer.try_into().unwrap(),
                xyz: xyz_of_all(four.into_iter()),
                sun: *sun,
            });
        }
    }
    samples.retain(|sample| sample.xyz.y > 0.0);
    samples
}

/// u', v' of CIE 1976.
fn chromaticity(xyz: DVec3) -> [f64; 2] {
    let sum = xyz.x + 15.0 * xyz.y + 3.0 * xyz.z;
    [4.0 * xyz.x / sum, 9.0 * xyz.y / sum]
}

/// Prints errors of luminance and of u'v' (median, 95 %, largest) and returns those of 95 %.
fn errors(name: &str, samples: &[&Sample], model: impl Fn(&[f64; 40]) -> DVec3) -> [f64; 2] {
    let pairs = samples.iter().map(|s| (model(&s.transfer), s.xyz));
    let (mut luminance, mut colour): (Vec<f64>, Vec<f64>) = pairs
        .map(|(found, expected)| {
            let ([u, v], [u0, v0]) = (chromaticity(found), chromaticity(expected));
            ((found.y / expected.y - 1.0).abs(), (u - u0).hypot(v - v0))
        })
        .unzip();
    let shares = [0.5, 0.95, 1.0];
    let l = shares.map(|share| at_share(&mut luminance, share));
    let c = shares.map(|share| at_share(&mut colour, share));
    println!(
        "{name}: {} samples, luminance {:.2} {:.2} {:.2} %, u'v' {:.4} {:.4} {:.4}",
        samples.len(),
        100.0 * l[0],
        100.0 * l[1],
        100.0 * l[2],
        c[0],
        c[1],
        c[2]
    );
    [l[1], c[1]]
}

/// Index of a wavelength among the 40.
fn index_of(nm: f64) -> usize {
    all_wavelengths()
        .flat_map(|four| four.to_array())
        .position(|each| each == nm)
        .unwrap()
}

fn four_of(transfer: &[f64; 40], indices: [usize; 4]) -> DVec4 {
    DVec4::from_array(indices.map(|i| transfer[i]))
}

#[test]
fn four_wavelengths_stand_for_forty_in_airs_that_were_not_fitted() {
    let indices = WAVELENGTHS.to_array().map(index_of);
    let samples: Vec<Sample> = (0..3).flat_map(|i| samples(FITTED + 5 * i)).collect();
    let groups = [
        ("day", 1.0, 90.0, [0.005, 0.002]),
        ("dusk", -6.0, 1.0, [0.005, 0.002]),
        ("night", -12.0, -6.0, [0.01, 0.003]),
    ];
    for (name, low, high, most) in groups {
        let group: Vec<&Sample> = samples
            .iter()
            .filter(|s| s.sun > low && s.sun <= high)
            .collect();
        let [luminance, colour] = errors(name, &group, |t| xyz(four_of(t, indices)));
        assert!(luminance < most[0] && colour < most[1], "{name}");
    }
}

/// The normal equations of a least-squares fit of XYZ by the 40 transfers, over the brightness of each sample.
struct Normal {
    gram: [[f64; 40]; 40],
    right: [DVec3; 40],
}

impl Normal {
    fn new(samples: &[Sample]) -> Self {
        let mut normal = Self {
            gram: [[0.0; 40]; 40],
            right: [DVec3::ZERO; 40],
        };
        for sample in samples {
            let brightness = sample.xyz.element_sum() / 3.0;
            let t = sample.transfer.map(|t| t / brightness);
            for i in 0..40 {
                normal.right[i] += sample.xyz * (t[i] / brightness);
                for j in 0..40 {
                    normal.gram[i][j] += t[i] * t[j];
                }
            }
        }
        normal
    }

    /// The matrix of four wavelengths, and how much it takes off the sum of squares.
    fn fit(&self, indices: [usize; 4]) -> ([DVec3; 4], f64) {
        let gram = DMat4::from_cols_array_2d(&indices.map(|i| indices.map(|j| self.gram[i][j])));
        let inverse = gram.inverse();
        let channel = |c: usize| {
            let right = DVec4::from_array(indices.map(|i| self.right[i][c]));
            let rows = inverse * right;
            (rows, rows.dot(right))
        };
        let channels = [0, 1, 2].map(channel);
        let rows = |i: usize| DVec3::new(channels[0].0[i], channels[1].0[i], channels[2].0[i]);
        let gain = channels.iter().map(|(_, gain)| gain).sum();
        ([rows(0), rows(1), rows(2), rows(3)], gain)
    }
}

/// How the constants of `atmosphere::colour` were made: run it with `--ignored --nocapture`.
#[test]
#[ignore = "prints the constants"]
fn fit_of_the_wavelengths() {
    let samples: Vec<Sample> = (0..FITTED).flat_map(samples).collect();
    let normal = Normal::new(&samples);
    let all: Vec<&Sample> = samples.iter().collect();
    let mut best = (f64::NEG_INFINITY, [0; 4]);
    for a in 0..37 {
        for b in a + 1..38 {
            for c in b + 1..39 {
                for d in c + 1..40 {
                    let (_, gain) = normal.fit([a, b, c, d]);
                    if gain > best.0 {
                        best = (gain, [a, b, c, d]);
                    }
                }
            }
        }
    }
    for indices in [best.1, WAVELENGTHS.to_array().map(index_of)] {
        let (matrix, gain) = normal.fit(indices);
        println!("{:?} nm, gain {gain}", indices.map(|i| 385 + 10 * i));
        matrix
            .iter()
            .for_each(|row| println!("    DVec3::new({:.1}, {:.1}, {:.1}),", row.x, row.y, row.z));
        let model = |t: &[f64; 40]| {
            four_of(t, indices)
                .to_array()
                .iter()
                .zip(matrix)
                .map(|(t, m)| m * *t)
                .sum()
        };
        errors("fitted", &all, model);
        println!("sun outside the air: {}", matrix.iter().sum::<DVec3>());
    }
    errors("constants in use", &all, |t| {
        xyz(four_of(t, WAVELENGTHS.to_array().map(index_of)))
    });
    println!("sun outside the air: {}", XYZ.iter().sum::<DVec3>());
}
