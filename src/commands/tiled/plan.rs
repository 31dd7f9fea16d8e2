//! Layout of the tiles of an image. Arithmetic only.

use glam::{UVec2, Vec2};

use crate::passes::view::Window;

/// Largest image drawn in one piece, pixels: a little over 8K, at about 50 bytes per pixel.
const MAX_WHOLE_PIXELS: u64 = 36_000_000;
/// Largest overview that serves exposure only, pixels.
const MAX_EXPOSURE_PIXELS: u64 = 2_000_000;
/// Default tile edge, pixels.
const EDGE: u32 = 2048;
/// Border around a tile, pixels. It is drawn and discarded, since passes read neighbouring pixels.
const MARGIN: u32 = 4;
/// Alignment of tiles, pixels: a tile boundary cuts no block of a file.
const STEP: u32 = 16;

/// Extent of a tile along one axis, pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    /// First image pixel that the tile fills.
    pub first: u32,
    /// Number of image pixels that it fills.
    pub count: u32,
    /// First image pixel that is drawn.
    pub origin: u32,
}

/// An image divided into tiles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    /// Size of the whole image, pixels.
    pub full: UVec2,
    /// Size drawn for each tile, pixels.
    pub tile: UVec2,
    /// Tile columns.
    pub columns: Vec<Span>,
    /// Tile rows.
    pub bands: Vec<Span>,
    limit: u32,
}

impl Plan {
    /// `None` if the image can be drawn in one piece. `edge` is the requested tile edge, `limit` the largest image edge, pixels.
    pub fn new(full: UVec2, edge: Option<u32>, limit: u32) -> Option<Self> {
        let pixels = u64::from(full.x) * u64::from(full.y);
        let longest = full.max_element();
        let needs = longest > limit || (edge.is_none() && pixels > MAX_WHOLE_PIXELS);
        let asks = edge.is_some_and(|edge| longest > edge);
        if !needs && !asks {
            return None;
        }
        let most = limit.saturating_sub(2 * MARGIN + 1);
        let edge = edge.unwrap_or(EDGE).min(most);
        let edge = (edge / STEP * STEP).max(STEP);
        Some(Self {
            full,
            tile: UVec2::new(drawn(full.x, edge), drawn(full.y, edge)),
            columns: spans(full.x, edge),
            bands: spans(full.y, edge),
            limit,
        })
    }

    /// The overview: its size, the smallest integer divisor of the image size that makes it fit, and its window. `occludes`: it serves
    /// ambient occlusion, not just exposure.
    pub fn overview(&self, occludes: bool) -> (UVec2, u32, Window) {
        let most = if occludes {
            MAX_WHOLE_PIXELS
        } else {
            MAX_EXPOSURE_PIXELS
        };
        let fits = |size: UVec2| {
            size.max_element() <= self.limit && u64::from(size.x) * u64::from(size.y) <= most
        };
        let size = |k: u32| UVec2::new(self.full.x.div_ceil(k), self.full.y.div_ceil(k));
        let k = (1..).find(|k| fits(size(*k))).unwrap_or(1);
        let window = Window {
            origin: UVec2::ZERO,
            picture: self.full.as_vec2() / k as f32,
        };
        (size(k), k, window)
    }

    /// The part of the image that is drawn for a tile.
    pub fn window(&self, column: &Span, band: &Span) -> Window {
        Window {
            origin: UVec2::new(column.origin, band.origin),
            picture: Vec2::new(self.full.x as f32, self.full.y as f32),
        }
    }
}

/// Number of pixels drawn along an axis for a tile of `edge`. It is odd if `full` is, so that tiles start at even pixels: squares of
/// two by two pixels that share light are then those of the whole image.
fn drawn(full: u32, edge: u32) -> u32 {
    full.min(edge + 2 * MARGIN + full % 2)
}

/// Divides `full` pixels into spans of `edge`. Each draws the same number of pixels: at the ends of the image the margin is
/// shifted inward.
fn spans(full: u32, edge: u32) -> Vec<Span> {
    let drawn = drawn(full, edge);
    (0..full)
        .step_by(edge as usize)
        .map(|first| Span {
            first,
            count: edge.min(full - first),
            origin: first.saturating_sub(MARGIN).min(full - drawn),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once_and_see_around_it() {
        for (full, edge) in [
            (1, 64),
            (64, 64),
            (65, 64),
            (71, 64),
            (1000, 64),
            (32_768, 2048),
        ] {
            let spans = spans(full, edge);
            let drawn = drawn(full, edge);
            let mut next = 0;
            for span in &spans {
                assert_eq!(span.first, next);
                next += span.count;
                assert!(span.origin + drawn <= full && span.origin % 2 == 0);
                let (end, drawn_end) = (span.first + span.count, span.origin + drawn);
                assert!(
                    span.origin + MARGIN <= span.first || span.origin == 0,
                    "{span:?}"
                );
                assert!(
                    end + MARGIN <= drawn_end || drawn_end == full,
                    "{span:?} of {full}"
                );
            }
            assert_eq!(next, full);
        }
    }

    #[test]
    fn only_what_is_too_large_is_cut() {
        let plan = |w, h, edge| Plan::new(UVec2::new(w, h), edge, 16_384);
        assert_eq!(plan(1280, 720, None), None);
        assert_eq!(plan(7680, 4320, None), None);
        assert_eq!(plan(1280, 720, Some(2048)), None);
        assert!(
            plan(20_000, 100, None).is_some(),
            "wider than the device can do"
        );
        assert!(plan(20_000, 100, Some(16_384)).is_some());
        let large = plan(32_768, 32_768, None).expect("tiles");
        assert_eq!((large.columns.len(), large.bands.len()), (16, 16));
        let small = plan(300, 200, Some(100)).expect("tiles");
        assert_eq!(small.tile, UVec2::new(104, 104));
        assert!(small.bands.iter().all(|band| band.first % 16 == 0));
    }

    #[test]
    fn the_overview_is_the_picture_itself_where_that_fits() {
        let plan = |w, h| Plan::new(UVec2::new(w, h), Some(64), 16_384).expect("tiles");
        let (size, k, window) = plan(640, 360).overview(true);
        assert_eq!((size, k), (UVec2::new(640, 360), 1));
        assert_eq!(window.picture, Vec2::new(640.0, 360.0));
        let (size, k, window) = plan(32_768, 32_767).overview(true);
        assert_eq!(k, 6);
        assert!(size.as_vec2().cmpge(window.picture).all());
        let (size, _, _) = plan(32_768, 100).overview(true);
        assert!(size.x <= 16_384);
        let (size, _, _) = plan(8192, 8192).overview(false);
        assert!(size.x * size.y <= 2_000_000);
    }
}
