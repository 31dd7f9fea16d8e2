//! Spectra: piecewise linear tables, the CIE 1931 observer, the integral to XYZ, Planck's black body,
//! CIE daylight.
//!
//! Wavelengths are in nm. A spectral radiance in W m⁻² nm⁻¹ sr⁻¹ integrates to XYZ with Y in cd/m².

use std::ops::RangeInclusive;

use glam::DVec3;

use super::data::{cie_1931_2deg::CIE_1931_2DEG, preetham_spectra};

/// Maximum luminous efficacy K_m of photopic vision, lm/W (CIE 018:2019).
pub const LUMINOUS_EFFICACY: f64 = 683.0;

/// The wavelengths of the colour-matching functions, nm.
pub const CIE_RANGE_NM: RangeInclusive<u32> = 360..=830;

/// A spectrum tabulated at nodes: linear in between, zero outside. Nodes are (wavelength in nm, value), ascending.
#[derive(Clone, Copy, Debug)]
pub struct TabulatedSpectrum(pub &'static [(f64, f64)]);

impl TabulatedSpectrum {
    /// Value at `nm`, in the unit of the table.
    pub fn at(&self, nm: f64) -> f64 {
        let after = self.0.partition_point(|node| node.0 <= nm);
        match (after.checked_sub(1).map(|i| self.0[i]), self.0.get(after)) {
            (Some((x0, y0)), Some((x1, y1))) => y0 + (y1 - y0) * (nm - x0) / (x1 - x0),
            (Some((x0, y0)), None) if x0 == nm => y0,
            _ => 0.0,
        }
    }
}

/// CIE 1931 2° colour-matching functions (x̄, ȳ, z̄) at `nm`: 1 nm table, linear in between, zero outside.
pub fn cie_1931_2deg(nm: f64) -> DVec3 {
    let first = f64::from(*CIE_RANGE_NM.start());
    let last = f64::from(*CIE_RANGE_NM.end());
    if !(first..=last).contains(&nm) {
        return DVec3::ZERO;
    }
    let row = (nm - first).floor().min(last - first - 1.0);
    let at = |i: usize| DVec3::from_array(CIE_1931_2DEG[i]);
    // `row` is an integer in 0..=469.
    at(row as usize).lerp(at(row as usize + 1), nm - first - row)
}

/// XYZ of a spectral radiance (or irradiance) per nm: 683 lm/W times the 1 nm trapezoid sum over `range`.
///
/// Y is in cd/m² for W m⁻² nm⁻¹ sr⁻¹, in lux for W m⁻² nm⁻¹.
pub fn xyz_from_spectrum(range: RangeInclusive<u32>, spectrum: impl Fn(f64) -> f64) -> DVec3 {
    let ends = [*range.start(), *range.end()];
    let sum = range.map(|nm| {
        let weight = if ends.contains(&nm) { 0.5 } else { 1.0 };
        let nm = f64::from(nm);
        weight * spectrum(nm) * cie_1931_2deg(nm)
    });
    LUMINOUS_EFFICACY * sum.sum::<DVec3>()
}

/// Integral of a spectrum per nm over `range` by 1 nm trapezoids: W m⁻² sr⁻¹ for W m⁻² nm⁻¹ sr⁻¹.
pub fn integral(range: RangeInclusive<u32>, spectrum: impl Fn(f64) -> f64) -> f64 {
    let ends = [*range.start(), *range.end()];
    let weight = |nm: u32| if ends.contains(&nm) { 0.5 } else { 1.0 };
    range.map(|nm| weight(nm) * spectrum(f64::from(nm))).sum()
}

/// Planck 1901: spectral radiance of a black body of `kelvin` at `nm`, W m⁻² nm⁻¹ sr⁻¹.
pub fn planck(kelvin: f64, nm: f64) -> f64 {
    // Exact SI constants (CODATA 2018): h, c, k.
    const H: f64 = 6.626_070_15e-34;
    const C: f64 = 299_792_458.0;
    const K: f64 = 1.380_649e-23;
    let metres = nm * 1e-9;
    let per_metre = 2.0 * H * C * C / metres.powi(5) / (H * C / (metres * K * kelvin)).exp_m1();
    per_metre * 1e-9
}

/// XYZ of a black body of `kelvin`, Y in cd/m²; CIE 1931 observer, 360..=830 nm.
pub fn xyz_of_black_body(kelvin: f64) -> DVec3 {
    xyz_from_spectrum(CIE_RANGE_NM, |nm| planck(kelvin, nm))
}

/// CIE 15:2004, 3.1: relative spectral power of the daylight phase of chromaticity (x, y) at `nm` (100 at 560 nm).
///
/// S = S0 + M1 S1 + M2 S2. Preetham et al. 1999, A.5 converts the sky's chromaticity to a spectrum with it.
pub fn daylight_phase(x: f64, y: f64, nm: f64) -> f64 {
    let (m1, m2) = daylight_weights(x, y);
    let [s0, s1, s2] = daylight_components(nm);
    s0 + m1 * s1 + m2 * s2
}

/// CIE 15:2004, table T.2: the daylight components S0, S1 and S2 at `nm`, relative units.
pub fn daylight_components(nm: f64) -> [f64; 3] {
    use preetham_spectra::{DAYLIGHT_S0, DAYLIGHT_S1, DAYLIGHT_S2};
    [DAYLIGHT_S0, DAYLIGHT_S1, DAYLIGHT_S2].map(|table| TabulatedSpectrum(table).at(nm))
}

/// CIE 15:2004, 3.1: the weights M1 and M2 of the daylight components for the chromaticity (x, y).
pub fn daylight_weights(x: f64, y: f64) -> (f64, f64) {
    let denominator = 0.0241 + 0.2562 * x - 0.7341 * y;
    (
        (-1.3515 - 1.7703 * x + 5.9114 * y) / denominator,
        (0.0300 - 31.4424 * x + 30.0717 * y) / denominator,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::colour;

    #[test]
    fn table_is_linear_inside_and_zero_outside() {
        let table = TabulatedSpectrum(&[(400.0, 1.0), (410.0, 3.0), (430.0, 0.0)]);
        let cases = [
            (399.0, 0.0),
            (400.0, 1.0),
            (405.0, 2.0),
            (410.0, 3.0),
            (420.0, 1.5),
            (431.0, 0.0),
        ];
        for (nm, value) in cases {
            assert_eq!(table.at(nm), value, "{nm} nm");
        }
        assert_eq!(
            TabulatedSpectrum(&[(400.0, 1.0), (410.0, 3.0)]).at(410.0),
            3.0
        );
    }

    #[test]
    fn equal_energy_spectrum_is_nearly_colourless() {
        let [x, y] = colour::chromaticity(xyz_from_spectrum(CIE_RANGE_NM, |_| 1.0));
        assert!(
            (x - 1.0 / 3.0).abs() < 1e-4 && (y - 1.0 / 3.0).abs() < 1e-4,
            "{x} {y}"
        );
    }

    #[test]
    fn one_watt_at_555_nm_is_683_lumens() {
        let line = |nm: f64| if nm == 555.0 { 1.0 } else { 0.0 };
        assert!((xyz_from_spectrum(CIE_RANGE_NM, line).y - 683.0).abs() < 1e-9);
    }

    #[test]
    fn stefan_boltzmann_follows_from_planck() {
        let kelvin = 5772.0;
        let exitance = std::f64::consts::PI * integral(10..=200_000, |nm| planck(kelvin, nm));
        let expected = 5.670_374_419e-8 * kelvin.powi(4);
        assert!(
            (exitance / expected - 1.0).abs() < 1e-5,
            "{exitance} {expected}"
        );
    }

    #[test]
    fn illuminant_a_has_its_published_chromaticity() {
        // CIE 15: Planck's law with c2 = 1.4350e-2 m K at 2848 K, equivalent to 2855.5 K with today's c2.
        let [x, y] = colour::chromaticity(xyz_of_black_body(2848.0 * 1.438_776_877 / 1.435));
        assert!(
            (x - 0.447_58).abs() < 1e-4 && (y - 0.407_45).abs() < 1e-4,
            "{x} {y}"
        );
    }

    #[test]
    fn daylight_of_d65_has_d65_chromaticity() {
        let [x, y] = [0.312_72, 0.329_03];
        let d65 = |nm: f64| daylight_phase(x, y, nm);
        let [fx, fy] = colour::chromaticity(xyz_from_spectrum(CIE_RANGE_NM, d65));
        assert!((fx - x).abs() < 2e-4 && (fy - y).abs() < 2e-4, "{fx} {fy}");
        assert!((d65(560.0) - 100.0).abs() < 1e-12);
    }
}
