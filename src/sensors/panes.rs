//! Panes of glass as rays meet them: tables of what they let through and mirror.

use glam::{DVec3, Vec3};

use crate::daylight::glass::{internal_transmittance, pane};
use crate::scene::Material;

/// Steps of a table: the linear interpolation is within 6e-5 of the formula, and within 6e-4 less than 0.06° from the plane of the pane.
const STEPS: usize = 1024;

/// What a pane lets through and mirrors, linear RGB, by the cosine of the angle of incidence.
#[derive(Debug, Clone)]
pub(super) struct Pane {
    shares: Vec<[Vec3; 2]>,
}

impl Pane {
    /// Of glass with this transmittance at normal incidence, linear RGB.
    fn new(transmittance: [f32; 3]) -> Self {
        let internal = transmittance.map(|v| internal_transmittance(f64::from(v)));
        let at = |step: usize| {
            let cosine = step as f64 / STEPS as f64;
            let shares = internal.map(|internal| pane(internal, cosine));
            [0, 1].map(|which| DVec3::from(shares.map(|share| share[which])).as_vec3())
        };
        Self {
            shares: (0..=STEPS).map(at).collect(),
        }
    }

    /// What passes and what is mirrored at this cosine, of either sign.
    pub fn at(&self, cosine: f32) -> [Vec3; 2] {
        let place = cosine.abs().min(1.0) * STEPS as f32;
        let step = (place as usize).min(STEPS - 1);
        let share = place - step as f32;
        let [low, high] = [self.shares[step], self.shares[step + 1]];
        [0, 1].map(|which| low[which].lerp(high[which], share))
    }

    /// Whether it colours the light that passes.
    pub fn is_tinted(&self) -> bool {
        let [passed, _] = self.shares[STEPS];
        passed.max_element() - passed.min_element() > 1e-6
    }
}

/// The pane of each material, if it is one; empty without any.
pub(super) fn panes(materials: &[Material]) -> Vec<Option<Pane>> {
    if materials.iter().all(|material| material.glass.is_none()) {
        return Vec::new();
    }
    let of = |material: &Material| material.glass.map(Pane::new);
    materials.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_formula() {
        let glass = [0.6, 0.88, 0.3];
        let table = Pane::new(glass);
        for at in 0..5000 {
            let cosine = (f64::from(at) + 0.37) / 5000.0;
            let found = table.at(-cosine as f32);
            for channel in 0..3 {
                let internal = internal_transmittance(f64::from(glass[channel]));
                for (which, expected) in pane(internal, cosine).into_iter().enumerate() {
                    let off = f64::from(found[which][channel]) - expected;
                    let bound = if cosine < 1.0 / STEPS as f64 {
                        6e-4
                    } else {
                        6e-5
                    };
                    assert!(off.abs() < bound, "{cosine} {which}: {off}");
                }
            }
        }
        assert!(table.is_tinted());
        assert!(!Pane::new([0.88; 3]).is_tinted());
    }
}
