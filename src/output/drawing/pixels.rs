//! A drawing as pixels: shapes by `tiny-skia`, letters of the bitmap font of the legend.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Rect, StrokeDash, Transform,
};

use super::{Anchor, Drawing, Fill, Ink, Part, Shape, Size, Stroke, Text};

/// Weight of letters.
const WEIGHT: FontWeight = FontWeight::Regular;

/// Part of a letter's height that is above its baseline.
const ASCENT: f64 = 0.78;

impl Drawing {
    /// Size and rows from the top, four bytes per pixel, sRGB: `scale` pixels for one of the drawing.
    pub fn pixels(&self, scale: u32) -> ([u32; 2], Vec<u8>) {
        let size = self
            .size
            .map(|edge| ((edge * f64::from(scale)).ceil() as u32).max(1));
        let Some(mut map) = Pixmap::new(size[0], size[1]) else {
            return (size, vec![255; 4 * size[0] as usize * size[1] as usize]);
        };
        map.fill(tiny_skia::Color::WHITE);
        let scale = f64::from(scale);
        for part in &self.parts {
            match part {
                Part::Fill(fill) => draw_fill(&mut map, fill, scale),
                Part::Stroke(stroke) => draw_stroke(&mut map, stroke, scale),
                Part::Shape(shape) => draw_shape(&mut map, shape, scale),
                Part::Text(text) => draw_text(&mut map, text, scale),
            }
        }
        // The paper is opaque, so alpha is 255 everywhere and nothing is premultiplied.
        (size, map.take())
    }
}

fn paint(ink: Ink) -> Paint<'static> {
    let mut paint = Paint::default();
    let [r, g, b] = ink.0;
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

/// Whole pixels, so that neighbours meet without a seam.
fn draw_fill(map: &mut Pixmap, fill: &Fill, scale: f64) {
    let mut paint = paint(fill.ink);
    paint.anti_alias = false;
    for [x, y, width, height] in &fill.areas {
        let edges = [*x, *y, x + width, y + height].map(|v| (v * scale).round() as f32);
        if let Some(area) = Rect::from_ltrb(edges[0], edges[1], edges[2], edges[3]) {
            map.fill_rect(area, &paint, Transform::identity(), None);
        }
    }
}

fn draw_stroke(map: &mut Pixmap, stroke: &Stroke, scale: f64) {
    let mut path = PathBuilder::new();
    for run in &stroke.runs {
        for (at, point) in run.iter().enumerate() {
            let [x, y] = point.map(|v| (v * scale) as f32);
            if at == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
    }
    let Some(path) = path.finish() else { return };
    let length = (stroke.dash * scale) as f32;
    let how = tiny_skia::Stroke {
        width: (stroke.width * scale) as f32,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        dash: (length > 0.0)
            .then(|| StrokeDash::new(vec![length, length], 0.0))
            .flatten(),
        ..tiny_skia::Stroke::default()
    };
    map.stroke_path(&path, &paint(stroke.ink), &how, Transform::identity(), None);
}

fn draw_shape(map: &mut Pixmap, shape: &Shape, scale: f64) {
    let mut path = PathBuilder::new();
    for (at, corner) in shape.corners.iter().enumerate() {
        let [x, y] = corner.map(|v| (v * scale) as f32);
        if at == 0 {
            path.move_to(x, y);
        } else {
            path.line_to(x, y);
        }
    }
    path.close();
    if let Some(path) = path.finish() {
        let mut paint = paint(shape.ink);
        paint.anti_alias = false;
        map.fill_path(
            &path,
            &paint,
            FillRule::Winding,
            Transform::identity(),
            None,
        );
    }
}

/// The height of letters nearest to a size.
fn letters(size: Size, scale: f64) -> RasterHeight {
    match (size.pixels() * scale) as u32 {
        0..20 => RasterHeight::Size16,
        20..28 => RasterHeight::Size24,
        _ => RasterHeight::Size32,
    }
}

fn draw_text(map: &mut Pixmap, text: &Text, scale: f64) {
    let height = letters(text.size, scale);
    let step = get_raster_width(WEIGHT, height) as i32;
    let width = step * text.words.chars().count() as i32;
    let [x, y] = text.at.map(|v| v * scale);
    let left = match text.anchor {
        Anchor::Start => x,
        Anchor::Middle => x - f64::from(width) / 2.0,
        Anchor::End => x - f64::from(width),
    };
    let corner = [
        left.round() as i32,
        (y - ASCENT * height.val() as f64).round() as i32,
    ];
    if text.is_rimmed {
        let reach = scale.round() as i32;
        for [dx, dy] in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [dx * reach, dy * reach])) {
            let at = [corner[0] + dx, corner[1] + dy];
            draw_letters(map, &text.words, at, (height, Ink::WHITE));
        }
    }
    draw_letters(map, &text.words, corner, (height, text.ink));
}

/// Blends letters from their upper left corner; one that the font lacks is drawn as "?".
fn draw_letters(
    map: &mut Pixmap,
    words: &str,
    corner: [i32; 2],
    (height, ink): (RasterHeight, Ink),
) {
    let (width, rows) = (map.width() as i32, map.height() as i32);
    let step = get_raster_width(WEIGHT, height);
    for (letter, left) in words.chars().zip((corner[0]..).step_by(step)) {
        let raster = get_raster(letter, WEIGHT, height).or_else(|| get_raster('?', WEIGHT, height));
        let Some(raster) = raster else { continue };
        for (y, alphas) in (corner[1]..).zip(raster.rows()) {
            for (x, alpha) in (left..).zip(alphas) {
                if (0..width).contains(&x) && (0..rows).contains(&y) {
                    let first = 4 * (y * width + x) as usize;
                    let pixel = map.data_mut()[first..].iter_mut();
                    for (old, new) in pixel.zip(ink.0) {
                        let [o, n, a] = [*old, new, *alpha].map(u32::from);
                        *old = ((o * (255 - a) + n * a + 127) / 255) as u8;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_have_the_colours_of_the_shapes() {
        let mut drawing = Drawing::new([50.0, 40.0], String::new());
        drawing.parts.push(Part::Fill(Fill {
            areas: vec![[10.0, 10.0, 10.0, 5.0]],
            ink: Ink([200, 10, 30]),
            title: String::new(),
            name: "cell",
        }));
        drawing.line(vec![[30.0, 0.0], [30.0, 40.0]], Ink([0, 0, 255]), 4.0);
        drawing.parts.push(Part::Shape(Shape {
            corners: vec![[40.0, 20.0], [50.0, 20.0], [50.0, 30.0]],
            ink: Ink([0, 128, 0]),
            title: String::new(),
            name: "north",
        }));
        let ([width, height], rgba) = drawing.pixels(2);
        assert_eq!([width, height], [100, 80]);
        let at = |x: f64, y: f64| {
            let first = 4 * ((2.0 * y) as usize * 100 + (2.0 * x) as usize);
            [0, 1, 2].map(|i| rgba[first + i])
        };
        assert_eq!(at(10.0, 10.0), [200, 10, 30]);
        assert_eq!(at(19.5, 14.5), [200, 10, 30]);
        assert_eq!(at(20.0, 14.5), [255; 3]);
        assert_eq!(at(30.0, 20.0), [0, 0, 255]);
        assert_eq!(at(48.0, 22.0), [0, 128, 0]);
        assert_eq!(at(42.0, 28.0), [255; 3]);
    }

    #[test]
    fn letters_stand_on_their_baseline() {
        for (size, anchor) in [
            (Size::Small, Anchor::Start),
            (Size::Large, Anchor::Middle),
            (Size::Large, Anchor::End),
        ] {
            let mut drawing = Drawing::new([60.0, 40.0], String::new());
            drawing.text([30.0, 25.0], anchor, size, "HE");
            let ([width, _], rgba) = drawing.pixels(2);
            let inked = rgba.chunks(4).enumerate().filter(|(_, p)| p[0] < 100);
            let places: Vec<[usize; 2]> = inked
                .map(|(at, _)| [at % width as usize, at / width as usize])
                .collect();
            let bottom = places.iter().map(|p| p[1]).max().expect("ink") + 1;
            assert!(bottom.abs_diff(50) <= 1, "{bottom}");
            let top = places.iter().map(|p| p[1]).min().expect("ink");
            let height = 2.0 * size.pixels();
            let capital = (bottom - top) as f64 / height;
            assert!((0.5..0.8).contains(&capital), "{capital}");
            let middle = places.iter().map(|p| p[0]).sum::<usize>() / places.len();
            match anchor {
                Anchor::Start => assert!(middle > 60),
                Anchor::Middle => assert!(middle.abs_diff(60) < 6, "{middle}"),
                Anchor::End => assert!(middle < 60),
            }
        }
    }
}
