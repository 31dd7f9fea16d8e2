//! Shadow maps of the dome's directions: tiles of one image.

use std::sync::Arc;

use crate::gpu::{Context, Format, Image, ImageDesc, Recorder, Result};

use crate::passes::dome::gather::DomeSettings;
use crate::passes::dome::route::DomeBy;
use crate::passes::sun_shadow::fit::ShadowView;
use crate::passes::sun_shadow::map::{Casters, Tile};
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::geometry::Geometry;

/// The maps and what draws into them.
pub(in crate::passes) struct DomeMaps {
    casters: Casters,
    atlas: Image,
    edge: u32,
    /// Tiles in a row of the atlas.
    columns: u32,
}

impl DomeMaps {
    /// Creates the maps; with rays only if there are cut-outs or panes of glass.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        facts: &Facts,
        settings: DomeSettings,
    ) -> Result<Option<Self>> {
        let mut casters = Casters::new(context, facts)?.with_panes(context, facts)?;
        if settings.by == DomeBy::Rays {
            casters = casters.without_solids();
        }
        if casters.is_empty() {
            return Ok(None);
        }
        let columns = f64::from(settings.directions).sqrt().ceil() as u32;
        let tiles = [columns, settings.directions.div_ceil(columns)];
        let size = tiles.map(|n| n * settings.map_edge);
        let desc = ImageDesc::flat("dome maps", Format::D32_SFLOAT, size);
        Ok(Some(Self {
            casters,
            atlas: Image::new(context, &desc)?,
            edge: settings.map_edge,
            columns,
        }))
    }

    /// First texel of the map of direction `k`, and its edge.
    pub fn window(&self, k: usize) -> [u32; 3] {
        let k = k as u32;
        let [x, y] = [k % self.columns, k / self.columns].map(|i| i * self.edge);
        [x, y, self.edge]
    }

    /// Draws the map of each direction.
    pub fn record(&self, recorder: &mut Recorder, geometry: &Geometry, views: &[ShadowView]) {
        let tile = |(k, view): (usize, &ShadowView)| {
            let [x, y, edge] = self.window(k);
            Tile {
                view: *view,
                mask: None,
                origin: [x, y],
                edge,
            }
        };
        let tiles: Vec<Tile> = views.iter().enumerate().map(tile).collect();
        self.casters
            .record(recorder, "dome maps", geometry, &tiles, &self.atlas);
    }

    /// The depths.
    pub fn image(&self) -> &Image {
        &self.atlas
    }
}
