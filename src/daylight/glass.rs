//! Panes of clear glass: how much light they let through and mirror, by the angle of incidence.
//!
//! A pane has two smooth parallel surfaces with the index of refraction [`INDEX`]; light is reflected between them without end
//! (Fresnel's equations and the geometric series of Airy without interference; Duffie & Beckman, "Solar Engineering of Thermal
//! Processes", eqs. 5.1 to 5.3). With ρ the reflectance of one surface and a = τ^(1/cos θ') what one passage through the glass leaves,
//! for each of the two polarisations,
//!
//! T = a (1 − ρ)² / (1 − ρ² a²), R = ρ (1 + a T)
//!
//! `include/glass.glsl` is the same on the device.

use super::colour::luminance;

/// Index of refraction of soda-lime glass.
pub const INDEX: f64 = 1.52;

/// The transmittance of a pane at normal incidence if nothing is absorbed: no pane of this glass lets more through.
pub fn clearest() -> f64 {
    let surface = normal_reflectance();
    (1.0 - surface) / (1.0 + surface)
}

/// Glass of the tint of `glass`, linear RGB, that lets this much light through at normal incidence; `None` if one of its colours would need more
/// than [`clearest`].
pub fn tinted(glass: [f32; 3], transmittance: f64) -> Option<[f32; 3]> {
    let luminance = luminance(glass.map(f64::from).into());
    let tinted = glass.map(|v| f64::from(v) * transmittance / luminance);
    // A grey pane may have the transmittance of the clearest glass, rounded.
    let is_glass = luminance > 0.0 && tinted.iter().all(|v| *v <= clearest() + 1e-6);
    is_glass.then(|| tinted.map(|v| v as f32))
}

/// Reflectance of one surface at normal incidence.
fn normal_reflectance() -> f64 {
    ((INDEX - 1.0) / (INDEX + 1.0)).powi(2)
}

/// What one passage straight through the glass of a pane leaves, 0..=1, of its transmittance at normal incidence (clamped to
/// 0..=[`clearest`]): the solution of T at normal incidence for τ.
pub fn internal_transmittance(normal_transmittance: f64) -> f64 {
    let t = normal_transmittance.clamp(0.0, clearest());
    let surface = normal_reflectance();
    let (passing, back) = ((1.0 - surface).powi(2), surface * surface * t);
    // The root of back τ² + passing τ - t = 0 that is not negative, without a difference of nearly equal numbers.
    let root = (passing * passing + 4.0 * back * t).sqrt();
    (2.0 * t / (passing + root)).clamp(0.0, 1.0)
}

/// Transmittance and reflectance of a pane with this internal transmittance, for light whose direction has this cosine with the normal.
pub fn pane(internal_transmittance: f64, cosine: f64) -> [f64; 2] {
    let cos_outside = cosine.abs().clamp(1e-4, 1.0);
    let sine = (1.0 - cos_outside * cos_outside).sqrt() / INDEX;
    let cos_inside = (1.0 - sine * sine).sqrt();
    let passage = internal_transmittance
        .clamp(0.0, 1.0)
        .powf(1.0 / cos_inside);
    // Perpendicular to the plane of incidence, and parallel to it.
    let amplitudes = [
        (cos_outside - INDEX * cos_inside) / (cos_outside + INDEX * cos_inside),
        (INDEX * cos_outside - cos_inside) / (INDEX * cos_outside + cos_inside),
    ];
    let mut mean = [0.0; 2];
    for amplitude in amplitudes {
        let surface = amplitude * amplitude;
        let back = surface * passage;
        let through = passage * (1.0 - surface).powi(2) / (1.0 - back * back);
        mean[0] += 0.5 * through;
        mean[1] += 0.5 * surface * (1.0 + passage * through);
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clear_glass_is_as_fresnel_says_at_six_angles() {
        // Two surfaces of n = 1.52 without absorption, (1 - r)/(1 + r) of each polarisation, mean.
        for (degrees, expected) in [
            (0.0, 0.91832),
            (30.0, 0.91596),
            (45.0, 0.90253),
            (60.0, 0.84347),
            (75.0, 0.61481),
            (85.0, 0.24565),
        ] {
            let cosine = f64::to_radians(degrees).cos();
            let [through, back] = pane(1.0, cosine);
            println!("{degrees}: {through:.4}");
            assert!((through - expected).abs() < 1e-5, "{degrees}: {through}");
            assert!((through + back - 1.0).abs() < 1e-12, "{degrees}: {back}");
        }
    }

    #[test]
    fn a_pane_has_the_transmittance_that_it_was_made_for() {
        for asked in [0.0, 1e-6, 0.1, 0.5, 0.65, 0.88, 0.9, clearest()] {
            let [through, back] = pane(internal_transmittance(asked), 1.0);
            assert!((through - asked).abs() < 1e-12, "{asked}: {through}");
            assert!(
                back > 0.04 && through + back <= 1.0 + 1e-12,
                "{asked}: {back}"
            );
        }
        assert!((internal_transmittance(1.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_passes_along_a_pane() {
        let [through, back] = pane(0.96, 0.0);
        assert!(through < 1e-3 && back > 0.999, "{through} {back}");
    }
}
