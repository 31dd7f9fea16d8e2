//! What passes depend on of a scene, without its data.

use crate::passes::surfaces::geometry::{EmissionSource, Kind};
use crate::scene::Bounds;

/// What passes are created from, of a scene. Unlike the geometry it may go to another thread, which makes passes while frames are drawn.
#[derive(Debug, Clone)]
pub struct Facts {
    /// Bounding box of the scene.
    pub bounds: Bounds,
    /// Bounding box of all shadow casters.
    pub casters: Bounds,
    /// The kinds of the parts, in draw order.
    pub kinds: Vec<Kind>,
    /// Where L_e of a pixel is.
    pub emission_source: EmissionSource,
    /// Whether there are panes of glass.
    pub has_panes: bool,
    /// Whether any material has a ρ_s.
    pub is_specular: bool,
    /// Whether any material reflects by GGX.
    pub is_rough: bool,
    /// Triangles of all opaque casters without holes.
    pub casting_triangles: usize,
    /// Whether surfaces without maps are drawn by the numbers of their triangles, see `triangles.rs`.
    pub is_numbered: bool,
}

impl Facts {
    /// Whether ρ_d, the factor on ρ_s or metalness and roughness vary within any material, or L_e does, which is stored beside them.
    pub fn has_albedo(&self) -> bool {
        let varies = |k: &Kind| k.diffuse_map || k.specular_map || k.emissive_map || k.colours;
        self.kinds.iter().any(varies)
    }

    /// Whether any surface has holes by its alpha.
    pub fn has_cut_outs(&self) -> bool {
        self.kinds.iter().any(|kind| kind.cut_out)
    }
}
