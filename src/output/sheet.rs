//! A sheet of pictures of one size, with a title and captions.

use super::canvas::{Canvas, GAP, LETTER, PANEL, zoom};

/// Width and height of a sheet, and its rows from the top, four bytes per pixel.
pub type SheetPixels = ([u32; 2], Vec<u8>);

/// A picture of a sheet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// Rows from the top, four bytes per pixel, sRGB.
    pub rgba: Vec<u8>,
    /// Lines below the picture.
    pub caption: Vec<String>,
}

/// How a sheet is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SheetLayout {
    /// Width and height of each picture, pixels.
    pub picture: [u32; 2],
    /// Pictures in a row.
    pub columns: u32,
    /// Rows of pictures.
    pub rows: u32,
    /// Lines of the title.
    pub title_lines: u32,
    /// Lines of each caption.
    pub caption_lines: u32,
}

impl SheetLayout {
    /// Width over height of a picture.
    pub fn aspect(&self) -> f32 {
        let [width, height] = self.picture;
        width as f32 / height as f32
    }

    fn zoom(&self) -> u32 {
        zoom(self.picture[1])
    }

    /// Space between the parts, pixels.
    fn gap(&self) -> u32 {
        GAP.unsigned_abs() * self.zoom()
    }

    fn lines(&self, count: u32) -> u32 {
        count * LETTER[1].unsigned_abs() * self.zoom()
    }

    /// Distance from one picture to the next, pixels: whole units, so that text may stand at each of them.
    fn stride(&self) -> [u32; 2] {
        let whole = |pixels: u32| pixels.next_multiple_of(self.zoom());
        let [width, height] = self.picture;
        [
            whole(width) + self.gap(),
            whole(height) + self.lines(self.caption_lines) + 2 * self.gap(),
        ]
    }

    /// Upper left corner of a picture, pixels.
    fn corner(&self, column: u32, row: u32) -> [u32; 2] {
        let [x, y] = self.stride();
        let top = 2 * self.gap() + self.lines(self.title_lines);
        [self.gap() + column * x, top + row * y]
    }

    /// Width and height of the sheet, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.corner(self.columns, self.rows)
    }
}

/// Puts pictures, row after row, onto a sheet. Text that is too long for its place is cut.
pub fn compose(layout: &SheetLayout, title: &[String], cells: &[Cell]) -> SheetPixels {
    let size = layout.size();
    let mut rgba = [PANEL[0], PANEL[1], PANEL[2], 255].repeat(size[0] as usize * size[1] as usize);
    let corner = |at: usize| layout.corner(at as u32 % layout.columns, at as u32 / layout.columns);
    let bytes = 4 * layout.picture[0] as usize;
    for (at, cell) in cells.iter().enumerate() {
        let [x, y] = corner(at).map(|edge| edge as usize);
        for (row, pixels) in cell.rgba.chunks_exact(bytes).enumerate() {
            let first = 4 * ((y + row) * size[0] as usize + x);
            rgba[first..first + bytes].copy_from_slice(pixels);
        }
    }
    let zoom = layout.zoom();
    let mut canvas = Canvas::zoomed(&mut rgba, size, zoom);
    let unit = |pixels: u32| (pixels / zoom) as i32;
    let mut write = |[x, y]: [u32; 2], width: u32, lines: &[String]| {
        let letters = (unit(width) / LETTER[0]).max(0) as usize;
        for (line, top) in lines.iter().zip((unit(y)..).step_by(LETTER[1] as usize)) {
            let text: String = line.chars().take(letters).collect();
            canvas.text(unit(x), top, &text);
        }
    };
    let gap = layout.gap();
    write([gap, gap], size[0].saturating_sub(2 * gap), title);
    for (at, cell) in cells.iter().enumerate() {
        let [x, y] = corner(at);
        let below = y + layout.picture[1].next_multiple_of(zoom) + gap / 2;
        write([x, below], layout.picture[0], &cell.caption);
    }
    (size, rgba)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(picture: [u32; 2]) -> (SheetLayout, SheetPixels) {
        let layout = SheetLayout {
            picture,
            columns: 3,
            rows: 2,
            title_lines: 1,
            caption_lines: 2,
        };
        let cell = |shade: u8| Cell {
            rgba: vec![shade; 4 * (picture[0] * picture[1]) as usize],
            caption: vec!["09:00".to_owned(), "a line that is far too long".repeat(9)],
        };
        let cells: Vec<Cell> = (1..=6).map(|n| cell(40 * n)).collect();
        (layout, compose(&layout, &["title".to_owned()], &cells))
    }

    #[test]
    fn every_pixel_of_every_picture_is_in_its_place() {
        for picture in [[61, 33], [7, 5], [1001, 901]] {
            let (layout, (size, rgba)) = sheet(picture);
            assert_eq!(rgba.len(), 4 * (size[0] * size[1]) as usize);
            let mut seen = 0;
            for at in 0..6 {
                let [x, y] = layout.corner(at % 3, at / 3);
                for row in y..y + picture[1] {
                    let first = 4 * (row * size[0] + x) as usize;
                    let bytes = &rgba[first..first + 4 * picture[0] as usize];
                    assert!(bytes.iter().all(|byte| *byte == 40 * (at as u8 + 1)));
                    seen += bytes.len();
                }
            }
            assert_eq!(seen, 6 * 4 * (picture[0] * picture[1]) as usize);
        }
    }

    #[test]
    fn title_and_captions_are_written_below_and_above_and_nowhere_else() {
        let (layout, (size, rgba)) = sheet([61, 33]);
        let is_ink = |x: u32, y: u32| rgba[4 * (y * size[0] + x) as usize] > 200;
        let inked = |xs: std::ops::Range<u32>, ys: std::ops::Range<u32>| {
            ys.flat_map(|y| xs.clone().map(move |x| (x, y)))
                .filter(|(x, y)| is_ink(*x, *y))
                .count()
        };
        let [x, y] = layout.corner(0, 0);
        assert!(inked(0..size[0], 0..y) > 20, "the title");
        let below = y + 33;
        assert!(
            inked(x..x + 61, below..layout.corner(0, 1)[1]) > 20,
            "a caption"
        );
        // The sixth picture is brighter than the limit itself.
        let [next, _] = layout.corner(1, 0);
        assert_eq!(inked(x + 61..next, below..layout.corner(0, 1)[1]), 0);
    }
}
