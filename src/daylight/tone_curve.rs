//! Tone curves: exposed scene-linear RGB (1 = the exposure's maximum) to display-linear RGB in 0..=1.
//!
//! The result is then encoded for the screen: [`encode`].

use glam::{DMat3, DVec3};

use super::colour::srgb_oetf;

/// Luminance weights of R, G and B in the published curves (BT.709, four digits).
pub const LUMINANCE_WEIGHTS: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// The smallest luminance that [`ToneCurve::Reinhard`] maps to white, in exposed units.
pub const REINHARD_WHITE: f64 = 4.0;

/// Tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// Clamp to 0..=1 (the lecture's, scale 1).
    Linear,
    /// Ferschin's exponential per channel (the lecture's other one).
    Exponential,
    /// The same applied to luminance, keeping the colour.
    ExponentialLuminance,
    /// Reinhard et al. 2002, global operator with white at [`REINHARD_WHITE`], on luminance.
    Reinhard,
    /// AgX, base look.
    Agx,
    /// Khronos PBR Neutral: surface colours are unchanged up to 0.8.
    #[default]
    Neutral,
    /// ACES RRT + ODT, Hill's fit.
    Aces,
}

impl ToneCurve {
    /// Display-linear RGB in 0..=1 for an exposed scene-linear colour without negative channels.
    pub fn apply(self, rgb: DVec3) -> DVec3 {
        let mapped = match self {
            Self::Linear => rgb,
            Self::Exponential => exponential(rgb, 1.0),
            Self::ExponentialLuminance => exponential_luminance(rgb, 1.0),
            Self::Reinhard => reinhard(rgb, 1.0, REINHARD_WHITE),
            Self::Agx => agx(rgb),
            Self::Neutral => neutral(rgb),
            Self::Aces => aces_hill(rgb),
        };
        mapped.clamp(DVec3::ZERO, DVec3::ONE)
    }
}

/// Encodes display-linear RGB for the screen: sRGB, or the power 1/γ if a `gamma` is given. Clamped to 0..=1.
pub fn encode(rgb: DVec3, gamma: Option<f64>) -> DVec3 {
    let rgb = rgb.clamp(DVec3::ZERO, DVec3::ONE);
    match gamma {
        Some(gamma) => rgb.powf(1.0 / gamma),
        None => rgb.map(srgb_oetf),
    }
}

fn luminance(rgb: DVec3) -> f64 {
    LUMINANCE_WEIGHTS.dot(rgb)
}

/// Lecture, "Tone mapping": scale and gamma, (s c)^(1/γ) clamped to 0..=1; the result is encoded.
pub fn linear_gamma(rgb: DVec3, scale: f64, gamma: f64) -> DVec3 {
    encode(rgb * scale, Some(gamma))
}

/// Ferschin et al. 1994 (lecture, "Tone mapping"): 1 - exp(-c/L_avg) per channel.
///
/// `average` is the luminance that maps to 1 - 1/e, in the unit of `rgb`; 1 in the lecture.
pub fn exponential(rgb: DVec3, average: f64) -> DVec3 {
    rgb.map(|c| 1.0 - (-c / average).exp())
}

/// [`exponential`] applied to the luminance, keeping the colour: channels may exceed 1.
pub fn exponential_luminance(rgb: DVec3, average: f64) -> DVec3 {
    scale_luminance(rgb, |l| 1.0 - (-l / average).exp())
}

/// Reinhard et al. 2002, *Photographic Tone Reproduction*, eq. 4 applied to the luminance, keeping the colour: channels may
/// exceed 1.
///
/// `scale` is key / log-average luminance (eq. 2; 1 for exposed colours), `white` is the smallest scaled luminance that maps
/// to 1.
pub fn reinhard(rgb: DVec3, scale: f64, white: f64) -> DVec3 {
    scale_luminance(rgb, |luminance| {
        let l = luminance * scale;
        l * (1.0 + l / (white * white)) / (1.0 + l)
    })
}

fn scale_luminance(rgb: DVec3, curve: impl Fn(f64) -> f64) -> DVec3 {
    let l = luminance(rgb);
    if l > 0.0 {
        rgb * (curve(l) / l)
    } else {
        DVec3::ZERO
    }
}

/// Khronos PBR Neutral tone mapper (Khronos 2024): base colours below 0.8 keep hue and saturation; in 0..=1.
pub fn neutral(rgb: DVec3) -> DVec3 {
    const START: f64 = 0.8 - 0.04;
    const DESATURATION: f64 = 0.15;
    let least = rgb.min_element();
    let offset = if least < 0.08 {
        least - 6.25 * least * least
    } else {
        0.04
    };
    let rgb = rgb - offset;
    let peak = rgb.max_element();
    if peak < START {
        return rgb;
    }
    let d = 1.0 - START;
    let new_peak = 1.0 - d * d / (peak + d - START);
    let grey = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    (rgb * (new_peak / peak)).lerp(DVec3::splat(new_peak), grey)
}

const fn rows(r: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&[
        [r[0][0], r[1][0], r[2][0]],
        [r[0][1], r[1][1], r[2][1]],
        [r[0][2], r[1][2], r[2][2]],
    ])
}

/// AgX inset: rows sum to 1. Transposed (as in one published copy), white would darken by 7 %.
const AGX_INSET: DMat3 = rows([
    [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
    [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
    [0.0423756549057051, 0.0784336, 0.879142973793104],
]);

const AGX_OUTSET: DMat3 = rows([
    [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
    [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
    [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
]);

/// AgX (Sobotka 2022; Wrensch's minimal version, base look): the display signal, encoded with a power of 2.2. Slightly outside
/// 0..=1 for black and for saturated colours; not clamped.
pub fn agx_encoded(rgb: DVec3) -> DVec3 {
    const MIN_EV: f64 = -12.47393;
    const MAX_EV: f64 = 4.026069;
    let inset = AGX_INSET * rgb;
    // The logarithm of 0 is -∞, which is clamped to MIN_EV.
    let log = inset.map(|c| (c.max(0.0).log2().clamp(MIN_EV, MAX_EV) - MIN_EV) / (MAX_EV - MIN_EV));
    AGX_OUTSET * log.map(agx_contrast)
}

/// Sixth-order fit of AgX' contrast curve over 0..=1 (Wrensch).
fn agx_contrast(x: f64) -> f64 {
    let coefficients = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232];
    coefficients.into_iter().fold(0.0, |sum, c| sum * x + c)
}

/// [`agx_encoded`] decoded to display-linear light by the power 2.2, not below 0.
pub fn agx(rgb: DVec3) -> DVec3 {
    agx_encoded(rgb).max(DVec3::ZERO).powf(2.2)
}

/// Narkowicz 2015, *ACES Filmic Tone Mapping Curve*: per channel, display-linear in 0..=1.
pub fn aces_narkowicz(rgb: DVec3) -> DVec3 {
    rgb.map(|x| ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0))
}

/// Hill 2017, fit of the ACES RRT and sRGB ODT: display-linear in 0..=1. Without the factor 0.6 that some engines add.
pub fn aces_hill(rgb: DVec3) -> DVec3 {
    const INPUT: DMat3 = rows([
        [0.59719, 0.35458, 0.04823],
        [0.07600, 0.90834, 0.01566],
        [0.02840, 0.13383, 0.83777],
    ]);
    const OUTPUT: DMat3 = rows([
        [1.60475, -0.53108, -0.07367],
        [-0.10208, 1.10813, -0.00605],
        [-0.00327, -0.07276, 1.07602],
    ]);
    let fit =
        |v: f64| (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    (OUTPUT * (INPUT * rgb).map(fit)).clamp(DVec3::ZERO, DVec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVES: [ToneCurve; 7] = [
        ToneCurve::Linear,
        ToneCurve::Exponential,
        ToneCurve::ExponentialLuminance,
        ToneCurve::Reinhard,
        ToneCurve::Agx,
        ToneCurve::Neutral,
        ToneCurve::Aces,
    ];

    #[test]
    fn grey_stays_grey_and_brighter_is_brighter() {
        for curve in CURVES {
            let mut before = -1.0;
            for i in 0..400 {
                let out = curve.apply(DVec3::splat(1e-4 * 1.05f64.powi(i)));
                assert!(
                    out.max_element() - out.min_element() < 1e-3,
                    "{curve:?} {out}"
                );
                assert!(out.min_element() >= 0.0 && out.max_element() <= 1.0);
                assert!(out.y >= before - 1e-12, "{curve:?} {before} {out}");
                before = out.y;
            }
            assert!(before > 0.99, "{curve:?} ends at {before}");
            assert!(curve.apply(DVec3::ZERO).max_element() < 1e-3, "{curve:?}");
        }
    }

    #[test]
    fn enormous_and_saturated_colours_stay_finite() {
        for curve in CURVES {
            for rgb in [
                DVec3::splat(1e9),
                DVec3::X * 1e9,
                DVec3::Z,
                DVec3::Y * 1e-12,
            ] {
                let out = curve.apply(rgb);
                assert!(out.is_finite() && out.min_element() >= 0.0 && out.max_element() <= 1.0);
            }
        }
    }

    #[test]
    fn agx_rows_keep_white() {
        for matrix in [AGX_INSET, AGX_OUTSET] {
            let white = matrix * DVec3::ONE;
            assert!((white - DVec3::ONE).abs().max_element() < 2e-4, "{white}");
        }
    }

    #[test]
    fn reinhard_maps_its_white_to_one() {
        let white = reinhard(DVec3::splat(3.0), 1.0, 3.0);
        assert!((white - DVec3::ONE).abs().max_element() < 1e-12);
    }

    #[test]
    fn encoding_is_srgb_or_a_power() {
        assert!((encode(DVec3::splat(0.18), None).x - 0.4613561295).abs() < 1e-9);
        assert!((encode(DVec3::splat(0.25), Some(2.0)).x - 0.5).abs() < 1e-15);
        let clamped = encode(DVec3::new(-1.0, 2.0, 1.0), None);
        assert!((clamped - DVec3::new(0.0, 1.0, 1.0)).length() < 1e-15);
    }
}
