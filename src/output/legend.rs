//! The legend of a picture in false colours: a bar of the colours with round values beside it.

use std::convert::Infallible;

use embedded_graphics::mono_font::iso_8859_1::FONT_8X13;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Baseline, Text};

use crate::daylight::colour::srgb_oetf;
use crate::daylight::false_colour::{Quantity, Range, Tick};

/// Letters of the labels; it has ².
const FONT: &MonoFont<'_> = &FONT_8X13;
/// Between the parts, pixels.
const GAP: i32 = 8;
/// Width of the bar, pixels.
const BAR: i32 = 18;
/// Length of a tick, pixels.
const TICK: i32 = 5;
/// Height of a picture from which on the legend is drawn twice as large, and so on, pixels.
const HEIGHT_OF_ONE: u32 = 900;
/// Share of the picture's height that the legend takes, in tenths.
const TENTHS: i32 = 7;

/// Draws the legend of `range` at the right edge of `rgba`: rows from the top, four bytes a pixel, sRGB.
///
/// A picture that is too small for it stays as it is; returns whether there is a legend now.
pub fn draw_legend(rgba: &mut [u8], size: [u32; 2], quantity: Quantity, range: Range) -> bool {
    let mut canvas = Canvas::new(rgba, size);
    let layout = Layout::new(&canvas, quantity, &range);
    let fits = layout.is_within_picture();
    if fits {
        let Ok(()) = layout.draw(&mut canvas, &range);
    }
    fits
}

/// A picture to draw on, in units of `zoom` pixels.
struct Canvas<'p> {
    rgba: &'p mut [u8],
    width: u32,
    zoom: u32,
    size: Size,
}

impl<'p> Canvas<'p> {
    fn new(rgba: &'p mut [u8], [width, height]: [u32; 2]) -> Self {
        let zoom = (height / HEIGHT_OF_ONE + 1).min(8);
        Self {
            rgba,
            width,
            zoom,
            size: Size::new(width / zoom, height / zoom),
        }
    }
}

impl OriginDimensions for Canvas<'_> {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        let area = self.bounding_box();
        for Pixel(at, colour) in pixels {
            if !area.contains(at) {
                continue;
            }
            let (x, y) = (at.x as u32 * self.zoom, at.y as u32 * self.zoom);
            for row in y..y + self.zoom {
                for column in x..x + self.zoom {
                    let first = 4 * (row as usize * self.width as usize + column as usize);
                    let rgb = [colour.r(), colour.g(), colour.b()];
                    self.rgba[first..first + 3].copy_from_slice(&rgb);
                }
            }
        }
        Ok(())
    }
}

/// Where everything goes.
struct Layout {
    panel: Rectangle,
    bar: Rectangle,
    unit: &'static str,
    ticks: Vec<Tick>,
}

impl Layout {
    fn new(canvas: &Canvas<'_>, quantity: Quantity, range: &Range) -> Self {
        let letter = FONT.character_size;
        let (width, height) = (canvas.size.width as i32, canvas.size.height as i32);
        let bar_height = height * TENTHS / 10 - letter.height as i32;
        let ticks = legible(range.ticks(), bar_height, letter.height as i32);
        let unit = quantity.unit();
        let letters = ticks.iter().map(|t| t.label.len()).max().unwrap_or(0);
        // ² is one letter and two bytes.
        let text = letters.max(unit.chars().count()) as i32 * letter.width as i32;
        let panel = Size::new(
            (text + BAR + TICK + 4 * GAP) as u32,
            (bar_height.max(0) + 2 * letter.height as i32 + 3 * GAP) as u32,
        );
        let corner = Point::new(
            width - panel.width as i32 - GAP,
            (height - panel.height as i32) / 2,
        );
        let bar = Point::new(GAP, 2 * GAP + letter.height as i32) + corner;
        Self {
            panel: Rectangle::new(corner, panel),
            bar: Rectangle::new(bar, Size::new(BAR as u32, bar_height.max(0) as u32)),
            unit,
            ticks,
        }
    }

    /// With more of the picture beside it than under it.
    fn is_within_picture(&self) -> bool {
        let top_left = self.panel.top_left;
        let room = self.panel.size.width as i32;
        top_left.y >= 0 && top_left.x >= room && self.ticks.len() >= 2
    }

    fn draw(&self, canvas: &mut Canvas<'_>, range: &Range) -> Result<(), Infallible> {
        let fill = |colour| PrimitiveStyle::with_fill(colour);
        self.panel
            .into_styled(fill(Rgb888::new(24, 24, 24)))
            .draw(canvas)?;
        let style = MonoTextStyle::new(FONT, Rgb888::WHITE);
        let title = self.panel.top_left + Point::new(GAP, GAP);
        Text::with_baseline(self.unit, title, style, Baseline::Top).draw(canvas)?;
        self.draw_bar(canvas, range)?;
        let right = self.bar.top_left.x + BAR;
        for tick in &self.ticks {
            let y = self.height_of(tick.share);
            Rectangle::new(Point::new(right, y), Size::new(TICK as u32, 1))
                .into_styled(fill(Rgb888::WHITE))
                .draw(canvas)?;
            let text = Point::new(right + TICK + GAP / 2, y);
            Text::with_baseline(&tick.label, text, style, Baseline::Middle).draw(canvas)?;
        }
        Ok(())
    }

    /// One row at a time: the value in the middle of each.
    fn draw_bar(&self, canvas: &mut Canvas<'_>, range: &Range) -> Result<(), Infallible> {
        let rows = self.bar.size.height;
        for row in 0..rows {
            let share = 1.0 - (f64::from(row) + 0.5) / f64::from(rows);
            let value = range.min * (range.max / range.min).powf(share);
            let byte = |linear: f64| (srgb_oetf(linear) * 255.0).round() as u8;
            let [r, g, b] = range.colour(value).to_array().map(byte);
            let at = self.bar.top_left + Point::new(0, row as i32);
            canvas.fill_solid(
                &Rectangle::new(at, Size::new(BAR as u32, 1)),
                Rgb888::new(r, g, b),
            )?;
        }
        Ok(())
    }

    /// Row of a share of the range.
    fn height_of(&self, share: f64) -> i32 {
        let last = f64::from(self.bar.size.height.saturating_sub(1));
        self.bar.top_left.y + ((1.0 - share) * last).round() as i32
    }
}

/// All ticks where their labels have room, else the whole decades, else the ends.
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
    use crate::daylight::false_colour::turbo;

    const RANGE: Range = Range {
        min: 100.0,
        max: 1e5,
    };

    fn drawn(size: [u32; 2], range: Range) -> (bool, Vec<u8>) {
        let mut rgba = vec![7; 4 * (size[0] * size[1]) as usize];
        let is_drawn = draw_legend(&mut rgba, size, Quantity::Luminance, range);
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
                let (x, y) = (layout.bar.top_left.x + 3, layout.height_of(tick.share));
                let at = 4 * (y as u32 * canvas.zoom * size[0] + x as u32 * canvas.zoom) as usize;
                let expected = turbo(tick.share).map(|c| 255.0 * srgb_oetf(c));
                for (byte, expected) in rgba[at..at + 3].iter().zip(expected.to_array()) {
                    // The row's middle is half a row off, where blue grows fastest.
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
                let ticks = legible(range.ticks(), height, 13);
                for pair in ticks.windows(2) {
                    let apart = (pair[1].share - pair[0].share) * f64::from(height);
                    assert!(apart >= 13.0, "{pair:?}");
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
