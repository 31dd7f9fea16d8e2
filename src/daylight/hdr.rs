//! Encodings of HDR screens: what a display value means in cd/m², and the signals of scRGB and HDR10.
//!
//! Display values are exposed linear BT.709 colours; 1 is the white of paper. On an HDR screen it has [`PAPER_WHITE`], and all values are
//! shown in proportion, up to the screen's peak: no tone curve bends them.

use glam::{DMat3, DVec3};

use super::colour::{BT2020_PRIMARIES, RGB_FROM_XYZ, xyz_from_rgb_of};

/// Luminance of display value 1, cd/m²: the reference level of HDR White (ITU-R BT.2408-7, table 1).
pub const PAPER_WHITE: f64 = 203.0;

/// Luminance of scRGB's value 1, cd/m² (IEC 61966-2-2, which takes it from the reference conditions of sRGB, IEC 61966-2-1).
pub const SCRGB_WHITE: f64 = 80.0;

/// Luminance of the signal 1 of the PQ curve, cd/m² (SMPTE ST 2084).
pub const PQ_PEAK: f64 = 10_000.0;

/// Peak of an HDR screen of which nothing is known, cd/m²: that of the screens that ITU-R BT.2408 and most HDR10 films are made for.
pub const HDR_PEAK: f64 = 1000.0;

/// Display values are cut here, so that infinite ones stay numbers: it is far above every peak.
const MOST: f64 = 1e6;

/// Linear BT.2020 from linear BT.709, both with white D65 (ITU-R BT.2087, from the primaries, not rounded).
pub fn bt2020_from_bt709() -> DMat3 {
    (RGB_FROM_XYZ * xyz_from_rgb_of(BT2020_PRIMARIES)).inverse()
}

/// The inverse EOTF of SMPTE ST 2084: a luminance, cd/m², to a signal in 0..=1; clamped to 0..=[`PQ_PEAK`].
pub fn pq_from_luminance(luminance: f64) -> f64 {
    const M1: f64 = 2610.0 / 16384.0;
    const M2: f64 = 2523.0 / 4096.0 * 128.0;
    const C1: f64 = 3424.0 / 4096.0;
    const C2: f64 = 2413.0 / 4096.0 * 32.0;
    const C3: f64 = 2392.0 / 4096.0 * 32.0;
    let y = (luminance / PQ_PEAK).clamp(0.0, 1.0).powf(M1);
    ((C1 + C2 * y) / (1.0 + C3 * y)).powf(M2)
}

/// A colour of display values that a screen of this `peak` (its highest display value) can show. Up to the peak nothing changes. A brighter
/// colour is scaled down to the peak and turns to white the more, the brighter it was, as beyond the shoulder of Khronos PBR Neutral (2024).
pub fn bounded(rgb: DVec3, peak: f64) -> DVec3 {
    const DESATURATION: f64 = 0.15;
    let rgb = rgb.min(DVec3::splat(MOST));
    let most = rgb.max_element();
    if most <= peak {
        return rgb;
    }
    let grey = 1.0 - 1.0 / (DESATURATION * (most - peak) + 1.0);
    (rgb * (peak / most)).lerp(DVec3::splat(peak), grey)
}

/// The signal of scRGB: linear BT.709 with 1 for [`SCRGB_WHITE`], from display values.
pub fn scrgb(rgb: DVec3) -> DVec3 {
    rgb * (PAPER_WHITE / SCRGB_WHITE)
}

/// The signal of HDR10: BT.2020 by the PQ curve (ITU-R BT.2100), 0..=1, from display values. Channels below 0 are cut.
pub fn hdr10(rgb: DVec3) -> DVec3 {
    (bt2020_from_bt709() * rgb * PAPER_WHITE).map(pq_from_luminance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pq_curve_has_the_published_values() {
        // Signals of 10 bits, full range, that ITU-R BT.2408 and BT.2390 tell for luminances; 203 cd/m² is 58 % of the signal.
        for (luminance, code) in [
            (0.0, 0.0),
            (100.0, 520.0),
            (203.0, 594.0),
            (1000.0, 769.0),
            (4000.0, 923.0),
            (10_000.0, 1023.0),
        ] {
            let signal = 1023.0 * pq_from_luminance(luminance);
            assert_eq!(signal.round(), code, "{luminance} {signal}");
        }
        assert_eq!((100.0 * pq_from_luminance(203.0)).round(), 58.0);
        // colour-science, eotf_inverse_ST2084(100).
        assert!((pq_from_luminance(100.0) - 0.508_078_421_517_399).abs() < 1e-12);
        assert_eq!(pq_from_luminance(1e9), 1.0);
        assert!(pq_from_luminance(-1.0) < 1e-6);
    }

    #[test]
    fn the_pq_curve_is_the_inverse_of_its_eotf() {
        // SMPTE ST 2084, 5.2, written out the other way round.
        let eotf = |signal: f64| {
            let p = signal.powf(32.0 / 2523.0);
            let y = (p - 107.0 / 128.0).max(0.0) / (2413.0 / 128.0 - 2392.0 / 128.0 * p);
            PQ_PEAK * y.powf(16384.0 / 2610.0)
        };
        for i in 0..=1000 {
            let luminance = 1e-3 * 1e7f64.powf(f64::from(i) / 1000.0);
            let again = eotf(pq_from_luminance(luminance));
            assert!(
                (again / luminance - 1.0).abs() < 1e-9,
                "{luminance} {again}"
            );
        }
    }

    #[test]
    fn bt2020_is_that_of_bt2087() {
        let published = [
            [0.6274, 0.3293, 0.0433],
            [0.0691, 0.9195, 0.0114],
            [0.0164, 0.0880, 0.8956],
        ];
        let matrix = bt2020_from_bt709();
        for (row, expected) in published.into_iter().enumerate() {
            let difference = matrix.row(row) - DVec3::from_array(expected);
            assert!(difference.abs().max_element() < 6e-5, "{row} {difference}");
        }
        let white = matrix * DVec3::ONE;
        assert!((white - DVec3::ONE).abs().max_element() < 1e-14, "{white}");
    }

    #[test]
    fn a_colour_is_left_alone_up_to_the_peak_and_never_passes_it() {
        let peak = 1000.0 / PAPER_WHITE;
        let colour = DVec3::new(4.9, 2.0, 0.1);
        assert_eq!(bounded(colour, peak), colour);
        let mut before = bounded(colour, peak);
        for i in 0..2000 {
            let found = bounded(colour * 1.02f64.powi(i), peak);
            assert!(found.max_element() <= peak * (1.0 + 1e-12), "{found}");
            // It does not jump, and no channel becomes darker.
            assert!((found - before).min_element() > -1e-9, "{before} {found}");
            assert!(
                (found - before).max_element() < 0.05 * peak,
                "{before} {found}"
            );
            before = found;
        }
        // A hundred times the peak is nearly white.
        let white = bounded(colour * 100.0, peak);
        assert!(white.min_element() > 0.95 * peak, "{white}");
        assert!(bounded(DVec3::splat(f64::INFINITY), peak).is_finite());
    }

    #[test]
    fn paper_has_203_candelas_in_both_signals() {
        assert!((scrgb(DVec3::ONE).x * SCRGB_WHITE - 203.0).abs() < 1e-12);
        let white = hdr10(DVec3::ONE);
        assert!(
            (white - DVec3::splat(pq_from_luminance(203.0)))
                .abs()
                .max_element()
                < 1e-12
        );
        // Red of BT.709 lies inside of BT.2020.
        assert!(hdr10(DVec3::X).min_element() > 0.2, "{}", hdr10(DVec3::X));
    }
}
