//! Exposure: from cd/m² to the unit of the tone curves.
//!
//! EV100 is the exposure value at ISO 100: it sets the luminance at which a camera saturates. Sunny 16 is EV100 15.

/// Target of [`automatic`] for the log-average luminance (Reinhard et al. 2002, 3.1: a = 0.36 for a high-key picture).
///
/// Middle grey, 0.18, suits a picture without a sky. In daylight the sky is a large and bright part of the average, which
/// made sunlit surfaces a stop too dark.
pub const KEY: f64 = 0.36;

/// Lagarde & de Rousiers 2014, *Moving Frostbite to PBR*, 5.1.2: the luminance that maps to 1, 1.2 · 2^EV100 cd/m².
///
/// Assumes the saturation-based sensitivity of ISO 12232, with q = 0.65 for lens transmission and vignetting.
pub fn max_luminance(ev100: f64) -> f64 {
    1.2 * ev100.exp2()
}

/// Exposure factor, 1/(cd/m²): a luminance times this factor is in the unit of the tone curves.
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

/// Luminance below which a pixel counts as black and is ignored, cd/m²: the smallest step of a half float in kcd/m².
pub const BLACK: f64 = 1e3 / (1 << 24) as f64;
/// Resolution of the histogram for the median, bins per stop.
pub const BINS_PER_STOP: f64 = 4.0;
/// Largest distance of a pixel from the median, stops; farther pixels are clamped.
pub const BOUND: f64 = 4.0;
/// Distance beyond [`BOUND`], toward black, over which a pixel's weight goes from 1 to 0, stops.
pub const FADE: f64 = 4.0;
/// Number of histogram bins: 64 stops from [`BLACK`] up.
const BINS: usize = 256;

/// Metered luminance of automatic exposure, from luminances in cd/m²: Reinhard et al. 2002, eq. 1 (log average, the geometric
/// mean), made robust as a Huber (1964) location estimate: each pixel is clamped to [`BOUND`] stops around the median.
///
/// So the sun's disc or a lamp affects the exposure only by its area. Below the lower bound a pixel's weight fades to 0 over
/// [`FADE`] stops, since black says nothing about the light. If no pixel reaches a bound, the result is the log average.
/// `None` if every pixel is black or NaN.
pub fn robust_log_average(luminances: &[f64]) -> Option<f64> {
    let is_counted = |l: &&f64| **l >= BLACK;
    let logs = || {
        luminances
            .iter()
            .filter(is_counted)
            .map(|l| l.min(1e33).log2())
    };
    let median = median(logs())?;
    let (mut sum, mut weights) = (0.0, 0.0);
    for distance in logs().map(|log| log - median) {
        let weight = ((distance + BOUND) / FADE + 1.0).clamp(0.0, 1.0);
        sum += distance.clamp(-BOUND, BOUND) * weight;
        weights += weight;
    }
    Some((median + sum / weights).exp2())
}

/// Median of log2 luminances from a histogram, interpolated within a bin.
fn median(logs: impl Iterator<Item = f64>) -> Option<f64> {
    let mut bins = [0u32; BINS];
    for log in logs {
        let bin = (log - BLACK.log2()) * BINS_PER_STOP;
        bins[(bin as usize).min(BINS - 1)] += 1;
    }
    let middle = 0.5 * f64::from(bins.iter().sum::<u32>());
    let mut below = 0.0;
    for (index, count) in bins.into_iter().enumerate() {
        let count = f64::from(count);
        if count > 0.0 && below + count >= middle {
            let within = (middle - below) / count;
            return Some(BLACK.log2() + (index as f64 + within) / BINS_PER_STOP);
        }
        below += count;
    }
    None
}

/// Time constant of adaptation, seconds: 90 % of a change are done in half a second.
const ADAPTATION_S: f64 = 0.22;

/// Fraction of the way to a new exposure after `seconds`: 1 - e^(-t/τ), the exponential adaptation of Krawczyk et al. 2005,
/// *Perceptual effects in real-time tone mapping*, eq. 5, here of log luminance.
///
/// Steps compose: two steps of half the time equal one.
pub fn adaptation(seconds: f64) -> f64 {
    -(-seconds / ADAPTATION_S).exp_m1()
}

/// EV100 that maps the log-average luminance (cd/m²) to [`KEY`] (Reinhard et al. 2002, eq. 2).
pub fn automatic(log_average_luminance: f64) -> f64 {
    ev100_from_factor(KEY / log_average_luminance)
}

/// The log-average luminance, cd/m², that [`automatic`] exposes at `ev100`; its inverse.
pub fn least_average(ev100: f64) -> f64 {
    KEY * max_luminance(ev100)
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
        let average = robust_log_average(&[800.0, 1250.0, 0.0, f64::NAN]);
        assert!((average.unwrap() - 1000.0).abs() < 1e-9);
        assert!((factor_from_ev100(automatic(1000.0)) * 1000.0 - KEY).abs() < 1e-15);
        assert!((least_average(automatic(1000.0)) - 1000.0).abs() < 1e-9);
        assert_eq!(robust_log_average(&[0.0, -1.0, f64::NAN]), None);
        assert_eq!(robust_log_average(&[]), None);
    }

    /// Change of the average, stops, when a fraction `share` of all pixels goes from the picture's grey to `luminance`.
    fn moved_by(share: f64, luminance: f64) -> f64 {
        let grey = 2000.0;
        let mut pixels = vec![grey; 3000];
        pixels[..(share * 3000.0) as usize].fill(luminance);
        (robust_log_average(&pixels).unwrap() / grey).log2()
    }

    #[test]
    fn black_does_not_move_the_exposure_and_dark_things_move_it_by_their_area() {
        for share in [0.01, 1.0 / 3.0, 0.9] {
            assert!(moved_by(share, 0.0).abs() < 1e-9);
        }
        // Up to the bound it acts as a log average.
        assert!((moved_by(0.3, 2000.0 / 8.0) + 3.0 * 0.3).abs() < 1e-9);
        // Beyond the bound the effect does not grow, and finally vanishes.
        for stops in [5, 6, 7, 8, 12, 20] {
            let moved = moved_by(0.3, 2000.0 * 0.5f64.powi(stops));
            assert!(moved <= 1e-9 && moved > -4.2 * 0.3, "{stops} {moved}");
            assert!(stops <= 8 || moved > -1e-9, "{stops} {moved}");
        }
    }

    #[test]
    fn the_suns_disc_moves_the_exposure_by_its_area() {
        for luminance in [1.6e9, f64::INFINITY] {
            let moved = moved_by(0.01, luminance);
            assert!(moved > 0.03 && moved < 0.043, "{moved}");
        }
    }

    #[test]
    fn adaptation_does_not_depend_on_the_frame_rate() {
        let rest = |steps: u32| (1.0 - adaptation(0.5 / f64::from(steps))).powi(steps as i32);
        assert!((rest(1) - 0.1).abs() < 0.005);
        assert!((rest(1) / rest(144) - 1.0).abs() < 1e-9);
        assert_eq!(adaptation(0.0), 0.0);
        assert_eq!(adaptation(1e9), 1.0);
    }
}
