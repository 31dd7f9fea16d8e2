//! Difference of two pictures of the same view: radiometric statistics and perceived difference (FLIP).

pub mod flip;
mod read;

pub use read::read;

use crate::error::{Error, Result};

/// Luminance weights of linear BT.709.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Lower limit of the divisor in relative errors, relative to the mean of the reference, so that black pixels do not dominate.
const DARKEST: f64 = 0.02;

/// What the values of a picture refer to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Referred {
    /// Scene-linear: proportional to radiance, not negative.
    Scene,
    /// Display-referred: linear light, 0..=1.
    Display,
}

/// A picture: linear BT.709, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Linear RGB.
    pub rgb: Vec<[f32; 3]>,
    /// What the values refer to.
    pub referred: Referred,
}

impl Picture {
    /// A picture from sRGB bytes, three per pixel.
    ///
    /// # Panics
    /// The number of bytes does not match the size.
    pub fn from_srgb8(size: [usize; 2], bytes: &[u8]) -> Self {
        assert_eq!(bytes.len(), 3 * size[0] * size[1], "bytes of the picture");
        let decoded: [f32; 256] = std::array::from_fn(|i| srgb_decoded(i as f32 / 255.0));
        let rgb = bytes
            .chunks_exact(3)
            .map(|p| [0, 1, 2].map(|i| decoded[usize::from(p[i])]))
            .collect();
        Self {
            size,
            rgb,
            referred: Referred::Display,
        }
    }

    /// Luminance of every pixel, in the picture's unit.
    pub fn luminance(&self) -> Vec<f32> {
        let dot = |p: &[f32; 3]| (0..3).map(|i| p[i] * LUMINANCE[i]).sum();
        self.rgb.iter().map(dot).collect()
    }

    /// Applies an exposure factor and clamps to 0..=1.
    #[must_use]
    pub fn exposed(&self, factor: f32) -> Self {
        let cut = |p: &[f32; 3]| p.map(|v| (v * factor).clamp(0.0, 1.0));
        Self {
            size: self.size,
            rgb: self.rgb.iter().map(cut).collect(),
            referred: Referred::Display,
        }
    }

    /// The picture where `mask` is true, black elsewhere.
    #[must_use]
    pub fn masked(&self, mask: &[bool]) -> Self {
        let keep = |(p, keep): (&[f32; 3], &bool)| if *keep { *p } else { [0.0; 3] };
        Self {
            rgb: self.rgb.iter().zip(mask).map(keep).collect(),
            ..*self
        }
    }
}

/// IEC 61966-2-1: encoded value to linear light.
fn srgb_decoded(v: f32) -> f32 {
    if v <= 0.04045 {
        v / 12.92
    } else {
        ((v + 0.055) / 1.055).powf(2.4)
    }
}

/// Checks that two pictures can be compared.
///
/// # Errors
/// Their sizes differ, or one is scene-linear and the other display-referred.
pub fn check_comparable(reference: &Picture, test: &Picture) -> Result<()> {
    let [a, b] = [reference.size, test.size];
    if a != b {
        return Err(Error::Compare(format!(
            "the pictures differ in size, {}x{} and {}x{}; render them with the same --size",
            a[0], a[1], b[0], b[1]
        )));
    }
    if reference.referred != test.referred {
        return Err(Error::Compare(
            "one picture is scene-linear, the other display-referred; compare .exr with .exr or .png with .png".to_owned(),
        ));
    }
    Ok(())
}

/// Luminance errors over the compared pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Number of pixels.
    pub pixels: usize,
    /// Mean of the test over mean of the reference.
    pub mean_ratio: f64,
    /// Root mean square difference over mean of the reference.
    pub rmse_over_mean: f64,
    /// Median of the relative errors; their divisor is at least 2 % of the reference's mean.
    pub median: f64,
    /// 95th percentile of the relative errors.
    pub p95: f64,
}

impl Statistics {
    /// Statistics of the pixels where `mask` is true.
    ///
    /// # Errors
    /// No pixel is selected, or the reference is black there.
    pub fn new(reference: &Picture, test: &Picture, mask: &[bool]) -> Result<Self> {
        let pairs: Vec<(f64, f64)> = reference
            .luminance()
            .into_iter()
            .zip(test.luminance())
            .zip(mask)
            .filter(|(_, kept)| **kept)
            .map(|((r, t), _)| (f64::from(r), f64::from(t)))
            .collect();
        let mean = |f: &dyn Fn(f64, f64) -> f64| {
            pairs.iter().map(|&(r, t)| f(r, t)).sum::<f64>() / pairs.len() as f64
        };
        let reference_mean = mean(&|r, _| r);
        if reference_mean.is_nan() || reference_mean <= 0.0 {
            return Err(Error::Compare(
                "nothing to compare: the reference is black or the mask is empty; swap the pictures or drop --mask".to_owned(),
            ));
        }
        let mut errors: Vec<f64> = pairs
            .iter()
            .map(|&(r, t)| (t - r).abs() / r.max(DARKEST * reference_mean))
            .collect();
        errors.sort_by(f64::total_cmp);
        Ok(Self {
            pixels: pairs.len(),
            mean_ratio: mean(&|_, t| t) / reference_mean,
            rmse_over_mean: mean(&|r, t| (t - r).powi(2)).sqrt() / reference_mean,
            median: quantile(&errors, 0.5),
            p95: quantile(&errors, 0.95),
        })
    }
}

/// The quantile `q` of ascending values, interpolated.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let at = (sorted.len() - 1) as f64 * q;
    let (low, high) = (at.floor() as usize, at.ceil() as usize);
    sorted[low] + (sorted[high] - sorted[low]) * at.fract()
}

/// Exposure factor that maps the 75th percentile of the luminance to 0.5.
pub fn exposure_of(reference: &Picture, mask: &[bool]) -> f32 {
    let mut luminance: Vec<f64> = reference
        .luminance()
        .into_iter()
        .zip(mask)
        .filter(|(_, kept)| **kept)
        .map(|(l, _)| f64::from(l))
        .collect();
    luminance.sort_by(f64::total_cmp);
    let bright = if luminance.is_empty() {
        0.0
    } else {
        quantile(&luminance, 0.75)
    };
    if bright > 0.0 {
        (0.5 / bright) as f32
    } else {
        1.0
    }
}

/// Erodes `mask` by one pixel: at edges the filters of two renderers differ.
pub fn eroded(size: [usize; 2], mask: &[bool]) -> Vec<bool> {
    let around = |i: usize, n: usize| i.saturating_sub(1)..=(i + 1).min(n - 1);
    let inside = |i: usize| {
        let (x, y) = (i % size[0], i / size[0]);
        around(y, size[1]).all(|y| around(x, size[0]).all(|x| mask[y * size[0] + x]))
    };
    (0..mask.len()).map(inside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(values: &[f32]) -> Picture {
        Picture {
            size: [values.len(), 1],
            rgb: values.iter().map(|v| [*v; 3]).collect(),
            referred: Referred::Scene,
        }
    }

    #[test]
    fn figures_of_known_differences() {
        let (a, b) = (grey(&[1.0, 1.0, 2.0, 4.0]), grey(&[1.1, 0.9, 2.0, 4.4]));
        let s = Statistics::new(&a, &b, &[true; 4]).expect("figures");
        assert!((s.mean_ratio - 8.4 / 8.0).abs() < 1e-6);
        let rmse = ((0.01f64 + 0.01 + 0.0 + 0.16) / 4.0).sqrt() / 2.0;
        assert!((s.rmse_over_mean - rmse).abs() < 1e-6);
        assert!((s.median - 0.1).abs() < 1e-6 && (s.p95 - 0.1).abs() < 1e-6);
        let last = Statistics::new(&a, &b, &[false, false, false, true]).expect("figures");
        assert!((last.mean_ratio - 1.1).abs() < 1e-6 && last.pixels == 1);
        assert!(Statistics::new(&a, &b, &[false; 4]).is_err());
        assert!(Statistics::new(&grey(&[0.0]), &grey(&[1.0]), &[true]).is_err());
    }

    #[test]
    fn pictures_that_do_not_belong_together_are_named() {
        let (a, b) = (grey(&[1.0, 2.0]), grey(&[1.0]));
        let text = check_comparable(&a, &b).expect_err("sizes").to_string();
        assert!(text.contains("2x1 and 1x1"), "{text}");
        let shown = Picture::from_srgb8([2, 1], &[0, 128, 255, 1, 2, 3]);
        assert!(check_comparable(&a, &shown).is_err());
        assert!((shown.rgb[0][1] - 0.215_861).abs() < 1e-5 && shown.rgb[0][2] == 1.0);
    }

    #[test]
    fn erosion_takes_the_border_of_a_mask() {
        let mut mask = vec![true; 25];
        mask[0] = false;
        let left = eroded([5, 5], &mask);
        assert_eq!(left.iter().filter(|k| !**k).count(), 4);
        assert!(!left[6] && left[7] && left[24]);
    }
}
