//! Colour: CIE XYZ, xyY, linear BT.709 RGB, the sRGB transfer function, correlated colour temperature.
//!
//! Linear RGB and XYZ are both [`DVec3`], in the unit of the quantity they hold: the Y of a radiance is in cd/m², that of an
//! irradiance in lux. RGB is scaled so that [`luminance`] returns the same Y.

use glam::{DMat3, DVec3};

use super::spectrum;

/// Chromaticities (x, y) of the BT.709 primaries red, green and blue (ITU-R BT.709-6, table 1).
pub const BT709_PRIMARIES: [[f64; 2]; 3] = [[0.640, 0.330], [0.300, 0.600], [0.150, 0.060]];

/// Chromaticity (x, y) of the white point D65 as given in BT.709.
pub const D65_WHITE: [f64; 2] = [0.3127, 0.3290];

/// Chromaticities (x, y) of the BT.2020 primaries red, green and blue (ITU-R BT.2020-2, table 3).
pub const BT2020_PRIMARIES: [[f64; 2]; 3] = [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]];

type Rows = [[f64; 3]; 3];

/// XYZ from linear BT.709 RGB (multiplies a column vector). Not rounded: computed from the primaries and the white point.
pub const XYZ_FROM_RGB: DMat3 = matrix(XYZ_FROM_RGB_ROWS);

/// Linear BT.709 RGB from XYZ: the inverse of [`XYZ_FROM_RGB`].
pub const RGB_FROM_XYZ: DMat3 = matrix(inverse(XYZ_FROM_RGB_ROWS));

/// Luminance weights of R, G and B: the middle row of [`XYZ_FROM_RGB`], about (0.2126, 0.7152, 0.0722).
pub const LUMINANCE_WEIGHTS: DVec3 = DVec3::from_array(XYZ_FROM_RGB_ROWS[1]);

const XYZ_FROM_RGB_ROWS: Rows = xyz_from_rgb_rows(BT709_PRIMARIES);

/// XYZ from linear RGB of these primaries, with white [`D65_WHITE`]: as [`XYZ_FROM_RGB`] for BT.709.
pub const fn xyz_from_rgb_of(primaries: [[f64; 2]; 3]) -> DMat3 {
    matrix(xyz_from_rgb_rows(primaries))
}

const fn matrix(r: Rows) -> DMat3 {
    DMat3::from_cols_array_2d(&[
        [r[0][0], r[1][0], r[2][0]],
        [r[0][1], r[1][1], r[2][1]],
        [r[0][2], r[1][2], r[2][2]],
    ])
}

/// SMPTE RP 177-1993: the primaries are scaled so that R = G = B = 1 is the white point with Y = 1.
const fn xyz_from_rgb_rows([r, g, b]: [[f64; 2]; 3]) -> Rows {
    let p = [
        [r[0], g[0], b[0]],
        [r[1], g[1], b[1]],
        [1.0 - r[0] - r[1], 1.0 - g[0] - g[1], 1.0 - b[0] - b[1]],
    ];
    let [x, y] = D65_WHITE;
    let white = [x / y, 1.0, (1.0 - x - y) / y];
    let q = inverse(p);
    let mut m = p;
    let mut c = 0;
    while c < 3 {
        let scale = q[c][0] * white[0] + q[c][1] * white[1] + q[c][2] * white[2];
        m[0][c] *= scale;
        m[1][c] *= scale;
        m[2][c] *= scale;
        c += 1;
    }
    m
}

/// Inverse by cofactors, as a `const fn`.
const fn inverse(m: Rows) -> Rows {
    let mut out = [[0.0; 3]; 3];
    let mut i = 0;
    while i < 9 {
        let (r, c) = (i / 3, i % 3);
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        out[c][r] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        i += 1;
    }
    let determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
    i = 0;
    while i < 9 {
        out[i / 3][i % 3] /= determinant;
        i += 1;
    }
    out
}

/// Linear BT.709 RGB from XYZ; channels are negative outside the gamut.
pub fn rgb_from_xyz(xyz: DVec3) -> DVec3 {
    RGB_FROM_XYZ * xyz
}

/// XYZ from linear BT.709 RGB.
pub fn xyz_from_rgb(rgb: DVec3) -> DVec3 {
    XYZ_FROM_RGB * rgb
}

/// XYZ from the chromaticity (x, y) and the luminance Y, in any unit.
pub fn xyz_from_xyy(x: f64, y: f64, luminance: f64) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y) * luminance
}

/// Chromaticity (x, y) of a colour in XYZ; the white point for black.
pub fn chromaticity(xyz: DVec3) -> [f64; 2] {
    let sum = xyz.element_sum();
    if sum == 0.0 {
        return D65_WHITE;
    }
    [xyz.x / sum, xyz.y / sum]
}

/// Luminance Y of a linear BT.709 colour, in the unit of the colour (cd/m² for a radiance, lux for an irradiance).
pub fn luminance(rgb: DVec3) -> f64 {
    LUMINANCE_WEIGHTS.dot(rgb)
}

/// Clips `rgb` to the displayable gamut: negative channels become 0, and the rest is scaled to keep the luminance. A colour
/// without positive luminance becomes black.
///
/// Clamping alone would raise the luminance: a setting sun has negative G and B.
pub fn clip_negative(rgb: DVec3) -> DVec3 {
    if rgb.min_element() >= 0.0 {
        return rgb;
    }
    let (target, clamped) = (luminance(rgb), rgb.max(DVec3::ZERO));
    let clamped_luminance = luminance(clamped);
    if target > 0.0 && clamped_luminance > 0.0 {
        clamped * (target / clamped_luminance)
    } else {
        DVec3::ZERO
    }
}

/// sRGB opto-electronic transfer function (IEC 61966-2-1), one channel: linear `[0, 1]` to encoded `[0, 1]`, clamped.
pub fn srgb_oetf(linear: f64) -> f64 {
    let c = linear.clamp(0.0, 1.0);
    if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    }
}

/// sRGB electro-optical transfer function (IEC 61966-2-1), one channel: encoded `[0, 1]` to linear `[0, 1]`, clamped.
pub fn srgb_eotf(encoded: f64) -> f64 {
    let c = encoded.clamp(0.0, 1.0);
    if c <= 0.040_45 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// Correlated colour temperature, K, in 1 000..=1 000 000 of a colour in XYZ.
///
/// CIE 15:2004, 9.5: the temperature of the black body with the nearest chromaticity in the CIE 1960 (u, v) diagram, found by
/// golden-section search over the reciprocal temperature on the Planckian locus itself. A fit such as McCamy's is not used,
/// because the blue sky is far beyond its range (12 500 K). `None` where the standard calls the quantity meaningless: farther
/// than 0.05 from the locus.
pub fn correlated_colour_temperature(xyz: DVec3) -> Option<f64> {
    let target = uv_1960(xyz);
    let distance = |mired: f64| {
        let locus = uv_1960(spectrum::xyz_of_black_body(1e6 / mired));
        (locus[0] - target[0]).hypot(locus[1] - target[1])
    };
    let mired = golden_section_minimum(1.0, 1000.0, distance);
    (distance(mired) <= 0.05).then_some(1e6 / mired)
}

fn uv_1960(xyz: DVec3) -> [f64; 2] {
    let denominator = xyz.x + 15.0 * xyz.y + 3.0 * xyz.z;
    [4.0 * xyz.x / denominator, 6.0 * xyz.y / denominator]
}

fn golden_section_minimum(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let ratio = (5f64.sqrt() - 1.0) / 2.0;
    let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut at_a, mut at_b) = (f(a), f(b));
    while high - low > 1e-3 {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - ratio * (high - low);
            at_a = f(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + ratio * (high - low);
            at_b = f(b);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white() {
        let [x, y] = D65_WHITE;
        let white = rgb_from_xyz(xyz_from_xyy(x, y, 1.0));
        assert!((white - DVec3::ONE).abs().max_element() < 1e-14, "{white}");
        assert!((luminance(DVec3::ONE) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn matrices_are_inverse() {
        let product = RGB_FROM_XYZ * XYZ_FROM_RGB;
        assert!(product.abs_diff_eq(DMat3::IDENTITY, 1e-14), "{product}");
    }

    #[test]
    fn srgb_curves_are_inverse() {
        for i in 0..=1000 {
            let c = f64::from(i) / 1000.0;
            assert!((srgb_eotf(srgb_oetf(c)) - c).abs() < 1e-7, "{c}");
        }
    }

    #[test]
    fn clipping_keeps_luminance_and_leaves_the_gamut_alone() {
        let low_sun = DVec3::new(3.0, 0.2, -0.1);
        let clipped = clip_negative(low_sun);
        assert!(clipped.min_element() >= 0.0);
        assert!((luminance(clipped) - luminance(low_sun)).abs() < 1e-14);
        assert_eq!(
            clip_negative(DVec3::new(1.0, 2.0, 3.0)),
            DVec3::new(1.0, 2.0, 3.0)
        );
        assert_eq!(clip_negative(DVec3::new(-1.0, -2.0, 0.5)), DVec3::ZERO);
    }

    #[test]
    fn a_black_body_has_its_own_temperature() {
        for kelvin in [1500.0, 2856.0, 6500.0, 25_000.0, 100_000.0] {
            let found = correlated_colour_temperature(spectrum::xyz_of_black_body(kelvin)).unwrap();
            assert!((found / kelvin - 1.0).abs() < 1e-3, "{kelvin}: {found}");
        }
    }

    #[test]
    fn d65_has_6504_kelvin_and_green_has_none() {
        let [x, y] = D65_WHITE;
        let found = correlated_colour_temperature(xyz_from_xyy(x, y, 1.0)).unwrap();
        assert!((found - 6504.0).abs() < 5.0, "{found}");
        assert!(correlated_colour_temperature(xyz_from_rgb(DVec3::Y)).is_none());
    }
}
