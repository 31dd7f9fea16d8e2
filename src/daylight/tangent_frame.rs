//! Tangent frames: two unit vectors that complete a normal to a right-handed orthonormal basis (b1, b2, n).
//!
//! Use [`duff`]. [`frisvad`] is the lecture's (slide "Integrating skylight"): it divides by 1 + n_z, which is 0 at
//! n = (0, 0, -1). It loses precision near that pole: in `f32`, |M Mᵀ - I| is 7e-4 at n_z = -0.99995, 0.15 at -0.9999995,
//! and NaN at -1. The published fix, a constant frame beyond a threshold, is exact only at -1 itself; elsewhere its error is
//! the sine of the angle to -z, so no threshold solves the problem. Duff et al. choose the pole by the sign of n_z: the
//! magnitude of the divisor is then at least 1, and the error stays at 1e-7.
//!
//! Each function exists in `f64` and, with the suffix `_f32`, in the precision of a shader.

use glam::{DVec3, Vec3};

macro_rules! frames {
    ($float:ty, $vec:ty, $duff:ident, $frisvad:ident, $frisvad_raw:ident) => {
        /// Duff et al. 2017, *Building an Orthonormal Basis, Revisited*: (b1, b2) for a unit `n`, b1 × b2 = n.
        pub fn $duff(n: $vec) -> ($vec, $vec) {
            let sign = (1.0 as $float).copysign(n.z);
            let a = -1.0 / (sign + n.z);
            let b = n.x * n.y * a;
            (
                <$vec>::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
                <$vec>::new(b, sign + n.y * n.y * a, -n.y),
            )
        }

        /// Frisvad 2012, *Building an Orthonormal Basis from a 3D Unit Vector Without Normalization*: (b1, b2) for a unit `n`,
        /// with the paper's constant frame for n_z < -0.9999999. The module documentation says where it fails.
        pub fn $frisvad(n: $vec) -> ($vec, $vec) {
            if n.z < -0.999_999_9 {
                return (<$vec>::NEG_Y, <$vec>::NEG_X);
            }
            $frisvad_raw(n)
        }

        /// The lecture's formula as printed on the slide, without the branch: infinite or NaN at n = -z.
        pub fn $frisvad_raw(n: $vec) -> ($vec, $vec) {
            let a = 1.0 / (1.0 + n.z);
            let b = -n.x * n.y * a;
            (
                <$vec>::new(1.0 - n.x * n.x * a, b, -n.x),
                <$vec>::new(b, 1.0 - n.y * n.y * a, -n.y),
            )
        }
    };
}

frames!(f64, DVec3, duff, frisvad, frisvad_raw);
frames!(f32, Vec3, duff_f32, frisvad_f32, frisvad_raw_f32);

/// World vector of `local`, whose z axis is the unit normal `n`, in the frame of [`duff`].
pub fn to_world(local: DVec3, n: DVec3) -> DVec3 {
    let (b1, b2) = duff(n);
    local.x * b1 + local.y * b2 + local.z * n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sampling::{hammersley, uniform_sphere};

    /// Largest entry of |M Mᵀ - I|, and of b1 × b2 - n, in `f64`.
    fn error((b1, b2): (DVec3, DVec3), n: DVec3) -> f64 {
        let dots = [
            b1.dot(b2),
            b1.dot(n),
            b2.dot(n),
            b1.dot(b1) - 1.0,
            b2.dot(b2) - 1.0,
        ];
        let handed = (b1.cross(b2) - n).abs().max_element();
        dots.into_iter().fold(handed, |worst, d| worst.max(d.abs()))
    }

    fn wide((a, b): (Vec3, Vec3)) -> (DVec3, DVec3) {
        (a.as_dvec3(), b.as_dvec3())
    }

    #[test]
    fn duff_is_orthonormal_and_right_handed_everywhere() {
        let (mut worst, mut worst_f32) = (0.0f64, 0.0f64);
        for i in 0..20_000 {
            let n = uniform_sphere(hammersley(i, 20_000));
            let single = n.as_vec3().normalize();
            worst = worst.max(error(duff(n), n));
            worst_f32 = worst_f32.max(error(wide(duff_f32(single)), single.as_dvec3()));
        }
        println!("duff on 20000 normals: f64 {worst:e}, f32 {worst_f32:e}");
        assert!(worst < 1e-14 && worst_f32 < 1e-6, "{worst:e} {worst_f32:e}");
    }

    #[test]
    fn duff_holds_at_and_near_minus_z_where_frisvad_fails() {
        for tilt in [0.0f32, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2] {
            let n = Vec3::new(tilt, 0.3 * tilt, -1.0).normalize();
            assert!(error(wide(duff_f32(n)), n.as_dvec3()) < 1e-6, "{tilt}");
        }
        let (b1, _) = frisvad_raw_f32(Vec3::NEG_Z);
        assert!(!b1.is_finite());
        assert!(error(frisvad(DVec3::NEG_Z), DVec3::NEG_Z) < 1e-15);
        let near = Vec3::new(1e-3, 0.0, -1.0).normalize();
        assert!(error(wide(frisvad_f32(near)), near.as_dvec3()) > 1e-5);
    }

    #[test]
    fn both_agree_on_the_upper_hemisphere() {
        let n = DVec3::new(0.3, -0.4, 0.5).normalize();
        let ((a, b), (c, d)) = (duff(n), frisvad(n));
        assert!((a - c).length() < 1e-15 && (b - d).length() < 1e-15);
        assert_eq!(to_world(DVec3::Z, n), n);
    }
}
