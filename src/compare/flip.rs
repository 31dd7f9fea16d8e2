//! FLIP: the difference a viewer perceives when alternating between two pictures, per pixel, 0 (none) to 1.
//!
//! Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images", and, for scene-linear pictures, Andersson
//! et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images". Tested against the authors' `flip-evaluator`.

use std::f32::consts::PI;

use super::Picture;

/// Pixels per degree of visual angle: a display 0.7 m and 3840 pixels wide, viewed from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 3840.0 * PI / 180.0;

/// Andersson et al. 2020, Table 1: amplitude and width of the Gaussians of each channel's contrast sensitivity.
const SENSITIVITY: [&[[f32; 2]]; 3] = [
    &[[1.0, 0.0047]],
    &[[1.0, 0.0053]],
    &[[34.1, 0.04], [13.5, 0.025]],
];
/// The largest width.
const WIDEST: f32 = 0.04;
/// Exponent of the colour difference.
const Q_COLOUR: f32 = 0.7;
/// Fraction of the largest colour difference that maps to [`T_COLOUR`].
const P_COLOUR: f32 = 0.4;
/// Value that the fraction [`P_COLOUR`] maps to.
const T_COLOUR: f32 = 0.95;
/// Exponent of the difference of features.
const Q_FEATURE: f32 = 0.5;
/// Width of the feature detectors, degrees.
const FEATURE_WIDTH: f32 = 0.082;

/// Linear BT.709 to XYZ (IEC 61966-2-1), each row divided by the white point's value: white is (1, 1, 1).
const XYZ_FROM_RGB: [[f32; 3]; 3] = [
    [0.433_895_5, 0.376_242_3, 0.189_862_1],
    [0.212_636_8, 0.715_183, 0.072_180_2],
    [0.017_752_4, 0.109_465_8, 0.872_781_8],
];

/// One value per pixel.
#[derive(Clone)]
struct Plane {
    size: [usize; 2],
    values: Vec<f32>,
}

impl Plane {
    /// Convolution with the product of two kernels of odd length; border pixels are repeated.
    fn convolved(&self, across: &[f32], down: &[f32]) -> Self {
        let [width, height] = self.size;
        let mut rows = vec![0.0; width * height];
        for (row, out) in self
            .values
            .chunks_exact(width)
            .zip(rows.chunks_exact_mut(width))
        {
            convolve_row(row, across, out);
        }
        let radius = down.len() / 2;
        let mut values = vec![0.0; width * height];
        for (y, out) in values.chunks_exact_mut(width).enumerate() {
            for (k, weight) in down.iter().enumerate() {
                let from = (y + k).saturating_sub(radius).min(height - 1) * width;
                for (o, v) in out.iter_mut().zip(&rows[from..from + width]) {
                    *o += weight * v;
                }
            }
        }
        Self {
            size: self.size,
            values,
        }
    }
}

fn convolve_row(row: &[f32], kernel: &[f32], out: &mut [f32]) {
    let radius = kernel.len() / 2;
    let padded: Vec<f32> = (0..row.len() + 2 * radius)
        .map(|i| row[i.saturating_sub(radius).min(row.len() - 1)])
        .collect();
    for (o, window) in out.iter_mut().zip(padded.windows(kernel.len())) {
        *o = window.iter().zip(kernel).map(|(v, w)| v * w).sum();
    }
}

/// Samples a function at integer offsets up to `radius` on both sides.
fn kernel(radius: usize, f: impl Fn(f32) -> f32) -> Vec<f32> {
    (0..=2 * radius)
        .map(|i| f(i as f32 - radius as f32))
        .collect()
}

/// Scales the positive weights to a sum of 1 and the negative ones to −1.
fn normalised(kernel: &[f32]) -> Vec<f32> {
    let sum = |sign: f32| kernel.iter().map(|w| (w * sign).max(0.0)).sum::<f32>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    let scale = |w: &f32| if *w > 0.0 { w / positive } else { w / negative };
    kernel
        .iter()
        .map(|w| if *w == 0.0 { 0.0 } else { scale(w) })
        .collect()
}

fn xyz([r, g, b]: [f32; 3]) -> [f32; 3] {
    XYZ_FROM_RGB.map(|row| row[0] * r + row[1] * g + row[2] * b)
}

/// The inverse of [`xyz`].
fn rgb([x, y, z]: [f32; 3]) -> [f32; 3] {
    // Columns are scaled by the white point (0.950429, 1, 1.0889).
    [
        3.080_342 * x - 1.537_399 * y - 0.542_943 * z,
        -0.921_178 * x + 1.875_93 * y + 0.045_248 * z,
        0.052_881 * x - 0.204_011 * y + 1.151_13 * z,
    ]
}

/// Linear opponent space YCxCz of linear RGB.
fn opponent(colour: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = xyz(colour);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn from_opponent([luma, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (luma + 16.0) / 116.0;
    rgb([y + cx / 500.0, y, y - cz / 200.0])
}

/// CIELAB of linear RGB, with chroma scaled by lightness (the Hunt effect).
fn hunt_lab(colour: [f32; 3]) -> [f32; 3] {
    const EDGE: f32 = 6.0 / 29.0;
    let f = |t: f32| {
        if t > EDGE * EDGE * EDGE {
            t.cbrt()
        } else {
            t / (3.0 * EDGE * EDGE) + 4.0 / 29.0
        }
    };
    let [x, y, z] = xyz(colour).map(f);
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, 500.0 * (x - y) * hunt, 200.0 * (y - z) * hunt]
}

/// HyAB distance (Abasi et al. 2020): city block in lightness, Euclidean in chroma.
fn hyab(p: [f32; 3], q: [f32; 3]) -> f32 {
    (p[0] - q[0]).abs() + (p[1] - q[1]).hypot(p[2] - q[2])
}

/// Maps the colour difference to 0..=1; large differences are compressed.
fn redistributed(power: f32, largest: f32) -> f32 {
    let knee = P_COLOUR * largest;
    if power < knee {
        T_COLOUR / knee * power
    } else {
        T_COLOUR + (power - knee) / (largest - knee) * (1.0 - T_COLOUR)
    }
}

/// Filters each channel by its contrast sensitivity; returns CIELAB with the Hunt effect.
fn perceived(channels: &[Plane; 3]) -> Vec<[f32; 3]> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
    let filtered: [Vec<f32>; 3] =
        std::array::from_fn(|i| filtered(&channels[i], SENSITIVITY[i], radius));
    (0..filtered[0].len())
        .map(|i| {
            let colour = from_opponent([filtered[0][i], filtered[1][i], filtered[2][i]]);
            hunt_lab(colour.map(|v| v.clamp(0.0, 1.0)))
        })
        .collect()
}

/// Filters a plane with a normalised sum of Gaussians.
fn filtered(plane: &Plane, gaussians: &[[f32; 2]], radius: usize) -> Vec<f32> {
    let shapes = gaussians.iter().map(|[amplitude, width]| {
        let at = |x: f32| (-(PI * x / PIXELS_PER_DEGREE).powi(2) / width).exp();
        let weights = kernel(radius, at);
        let sum: f32 = weights.iter().sum();
        (weights, amplitude * (PI / width).sqrt(), sum)
    });
    let shapes: Vec<_> = shapes.collect();
    let total: f32 = shapes.iter().map(|(_, scale, sum)| scale * sum * sum).sum();
    let mut result = vec![0.0; plane.values.len()];
    for (weights, scale, _) in &shapes {
        let part = plane.convolved(weights, weights);
        for (r, v) in result.iter_mut().zip(part.values) {
            *r += v * scale / total;
        }
    }
    result
}

/// Magnitudes of edges and of points at each pixel.
fn features(luma: &Plane) -> Vec<[f32; 2]> {
    let deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as usize;
    let gauss = |x: f32| (-x * x / (2.0 * deviation * deviation)).exp();
    let smooth = normalised(&kernel(radius, gauss));
    let edge = normalised(&kernel(radius, |x| -x * gauss(x)));
    let point = normalised(&kernel(radius, |x| {
        (x * x / (deviation * deviation) - 1.0) * gauss(x)
    }));
    let magnitude = |k: &[f32]| {
        let (across, down) = (luma.convolved(k, &smooth), luma.convolved(&smooth, k));
        let pairs = across.values.into_iter().zip(down.values);
        pairs.map(|(x, y)| x.hypot(y)).collect::<Vec<f32>>()
    };
    magnitude(&edge)
        .into_iter()
        .zip(magnitude(&point))
        .map(|(e, p)| [e, p])
        .collect()
}

/// A picture prepared for the metric.
struct Seen {
    colours: Vec<[f32; 3]>,
    features: Vec<[f32; 2]>,
}

impl Seen {
    /// Prepares a display-referred picture, clamped to 0..=1.
    fn new(picture: &Picture) -> Self {
        let cut = |p: &[f32; 3]| opponent(p.map(|v| v.clamp(0.0, 1.0)));
        let colours: Vec<[f32; 3]> = picture.rgb.iter().map(cut).collect();
        let channels = [0, 1, 2].map(|i| Plane {
            size: picture.size,
            values: colours.iter().map(|c| c[i]).collect(),
        });
        let mut luma = channels[0].clone();
        for v in &mut luma.values {
            *v = (*v + 16.0) / 116.0;
        }
        Self {
            colours: perceived(&channels),
            features: features(&luma),
        }
    }
}

/// LDR-FLIP of two display-referred pictures of one size, per pixel, 0..=1.
pub fn ldr(reference: &Picture, test: &Picture) -> Vec<f32> {
    let (a, b) = (Seen::new(reference), Seen::new(test));
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(hunt_lab);
    let largest = hyab(green, blue).powf(Q_COLOUR);
    let feature = |p: [f32; 2], q: [f32; 2]| {
        let strongest = (p[0] - q[0]).abs().max((p[1] - q[1]).abs());
        (strongest / std::f32::consts::SQRT_2).powf(Q_FEATURE)
    };
    (0..a.colours.len())
        .map(|i| {
            let colour = redistributed(hyab(a.colours[i], b.colours[i]).powf(Q_COLOUR), largest);
            colour.powf(1.0 - feature(a.features[i], b.features[i]).min(1.0))
        })
        .collect()
}

/// Coefficients of the tone curve: Narkowicz' fit of ACES with its input scaled by 0.6.
const CURVE: [f32; 6] = [
    0.6 * 0.6 * 2.51,
    0.6 * 0.03,
    0.0,
    0.6 * 0.6 * 2.43,
    0.6 * 0.59,
    0.14,
];

fn tone(x: f32) -> f32 {
    let [a, b, c, d, e, f] = CURVE;
    (((a * x + b) * x + c) / ((d * x + e) * x + f)).clamp(0.0, 1.0)
}

/// Exposures of HDR-FLIP: first and last in stops (brightest and median luminance of the reference near white), and their number.
///
/// Andersson et al. 2021, section 3.
pub fn exposures(reference: &Picture) -> (f32, f32, usize) {
    const BRIGHT: f32 = 0.85;
    let [a, b, c] = [0, 1, 2].map(|i| CURVE[i] - BRIGHT * CURVE[i + 3]);
    let half = -0.5 * b / a;
    let white = half + (half * half - c / a).sqrt();
    let mut luminance = reference.luminance();
    luminance.sort_by(f32::total_cmp);
    let n = luminance.len();
    let middle = 0.5 * (luminance[(n - 1) / 2] + luminance[n / 2]);
    let stops = |y: f32| (white / y.max(1e-5)).log2();
    let (start, stop) = (stops(luminance[n - 1]), stops(middle));
    (start, stop, ((stop - start).ceil() as usize).max(2))
}

/// HDR-FLIP of two scene-linear pictures of one size, per pixel: the maximum over [`exposures`].
pub fn hdr(reference: &Picture, test: &Picture) -> Vec<f32> {
    let (start, stop, count) = exposures(reference);
    let mut worst = vec![0.0f32; reference.rgb.len()];
    for i in 0..count {
        let stops = start + (stop - start) * i as f32 / (count - 1) as f32;
        let shown = |p: &Picture| {
            let mut p = p.clone();
            for v in p.rgb.as_flattened_mut() {
                *v = tone(v.max(0.0) * stops.exp2());
            }
            p
        };
        for (w, f) in worst.iter_mut().zip(ldr(&shown(reference), &shown(test))) {
            *w = w.max(f);
        }
    }
    worst
}

/// Mean of a FLIP map.
pub fn mean(map: &[f32]) -> f64 {
    map.iter().map(|v| f64::from(*v)).sum::<f64>() / map.len() as f64
}

#[cfg(test)]
mod tests {
    use super::super::Referred;
    use super::*;

    const SIZE: [usize; 2] = [96, 64];

    fn pattern(shift: f64, scale: impl Fn(f64) -> f64, referred: Referred) -> Picture {
        let rgb = (0..SIZE[0] * SIZE[1]).map(|i| {
            let (x, y) = ((i % SIZE[0]) as f64, (i / SIZE[0]) as f64);
            let checker = f64::from((i % SIZE[0] / 8 + i / SIZE[0] / 8) as u32 % 2);
            [
                0.5 + 0.5 * (0.21 * x + 0.05 * y + shift).sin(),
                0.5 + 0.5 * (0.07 * x - 0.13 * y + 2.0 * shift).sin(),
                checker * (0.6 + 0.1 * shift) + 0.2,
            ]
            .map(|v| (v * scale(x)) as f32)
        });
        Picture {
            size: SIZE,
            rgb: rgb.collect(),
            referred,
        }
    }

    fn check(map: &[f32], mean_wanted: f64, texels: [f32; 3]) {
        let found = mean(map);
        println!("mean {found:.7}, wanted {mean_wanted:.7}");
        assert!((found - mean_wanted).abs() < 1e-4, "{found}");
        for ((x, y), wanted) in [(20, 10), (0, 0), (70, 40)].into_iter().zip(texels) {
            let value = map[y * SIZE[0] + x];
            assert!((value - wanted).abs() < 5e-4, "{x} {y}: {value} {wanted}");
        }
    }

    // Results of the authors' program for the same pictures (flip-evaluator 1.7 from PyPI, 67.0206 pixels per degree).
    #[test]
    fn display_referred_pictures_as_the_authors_program_has_them() {
        let [a, b] = [0.0, 0.3].map(|s| pattern(s, |_| 1.0, Referred::Display));
        check(
            &ldr(&a, &b),
            0.617_466_2,
            [0.694_372_65, 0.717_905, 0.778_121_95],
        );
    }

    #[test]
    fn scene_linear_pictures_as_the_authors_program_has_them() {
        let scale = |x: f64| (0.06 * x).exp() * 100.0;
        let [a, b] = [0.0, 0.3].map(|s| pattern(s, scale, Referred::Scene));
        let (start, stop, count) = exposures(&a);
        assert!((start + 13.617_021).abs() < 1e-3 && (stop + 8.536_819).abs() < 1e-3);
        assert_eq!(count, 6);
        check(
            &hdr(&a, &b),
            0.589_576_6,
            [0.527_510_34, 0.503_42, 0.703_150_7],
        );
    }

    #[test]
    fn equal_pictures_do_not_differ_and_black_and_white_differ_most() {
        let a = pattern(0.0, |_| 1.0, Referred::Display);
        assert!(ldr(&a, &a).iter().all(|v| *v == 0.0));
        let flat = |v: f32| Picture {
            rgb: vec![[v; 3]; SIZE[0] * SIZE[1]],
            ..a.clone()
        };
        let value = mean(&ldr(&flat(0.0), &flat(1.0)));
        assert!((0.95..=1.0).contains(&value), "{value}");
    }
}
