//! How the sky's visibility in the dome's directions is found: by shadow maps of the whole scene, or by rays through its hierarchy.
//!
//! A map costs its triangles, whatever the size of the picture; rays cost the pixels, whatever the number of triangles.
//! Both sample the same directions, so they converge alike, but a map loses what is smaller than its texels.

/// How the sky's visibility is found in the directions of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DomeBy {
    /// What costs less, by the numbers of triangles and pixels, where maps are fine enough: the same for the same scene and options on every
    /// device, but for those that are short of raster units.
    #[default]
    Auto,
    /// A shadow map for each direction.
    Maps,
    /// A ray from each pixel in each direction; maps hold cut-outs and panes of glass alone, if there are any.
    Rays,
}

/// Costs of a map, in that of a pixel's ray.
struct Costs {
    triangle: f64,
    texel: f64,
}

/// On lavapipe a million triangles take some 100 ms of CPU time more than none, and rays 33 ms for 230 400 pixels. Texels are left out: they are
/// a constant that is small where either way is expensive.
const USUAL: Costs = Costs {
    triangle: 0.7,
    texel: 0.0,
};

/// Where raster units are few. On an NVIDIA H200 921 600 rays take 0.11 ms; a map of 1024² texels takes 0.33 ms
/// with 96 000 triangles, and each further texel 0.2 ns.
const FEW_RASTER_UNITS: Costs = Costs {
    triangle: 10.0,
    texel: 1.7,
};

/// Coarsest texel of the maps, metres: the shade of what is thinner than two of them is lost, and people look at eaves, rails and steps of a
/// decimetre.
const COARSEST: f32 = 0.05;

/// What the choice depends on.
#[derive(Debug, Clone, Copy)]
pub struct Work {
    /// Number of triangles of opaque casters.
    pub triangles: usize,
    /// Number of pixels of the whole picture.
    pub pixels: u64,
    /// Number of texels of a map.
    pub texels: u64,
    /// Edge of a texel of a map of all casters, metres.
    pub texel: f32,
    /// Whether the device is short of raster units.
    pub is_short_of_raster_units: bool,
}

impl DomeBy {
    /// Maps or rays.
    #[must_use]
    pub fn chosen(self, work: Work) -> Self {
        let costs = if work.is_short_of_raster_units {
            FEW_RASTER_UNITS
        } else {
            USUAL
        };
        let map = costs.triangle * work.triangles as f64 + costs.texel * work.texels as f64;
        let is_cheaper = map > work.pixels as f64;
        match self {
            Self::Auto if is_cheaper || work.texel > COARSEST => Self::Rays,
            Self::Auto => Self::Maps,
            asked => asked,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(triangles: usize, pixels: u64) -> Work {
        Work {
            triangles,
            pixels,
            texels: 1 << 20,
            texel: 0.02,
            is_short_of_raster_units: false,
        }
    }

    #[test]
    fn many_triangles_take_rays_and_many_pixels_maps() {
        let auto = |triangles, pixels| DomeBy::Auto.chosen(work(triangles, pixels));
        let (small, large) = (640 * 360, 3840 * 2160);
        assert_eq!(auto(2_000, small), DomeBy::Maps);
        assert_eq!(auto(871_000, small), DomeBy::Rays);
        assert_eq!(auto(871_000, large), DomeBy::Maps);
        assert_eq!(auto(20_000_000, large), DomeBy::Rays);
    }

    #[test]
    fn devices_short_of_raster_units_take_rays_sooner() {
        let auto = |triangles, pixels| {
            DomeBy::Auto.chosen(Work {
                is_short_of_raster_units: true,
                ..work(triangles, pixels)
            })
        };
        assert_eq!(auto(2_000, 1280 * 720), DomeBy::Rays);
        assert_eq!(auto(2_000, 3840 * 2160), DomeBy::Maps);
        assert_eq!(auto(871_000, 3840 * 2160), DomeBy::Rays);
    }

    #[test]
    fn coarse_maps_make_way_for_rays() {
        let auto = |texel| {
            DomeBy::Auto.chosen(Work {
                texel,
                ..work(2_000, 640 * 360)
            })
        };
        // A house of 30 m, and an island of 200 m, in maps of 1024 texels.
        assert_eq!(auto(30.0 / 1024.0), DomeBy::Maps);
        assert_eq!(auto(200.0 / 1024.0), DomeBy::Rays);
    }

    #[test]
    fn what_is_asked_for_is_taken() {
        for by in [DomeBy::Maps, DomeBy::Rays] {
            assert_eq!(by.chosen(work(0, 1 << 20)), by);
            assert_eq!(by.chosen(work(1 << 30, 1)), by);
        }
    }
}
