//! Which materials of a file are panes of clear glass, and what those let through at normal incidence.

/// Opacity from which a surface without a mask is solid: little enough passes that it is not meant to be looked through.
const SOLID: f32 = 0.95;

/// The glass of an MTL material from its opacity, 0..1 (`d`, or 1 − `Tr`), its transmission filter (`Tf`) and its illumination model
/// (`illum`): the transmittance at normal incidence, linear RGB.
///
/// The first two say the same in two ways and are not multiplied: the smaller one holds. Models 6, 7 and 9 refract or are glass; 4 is
/// too, but Maya writes it for every material, with `Tf 1 1 1`. A surface that lets nothing through, or that is invisible (`d 0` without a
/// model of glass), is no pane.
pub(super) fn of_mtl(
    opacity: f32,
    filter: Option<[f32; 3]>,
    illumination: Option<u32>,
) -> Option<[f32; 3]> {
    let is_glass = matches!(illumination, Some(6 | 7 | 9));
    let filter = filter.unwrap_or([1.0; 3]);
    let is_visible = opacity > 0.0 || is_glass || illumination == Some(4);
    let is_pane = is_visible && (opacity < SOLID || is_glass || filter != [1.0; 3]);
    let from_opacity = if opacity < SOLID { 1.0 - opacity } else { 1.0 };
    let transmittance = filter.map(|f| f.clamp(0.0, 1.0).min(from_opacity));
    (is_pane && transmittance != [0.0; 3]).then_some(transmittance)
}

/// The glass of a glTF material: of `KHR_materials_transmission` the factor times the base colour; of a material that is blended without
/// a texture what its alpha leaves.
pub(super) fn of_gltf(
    base: [f32; 3],
    transmission: f32,
    blended_alpha: Option<f32>,
) -> Option<[f32; 3]> {
    let transmittance = if transmission > 0.0 {
        base.map(|v| (v * transmission).clamp(0.0, 1.0))
    } else {
        let alpha = blended_alpha.filter(|alpha| *alpha > 0.0 && *alpha < SOLID)?;
        [1.0 - alpha; 3]
    };
    (transmittance != [0.0; 3]).then_some(transmittance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_is_told_from_what_is_solid_or_invisible() {
        let white = Some([1.0; 3]);
        for (opacity, filter, illumination, expected) in [
            // Nothing said; a highlight; Maya's way of saying nothing.
            (1.0, None, None, None),
            (1.0, white, Some(2), None),
            (1.0, white, Some(4), None),
            // Invisible.
            (0.0, None, Some(2), None),
            // By opacity alone, by the filter alone, by both: not multiplied.
            (0.2, None, None, Some([0.8; 3])),
            (1.0, Some([0.88; 3]), Some(4), Some([0.88; 3])),
            (0.12, Some([0.88; 3]), Some(4), Some([0.88; 3])),
            (0.6, Some([0.9; 3]), Some(7), Some([0.4; 3])),
            // Models of glass; clear without a number.
            (1.0, white, Some(6), Some([1.0; 3])),
            (1.0, None, Some(9), Some([1.0; 3])),
            (0.0, None, Some(4), Some([1.0; 3])),
            (1.0, Some([0.2, 0.7, 0.3]), Some(7), Some([0.2, 0.7, 0.3])),
            // Nothing passes.
            (1.0, Some([0.0; 3]), Some(7), None),
            (1.0, Some([0.0; 3]), Some(2), None),
            (0.96, None, None, None),
        ] {
            let found = of_mtl(opacity, filter, illumination);
            let is_same = match (found, expected) {
                (Some(a), Some(b)) => a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6),
                (a, b) => a == b,
            };
            assert!(is_same, "{opacity} {filter:?} {illumination:?}: {found:?}");
        }
    }

    #[test]
    fn transmission_is_coloured_and_blending_is_grey() {
        let base = [0.5, 1.0, 0.8];
        assert_eq!(of_gltf(base, 1.0, None), Some(base));
        assert_eq!(of_gltf(base, 0.5, Some(0.1)), Some([0.25, 0.5, 0.4]));
        assert_eq!(of_gltf(base, 0.0, Some(0.25)), Some([0.75; 3]));
        for solid in [None, Some(0.0), Some(0.97), Some(1.0)] {
            assert_eq!(of_gltf(base, 0.0, solid), None, "{solid:?}");
        }
        assert_eq!(of_gltf([0.0; 3], 1.0, None), None);
    }
}
