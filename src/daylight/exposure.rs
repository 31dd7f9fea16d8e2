//! Exposure: from cd/m² to the unit of the tone curves.
//!
//! EV100 is the exposure value at ISO 100: it says which luminance a camera just saturates at. Sunny 16 is EV100 15.

/// Value to which [`automatic`] brings the log-average luminance (Reinhard et al. 2002, 3.1: a = 0.36 for a high-key picture).
///
/// Middle grey, 0.18, suits a picture without a sky. In daylight the sky is a large and bright part of the average, and
/// what stands in the sun came out a stop too dark.
pub const KEY: f64 = 0.36;

/// Lagarde & de Rousiers 2014, *Moving Frostbite to PBR*, 5.1.2: luminance that maps to 1, cd/m²: 1.2 · 2^EV100.
///
/// Saturation-based sensitivity of ISO 12232, lens transmission and vignetting q = 0.65.
pub fn max_luminance(ev100: f64) -> f64 {
    1.2 * ev100.exp2()
}

/// Exposure factor, 1/(cd/m²): multiply a luminance with it to get the unit of the tone curves.
pub fn factor_from_ev100(ev100: f64) -> f64 {
    1.0 / max_luminance(ev100)
}

/// EV100 of an exposure factor in 1/(cd/m²); the inverse of [`factor_from_ev100`].
pub fn ev100_from_factor(factor: f64) -> f64 {
    (1.0 / (1.2 * factor)).log2()
}

/// Lagarde & de Rousiers 2014, 5.1.2: EV100 of a camera: aperture N (f-number), shutter time t (s), sensitivity S (ISO).
pub fn ev100_from_camera(aperture: f64, shutter_s: f64, iso: f64) -> f64 {
    (aperture * aperture / shutter_s * 100.0 / iso).log2()
}

/// Reinhard et al. 2002, eq. 1: log-average (geometric mean) of luminances, cd/m².
///
/// Non-positive and non-finite values do not count; `None` if nothing else is there.
pub fn log_average(luminances: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0u64);
    for luminance in luminances {
        if luminance > 0.0 && luminance.is_finite() {
            sum += luminance.ln();
            count += 1;
        }
    }
    (count > 0).then(|| (sum / count as f64).exp())
}

/// EV100 that exposes the log-average luminance (cd/m²) to the [`KEY`] (Reinhard et al. 2002, eq. 2).
pub fn automatic(log_average_luminance: f64) -> f64 {
    ev100_from_factor(KEY / log_average_luminance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_luminance_becomes_one() {
        for ev in [-6.0, 0.0, 9.5, 15.0, 21.0] {
            assert!((factor_from_ev100(ev) * max_luminance(ev) - 1.0).abs() < 1e-15);
            assert!((ev100_from_factor(factor_from_ev100(ev)) - ev).abs() < 1e-12);
        }
        assert_eq!(max_luminance(0.0), 1.2);
    }

    #[test]
    fn sunny_sixteen() {
        assert!((ev100_from_camera(16.0, 1.0 / 125.0, 100.0) - 15.0).abs() < 0.05);
    }

    #[test]
    fn automatic_brings_a_grey_picture_to_the_key() {
        let average = log_average([800.0, 1250.0, 0.0, f64::NAN, f64::INFINITY]);
        assert!((average.unwrap() - 1000.0).abs() < 1e-9);
        assert!((factor_from_ev100(automatic(1000.0)) * 1000.0 - KEY).abs() < 1e-15);
        assert_eq!(log_average([0.0, -1.0]), None);
    }
}
