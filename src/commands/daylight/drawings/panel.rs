//! A piece of a plane on paper: metres to pixels.

use glam::DVec2;

use crate::output::{Anchor, Drawing, Ink, Size};

/// Space around the cells, metres and as part of their extent.
const AROUND: [f64; 2] = [0.4, 0.05];

/// Length of the scale bar at most, pixels.
const BAR: f64 = 110.0;

/// A rectangle of a plane and its place on paper.
pub struct Panel {
    least: DVec2,
    most: DVec2,
    /// Upper left corner, pixels.
    corner: [f64; 2],
    /// Pixels of a metre.
    scale: f64,
}

impl Panel {
    /// Around some cells, at so many pixels a metre.
    pub fn around(cells: &[[DVec2; 4]], corner: [f64; 2], scale: f64) -> Self {
        let [least, most] = bounds(cells);
        Self {
            scale,
            least,
            most,
            corner,
        }
    }

    /// Longer edge of the panel around some cells, metres.
    pub fn edge(cells: &[[DVec2; 4]]) -> f64 {
        let [least, most] = bounds(cells);
        (most - least).max_element()
    }

    /// A place on paper.
    pub fn point(&self, place: DVec2) -> [f64; 2] {
        let own = (place - self.least) * self.scale;
        let height = (self.most.y - self.least.y) * self.scale;
        [self.corner[0] + own.x, self.corner[1] + height - own.y]
    }

    /// Its lower edge, pixels.
    pub fn bottom(&self) -> f64 {
        self.point(self.least)[1]
    }

    /// Its right edge, pixels.
    pub fn right(&self) -> f64 {
        self.point(self.most)[0]
    }

    /// The part of a line within the panel, on paper (Liang & Barsky 1984); `None` for points.
    pub fn clipped(&self, [from, to]: [DVec2; 2]) -> Option<Vec<[f64; 2]>> {
        let along = to - from;
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            for (step, room) in [
                (-along[axis], from[axis] - self.least[axis]),
                (along[axis], self.most[axis] - from[axis]),
            ] {
                if step == 0.0 && room < 0.0 {
                    return None;
                }
                if step < 0.0 {
                    first = first.max(room / step);
                } else if step > 0.0 {
                    last = last.min(room / step);
                }
            }
        }
        let is_seen = first < last && along.length() > 1e-6;
        is_seen.then(|| {
            [first, last]
                .map(|share| self.point(from.lerp(to, share)))
                .to_vec()
        })
    }

    /// Draws a bar of a round length.
    pub fn draw_bar(&self, drawing: &mut Drawing, [x, y]: [f64; 2]) {
        let metres = BAR / self.scale;
        let decade = 10f64.powf(metres.log10().floor());
        let digit = [5.0, 2.0].into_iter().find(|d| d * decade <= metres);
        let metres = digit.unwrap_or(1.0) * decade;
        let end = x + metres * self.scale;
        for run in [
            vec![[x, y], [end, y]],
            vec![[x, y - 5.0], [x, y + 5.0]],
            vec![[end, y - 5.0], [end, y + 5.0]],
        ] {
            drawing.line(run, Ink::BLACK, 1.5);
        }
        let middle = [(x + end) / 2.0, y - 7.0];
        drawing.text(middle, Anchor::Middle, Size::Small, format!("{metres} m"));
    }
}

/// Least and largest coordinates of some cells, with space around.
fn bounds(cells: &[[DVec2; 4]]) -> [DVec2; 2] {
    let corners = || cells.iter().flatten().copied();
    let least = corners().reduce(DVec2::min).unwrap_or_default();
    let most = corners().reduce(DVec2::max).unwrap_or_default();
    let around = AROUND[0] + AROUND[1] * (most - least).max_element();
    [least - around, most + around]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> Panel {
        // 10 m with 0.9 m around.
        let cell = [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [0.0, 4.0]].map(DVec2::from);
        assert!((Panel::edge(&[cell]) - 11.8).abs() < 1e-12);
        Panel::around(&[cell], [5.0, 7.0], 10.0)
    }

    #[test]
    fn up_is_up_and_a_metre_has_its_pixels() {
        let panel = panel();
        let [x, y] = panel.point(DVec2::new(-0.9, 4.9));
        assert!((x - 5.0).abs() < 1e-9 && (y - 7.0).abs() < 1e-9);
        let [x, y] = panel.point(DVec2::new(9.1, -0.1));
        assert!((x - 105.0).abs() < 1e-9 && (y - 57.0).abs() < 1e-9);
        assert!((panel.bottom() - 65.0).abs() < 1e-9);
    }

    #[test]
    fn lines_end_at_the_edge() {
        let panel = panel();
        let line = panel.clipped([DVec2::new(-100.0, 2.0), DVec2::new(100.0, 2.0)]);
        let line = line.expect("a line");
        assert!((line[0][0] - 5.0).abs() < 1e-9 && (line[1][0] - 123.0).abs() < 1e-9);
        assert!(
            panel
                .clipped([DVec2::new(20.0, 0.0), DVec2::new(20.0, 9.0)])
                .is_none()
        );
        assert!(
            panel
                .clipped([DVec2::new(-9.0, 0.0), DVec2::new(0.0, 99.0)])
                .is_none()
        );
        assert!(panel.clipped([DVec2::ONE, DVec2::ONE]).is_none());
    }
}
