//! Drawings of plans, heat maps and reports: one list of shapes, as SVG text ([`svg`]) or as pixels ([`pixels`]).
//!
//! Coordinates are pixels of the drawing, x to the right, y down.

mod pixels;
mod svg;

use std::path::Path;

use glam::DVec3;

pub(crate) use self::svg::escaped;

use super::png::{Effort, Encoding, write_png};
use super::{write_error, write_text};
use crate::daylight::colour::srgb_oetf;
use crate::error::Result;

/// Pixels of a PNG for one of the drawing: its letters are of the heights 24 and 32.
const SCALE: u32 = 2;

/// Largest edge of a PNG, pixels.
const MOST_PIXELS: u32 = 16_384;

/// A colour, sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Ink(pub [u8; 3]);

impl Ink {
    /// Letters, outlines.
    pub const BLACK: Self = Self([0; 3]);
    /// Paper.
    pub const WHITE: Self = Self([255; 3]);
    /// Auxiliary lines.
    pub const GREY: Self = Self([128; 3]);

    /// Of a linear BT.709 colour, 0..1.
    pub fn of(linear: DVec3) -> Self {
        Self(
            linear
                .to_array()
                .map(|v| (255.0 * srgb_oetf(v)).round() as u8),
        )
    }
}

impl std::fmt::Display for Ink {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

/// Height of letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// 12 pixels.
    Small,
    /// 16 pixels.
    Large,
}

impl Size {
    /// Pixels.
    pub fn pixels(self) -> f64 {
        match self {
            Self::Small => 12.0,
            Self::Large => 16.0,
        }
    }
}

/// Which point of a text its place is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// Connected straight lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Runs of points.
    pub runs: Vec<Vec<[f64; 2]>>,
    /// Colour.
    pub ink: Ink,
    /// Width, pixels.
    pub width: f64,
    /// Length of dashes and gaps, pixels; 0 for none.
    pub dash: f64,
    /// What it shows: the class of the element.
    pub name: &'static str,
}

/// Rectangles of one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    /// Left, top, width, height of each.
    pub areas: Vec<[f64; 4]>,
    /// Colour.
    pub ink: Ink,
    /// What a reader sees who points at it; may be empty.
    pub title: String,
    /// What it shows: the class of the element.
    pub name: &'static str,
}

/// A filled polygon. Its edges are sharp: neighbours meet without a seam.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Its corners.
    pub corners: Vec<[f64; 2]>,
    /// Colour.
    pub ink: Ink,
    /// What a reader sees who points at it; may be empty.
    pub title: String,
    /// What it shows: the class of the element.
    pub name: &'static str,
}

/// A line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// Its anchor: x, and y of the baseline.
    pub at: [f64; 2],
    /// Where that is.
    pub anchor: Anchor,
    /// Height of letters.
    pub size: Size,
    /// Colour.
    pub ink: Ink,
    /// Whether it has a white rim, to be read on colours.
    pub is_rimmed: bool,
    /// The words.
    pub words: String,
}

/// A part of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// Rectangles.
    Fill(Fill),
    /// Lines.
    Stroke(Stroke),
    /// A polygon.
    Shape(Shape),
    /// Text.
    Text(Text),
}

/// Shapes on white paper, later ones over earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Width and height, pixels.
    pub size: [f64; 2],
    /// What it shows, in one line.
    pub title: String,
    /// The shapes.
    pub parts: Vec<Part>,
}

impl Drawing {
    /// Empty paper.
    pub fn new(size: [f64; 2], title: String) -> Self {
        Self {
            size,
            title,
            parts: Vec::new(),
        }
    }

    /// Adds black text.
    pub fn text(&mut self, at: [f64; 2], anchor: Anchor, size: Size, words: impl Into<String>) {
        self.parts.push(Part::Text(Text {
            at,
            anchor,
            size,
            ink: Ink::BLACK,
            is_rimmed: false,
            words: words.into(),
        }));
    }

    /// Adds a line.
    pub fn line(&mut self, run: Vec<[f64; 2]>, ink: Ink, width: f64) {
        self.parts.push(Part::Stroke(Stroke {
            runs: vec![run],
            ink,
            width,
            dash: 0.0,
            name: "line",
        }));
    }

    /// Writes it: SVG, or PNG by the extension `.png`.
    ///
    /// # Errors
    /// The file cannot be written, or the drawing is too large for a PNG.
    pub fn write(&self, path: &Path) -> Result<()> {
        let is_png = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        if !is_png {
            return write_text(path, &self.svg());
        }
        let largest = self.size[0].max(self.size[1]) * f64::from(SCALE);
        if largest > f64::from(MOST_PIXELS) {
            return Err(write_error(
                path,
                "too many plans for one PNG; write .svg instead",
            ));
        }
        let (size, rgba) = self.pixels(SCALE);
        let how = (Encoding::Srgb, Effort::Small);
        write_png(path, size, &rgba, how, &Vec::new())
    }
}
