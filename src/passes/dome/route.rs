//! How the sky's visibility in the dome's directions is found: by shadow maps of the whole scene, or by rays through its hierarchy.
//!
//! A map costs its triangles, whatever the size of the picture; rays cost the pixels, whatever the number of triangles.
//! Both sample the same directions, so they converge alike.

/// How the sky's visibility is found in the directions of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DomeBy {
    /// What costs less, by the numbers of triangles and pixels: the same for the same scene and options on every device.
    #[default]
    Auto,
    /// A shadow map for each direction.
    Maps,
    /// A ray from each pixel in each direction; maps hold cut-outs and panes of glass alone, if there are any.
    Rays,
}

/// Cost of a triangle in a map, in that of a pixel's ray. On lavapipe a million triangles take some 100 ms of CPU time more than none, and rays
/// 33 ms for 230 400 pixels. Texels are left out: they are a constant that is small where either way is expensive.
const TRIANGLE: f64 = 0.7;

impl DomeBy {
    /// Maps or rays, for opaque casters of this many triangles and pictures of this many pixels.
    #[must_use]
    pub fn chosen(self, triangles: usize, pixels: u64) -> Self {
        match self {
            Self::Auto if TRIANGLE * triangles as f64 > pixels as f64 => Self::Rays,
            Self::Auto => Self::Maps,
            asked => asked,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_triangles_take_rays_and_many_pixels_maps() {
        let auto = |triangles, pixels| DomeBy::Auto.chosen(triangles, pixels);
        let (small, large) = (640 * 360, 3840 * 2160);
        assert_eq!(auto(2_000, small), DomeBy::Maps);
        assert_eq!(auto(871_000, small), DomeBy::Rays);
        assert_eq!(auto(871_000, large), DomeBy::Maps);
        assert_eq!(auto(20_000_000, large), DomeBy::Rays);
    }

    #[test]
    fn what_is_asked_for_is_taken() {
        for by in [DomeBy::Maps, DomeBy::Rays] {
            assert_eq!(by.chosen(0, 1 << 20), by);
            assert_eq!(by.chosen(1 << 30, 1), by);
        }
    }
}
