//! Drawing on a finished picture: rectangles and text of a bitmap font.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Font weight of the labels.
const WEIGHT: FontWeight = FontWeight::Regular;
/// Font height of the labels.
const HEIGHT: RasterHeight = RasterHeight::Size16;
/// Width and height of a character, pixels.
pub(super) const LETTER: [i32; 2] = [get_raster_width(WEIGHT, HEIGHT) as i32, HEIGHT.val() as i32];
/// Colour of panels, sRGB.
pub(super) const PANEL: [u8; 3] = [24; 3];
/// Colour of text and ticks, sRGB.
pub(super) const INK: [u8; 3] = [255; 3];
/// Space between the parts, pixels.
pub(super) const GAP: i32 = 8;
/// Picture height at which text is drawn at twice its size, pixels; at twice this height it is tripled, and so on.
const HEIGHT_OF_ONE: u32 = 900;

/// Pixels of a unit in a picture of this height.
pub(super) fn zoom(height: u32) -> u32 {
    (height / HEIGHT_OF_ONE + 1).min(8)
}

/// A rectangle: left, top, width, height.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rectangle {
    pub x: i32,
    pub y: i32,
    pub width: i32,
    pub height: i32,
}

/// The picture as a canvas in units of `zoom` pixels.
pub(super) struct Canvas<'p> {
    rgba: &'p mut [u8],
    width: u32,
    /// Edge of a unit, pixels.
    pub zoom: u32,
    /// Width and height in units.
    pub size: [i32; 2],
}

impl<'p> Canvas<'p> {
    /// Of a picture: rows from the top, four bytes per pixel, sRGB.
    pub fn new(rgba: &'p mut [u8], size: [u32; 2]) -> Self {
        Self::zoomed(rgba, size, zoom(size[1]))
    }

    /// With units of this many pixels.
    pub fn zoomed(rgba: &'p mut [u8], [width, height]: [u32; 2], zoom: u32) -> Self {
        Self {
            rgba,
            width,
            zoom,
            size: [width, height].map(|edge| (edge / zoom) as i32),
        }
    }

    /// Blends a colour over one unit, with `alpha` in 0..=255. Units outside the picture are ignored.
    fn blend(&mut self, x: i32, y: i32, colour: [u8; 3], alpha: u8) {
        if !(0..self.size[0]).contains(&x) || !(0..self.size[1]).contains(&y) {
            return;
        }
        let mix = |old: u8, new: u8| {
            let [old, new, alpha] = [old, new, alpha].map(u32::from);
            ((old * (255 - alpha) + new * alpha + 127) / 255) as u8
        };
        let (x, y) = (x as u32 * self.zoom, y as u32 * self.zoom);
        for row in y..y + self.zoom {
            for column in x..x + self.zoom {
                let first = 4 * (row as usize * self.width as usize + column as usize);
                for (old, new) in self.rgba[first..first + 3].iter_mut().zip(colour) {
                    *old = mix(*old, new);
                }
            }
        }
    }

    /// Fills a rectangle with an sRGB colour.
    pub fn fill(&mut self, area: Rectangle, colour: [u8; 3]) {
        for y in area.y..area.y + area.height {
            for x in area.x..area.x + area.width {
                self.blend(x, y, colour, 255);
            }
        }
    }

    /// Draws text from its upper left corner. Characters missing from the font are left blank.
    pub fn text(&mut self, x: i32, y: i32, text: &str) {
        for (character, left) in text.chars().zip((x..).step_by(LETTER[0] as usize)) {
            let Some(raster) = get_raster(character, WEIGHT, HEIGHT) else {
                continue;
            };
            for (row, alphas) in (y..).zip(raster.rows()) {
                for (column, alpha) in (left..).zip(alphas) {
                    self.blend(column, row, INK, *alpha);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_character_of_the_labels() {
        let text = "0123456789.e-,:;+()cd/m²lux° sunhigazbow";
        for character in text.chars() {
            assert!(
                get_raster(character, WEIGHT, HEIGHT).is_some(),
                "{character}"
            );
        }
    }
}
