//! The legend of a false-colour picture: a colour bar labelled with round values.

use super::canvas::{Canvas, GAP, INK, LETTER, PANEL, Rectangle};
use crate::daylight::colour::srgb_oetf;
use crate::daylight::false_colour::{Colours, Quantity, Range, Tick};

/// Width of the bar, pixels.
const BAR: i32 = 18;
/// Length of a tick, pixels.
const TICK: i32 = 5;
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
