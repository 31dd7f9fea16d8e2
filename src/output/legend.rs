//! The legend of a false-colour picture: a colour bar labelled with round values.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use crate::daylight::colour::srgb_oetf;
use crate::daylight::false_colour::{Colours, Quantity, Range, Tick};

/// Font weight of the labels.
const WEIGHT: FontWeight = FontWeight::Regular;
/// Font height of the labels.
const HEIGHT: RasterHeight = RasterHeight::Size16;
/// Width and height of a character, pixels.
const LETTER: [i32; 2] = [get_raster_width(WEIGHT, HEIGHT) as i32, HEIGHT.val() as i32];
/// Colour of the panel, sRGB.
const PANEL: [u8; 3] = [24; 3];
/// Colour of labels and ticks, sRGB.
const INK: [u8; 3] = [255; 3];
/// Space between the parts, pixels.
const GAP: i32 = 8;
/// Width of the bar, pixels.
const BAR: i32 = 18;
/// Length of a tick, pixels.
const TICK: i32 = 5;
/// Picture height at which the legend is drawn at twice its size, pixels; at twice this height it is tripled, and so on.
const HEIGHT_OF_ONE: u32 = 900;
/// Height of the legend, tenths of the picture's height.
const TENTHS: i32 = 7;

/// Draws the legend of `colours` at the right edge of `rgba`: rows from the top, four bytes per pixel, sRGB.
///
/// Returns whether the legend was drawn: a picture that is too small stays unchanged.
pub fn draw_legend(rgba: &mut [u8], size: [u32; 2], quantity: Quantity, colours: Colours) -> bool {
    let mut canvas = Canvas::new(rgba, size);
    let layout = Layout::new(&canvas, quantity, &colours.range);
    let fits = layout.is_within_picture();
    if fits {
        layout.draw(&mut canvas, &colours);
    }
    fits
}

/// A rectangle: left, top, width, height.
#[derive(Debug, Clone, Copy)]
struct Rectangle {
    x: i32,
    y: i32,
    width: i32,
    height: i32,
}

/// The picture as a canvas in units of `zoom` pixels.
struct Canvas<'p> {
    rgba: &'p mut [u8],
    width: u32,
    zoom: u32,
    size: [i32; 2],
}

impl<'p> Canvas<'p> {
    fn new(rgba: &'p mut [u8], [width, height]: [u32; 2]) -> Self {
        let zoom = (height / HEIGHT_OF_ONE + 1).min(8);
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

    fn fill(&mut self, area: Rectangle, colour: [u8; 3]) {
        for y in area.y..area.y + area.height {
            for x in area.x..area.x + area.width {
                self.blend(x, y, colour, 255);
            }
        }
    }

    /// Draws text from its upper left corner. Characters missing from the font are left blank.
    fn text(&mut self, x: i32, y: i32, text: &str) {
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

/// Positions of the parts.
struct Layout {
    panel: Rectangle,
    bar: Rectangle,
    unit: &'static str,
    ticks: Vec<Tick>,
}

impl Layout {
    fn new(canvas: &Canvas<'_>, quantity: Quantity, range: &Range) -> Self {
        let [width, height] = canvas.size;
        let bar_height = (height * TENTHS / 10 - LETTER[1]).max(0);
        let ticks = legible(range.ticks(), bar_height, LETTER[1]);
        let unit = quantity.unit();
        let letters = ticks.iter().map(|t| t.label.len()).max().unwrap_or(0);
        // Counts characters, not bytes: ² has two bytes.
        let text = letters.max(unit.chars().count()) as i32 * LETTER[0];
        let panel = [
            text + BAR + TICK + 4 * GAP,
            bar_height + 2 * LETTER[1] + 3 * GAP,
        ];
        let (x, y) = (width - panel[0] - GAP, (height - panel[1]) / 2);
        Self {
            panel: Rectangle {
                x,
                y,
                width: panel[0],
                height: panel[1],
            },
            bar: Rectangle {
                x: x + GAP,
                y: y + 2 * GAP + LETTER[1],
                width: BAR,
                height: bar_height,
            },
            unit,
            ticks,
        }
    }

    /// Whether the legend covers less than half of the picture's width.
    fn is_within_picture(&self) -> bool {
        self.panel.y >= 0 && self.panel.x >= self.panel.width && self.ticks.len() >= 2
    }

    fn draw(&self, canvas: &mut Canvas<'_>, colours: &Colours) {
        canvas.fill(self.panel, PANEL);
        canvas.text(self.panel.x + GAP, self.panel.y + GAP, self.unit);
        self.draw_bar(canvas, colours);
        let x = self.bar.x + BAR;
        for tick in &self.ticks {
            let y = self.height_of(tick.share);
            let mark = Rectangle {
                x,
                y,
                width: TICK,
                height: 1,
            };
            canvas.fill(mark, INK);
            canvas.text(x + TICK + GAP / 2, y - LETTER[1] / 2, &tick.label);
        }
    }

    /// Fills each row with the colour of the value at its centre.
    fn draw_bar(&self, canvas: &mut Canvas<'_>, colours: &Colours) {
        let rows = f64::from(self.bar.height);
        for row in 0..self.bar.height {
            let share = 1.0 - (f64::from(row) + 0.5) / rows;
            let byte = |linear: f64| (srgb_oetf(linear) * 255.0).round() as u8;
            let line = Rectangle {
                y: self.bar.y + row,
                height: 1,
                ..self.bar
            };
            canvas.fill(line, colours.map.colour(share).to_array().map(byte));
        }
    }

    /// Row of a position (0..1) on the scale.
    fn height_of(&self, share: f64) -> i32 {
        let last = f64::from((self.bar.height - 1).max(0));
        self.bar.y + ((1.0 - share) * last).round() as i32
    }
}

/// All ticks if their labels fit, else only decades, else only the ends.
fn legible(ticks: Vec<Tick>, height: i32, letter: i32) -> Vec<Tick> {
    let fit = |ticks: &[Tick]| {
        let mut gaps = ticks.windows(2).map(|pair| pair[1].share - pair[0].share);
        gaps.all(|gap| gap * f64::from(height) >= f64::from(letter))
    };
    if fit(&ticks) {
        return ticks;
    }
    let decades: Vec<Tick> = ticks
        .iter()
        .filter(|tick| tick.label.trim_start_matches(['0', '.']).starts_with('1'))
        .cloned()
        .collect();
    if decades.len() >= 2 && fit(&decades) {
        return decades;
    }
    let ends: Vec<Tick> = [ticks.first(), ticks.last()]
        .into_iter()
        .flatten()
        .cloned()
        .collect();
    if fit(&ends) { ends } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::false_colour::ColourMap;

    const RANGE: Range = Range {
        min: 100.0,
        max: 1e5,
    };

    fn drawn(size: [u32; 2], range: Range) -> (bool, Vec<u8>) {
        let colours = Colours {
            range,
            map: ColourMap::Turbo,
        };
        let mut rgba = vec![7; 4 * (size[0] * size[1]) as usize];
        let is_drawn = draw_legend(&mut rgba, size, Quantity::Luminance, colours);
        (is_drawn, rgba)
    }

    #[test]
    fn the_bar_has_the_colours_of_the_picture() {
        for size in [[640, 360], [1280, 720], [3840, 2160]] {
            let (is_drawn, rgba) = drawn(size, RANGE);
            assert!(is_drawn, "{size:?}");
            let mut canvas_pixels = rgba.clone();
            let canvas = Canvas::new(&mut canvas_pixels, size);
            let layout = Layout::new(&canvas, Quantity::Luminance, &RANGE);
            for tick in &layout.ticks {
                let (x, y) = (layout.bar.x + 3, layout.height_of(tick.share));
                let at = 4 * (y as u32 * canvas.zoom * size[0] + x as u32 * canvas.zoom) as usize;
                let expected = ColourMap::Turbo
                    .colour(tick.share)
                    .map(|c| 255.0 * srgb_oetf(c));
                for (byte, expected) in rgba[at..at + 3].iter().zip(expected.to_array()) {
                    // The row's centre is half a row off, which matters most where blue rises steeply.
                    assert!((f64::from(*byte) - expected).abs() < 12.0, "{tick:?}");
                }
            }
            assert!(layout.ticks.len() >= 4);
        }
    }

    #[test]
    fn the_font_has_every_character_of_the_labels() {
        let text = "0123456789.e-,cd/m²lux";
        for character in text.chars() {
            assert!(
                get_raster(character, WEIGHT, HEIGHT).is_some(),
                "{character}"
            );
        }
    }

    #[test]
    fn labels_do_not_touch() {
        for height in [40, 100, 200, 400, 800] {
            for range in [
                RANGE,
                Range {
                    min: 1e-3,
                    max: 1e5,
                },
                Range {
                    min: 120.0,
                    max: 130.0,
                },
            ] {
                let ticks = legible(range.ticks(), height, LETTER[1]);
                for pair in ticks.windows(2) {
                    let apart = (pair[1].share - pair[0].share) * f64::from(height);
                    assert!(apart >= f64::from(LETTER[1]), "{pair:?}");
                }
                assert!(height < 100 || ticks.len() >= 2, "{height} {range:?}");
            }
        }
    }

    #[test]
    fn a_small_picture_keeps_its_pixels() {
        for size in [[1, 1], [3, 900], [100, 50], [64, 64], [16384, 1]] {
            let (is_drawn, rgba) = drawn(size, RANGE);
            assert!(!is_drawn, "{size:?}");
            assert!(rgba.iter().all(|b| *b == 7));
        }
    }
}
