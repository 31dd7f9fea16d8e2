//! CPU counterpart of `include/shared_exponent.glsl`: colours in 32 bits, three mantissas of 9 bits with one exponent.

use glam::Vec3;

/// Packs a colour; components are cut to 0..=65 408.
pub(super) fn pack(rgb: Vec3) -> u32 {
    let c = rgb.clamp(Vec3::ZERO, Vec3::splat(65_408.0));
    let most = c.max_element();
    // Exponent of the power of two above the largest component.
    let above = |v: f32| (v.to_bits() >> 23).cast_signed() - 126;
    let mut e = above(most).max(-15);
    // Rounding may carry it over to the next.
    if most * ((9 - e) as f32).exp2() + 0.5 >= 512.0 {
        e += 1;
    }
    let m = (c * ((9 - e) as f32).exp2() + 0.5).as_uvec3();
    m.x | m.y << 9 | m.z << 18 | (e + 15).cast_unsigned() << 27
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the specification of `VK_FORMAT_E5B9G9R9_UFLOAT_PACK32` decodes it.
    fn unpack(word: u32) -> Vec3 {
        let scale = ((word >> 27) as f32 - 24.0).exp2();
        Vec3::new(
            (word & 0x1ff) as f32,
            (word >> 9 & 0x1ff) as f32,
            (word >> 18 & 0x1ff) as f32,
        ) * scale
    }

    #[test]
    fn colours_come_back_to_half_a_step_of_the_largest() {
        for rgb in [
            [0.0; 3],
            [1.0, 0.5, 0.25],
            [1e-3, 2e-4, 7e-4],
            [511.9, 0.3, 77.0],
            [65_408.0, 1.0, 65_408.0],
            [0.999_99, 0.1, 0.2],
        ] {
            let rgb = Vec3::from(rgb);
            let error = (unpack(pack(rgb)) - rgb).abs().max_element();
            assert!(error <= rgb.max_element() / 511.0, "{rgb}: {error}");
        }
        assert_eq!(unpack(pack(Vec3::splat(1e9))), Vec3::splat(65_408.0));
    }
}
