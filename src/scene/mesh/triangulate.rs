//! Triangulation of polygons: a fan for convex polygons, ear clipping in the polygon's plane otherwise.

use glam::{DVec2, DVec3};

/// Maximum number of corners for ear clipping; larger polygons become fans.
const MAX_CLIPPED: usize = 512;
/// Budget for ear clipping, comparisons per corner of a model. Real outlines need a few hundred.
const EFFORT: usize = 2_000;

/// Triangulates polygons with bounded effort, because ear clipping is cubic in the worst case.
#[derive(Debug)]
pub struct Triangulator {
    /// Comparisons left; at zero, polygons become fans.
    effort: usize,
}

impl Triangulator {
    /// Creates a triangulator for the polygons of one model, with this many corners in total.
    pub fn for_corners(corners: usize) -> Self {
        let effort = corners.saturating_mul(EFFORT).max(10_000_000);
        Self { effort }
    }

    /// Splits a polygon of n points into n − 2 triangles with the same winding, as point indices.
    ///
    /// Fewer than three points give no triangles. A polygon without a plane (all points collinear) gives degenerate triangles.
    pub fn triangulate(&mut self, points: &[DVec3]) -> Vec<[usize; 3]> {
        let n = points.len();
        if n < 3 {
            return Vec::new();
        }
        if n == 3 {
            return vec![[0, 1, 2]];
        }
        let flat = project(points);
        if n > MAX_CLIPPED || is_convex(&flat) {
            return fan(&(0..n).collect::<Vec<_>>());
        }
        self.clip_ears(&flat)
    }

    fn clip_ears(&mut self, flat: &[DVec2]) -> Vec<[usize; 3]> {
        let mut left: Vec<usize> = (0..flat.len()).collect();
        let mut triangles = Vec::with_capacity(flat.len() - 2);
        while left.len() > 3 {
            let ear = (0..left.len()).find(|&i| {
                self.effort = self.effort.saturating_sub(left.len());
                self.effort == 0 || is_ear(flat, &left, i)
            });
            // The outline intersects itself: no triangulation is correct, and a fan keeps all corners.
            let Some(ear) = ear.filter(|_| self.effort > 0) else {
                break;
            };
            triangles.push(around(&left, ear));
            left.remove(ear);
        }
        triangles.extend(fan(&left));
        triangles
    }
}

fn fan(corners: &[usize]) -> Vec<[usize; 3]> {
    (1..corners.len() - 1)
        .map(|i| [corners[0], corners[i], corners[i + 1]])
        .collect()
}

/// Newell's normal, which is also valid for concave and slightly non-planar polygons.
fn newell_normal(points: &[DVec3]) -> DVec3 {
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(a, b)| (*a - points[0]).cross(*b - points[0]))
        .sum()
}

/// Projects the polygon into its plane, counter-clockwise.
fn project(points: &[DVec3]) -> Vec<DVec2> {
    let normal = newell_normal(points).normalize_or(DVec3::Y);
    let (s, t) = normal.any_orthonormal_pair();
    let origin = points[0];
    points
        .iter()
        .map(|p| DVec2::new((*p - origin).dot(s), (*p - origin).dot(t)))
        .collect()
}

/// Twice the signed area of triangle a, b, c; positive for a left turn.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn is_convex(flat: &[DVec2]) -> bool {
    let n = flat.len();
    (0..n).all(|i| turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) >= 0.0)
        // A star that winds twice also turns left at every corner, but its fan folds back.
        && (1..n - 1).all(|i| turn(flat[0], flat[i], flat[i + 1]) >= 0.0)
}

fn around(left: &[usize], i: usize) -> [usize; 3] {
    let n = left.len();
    [left[(i + n - 1) % n], left[i], left[(i + 1) % n]]
}

fn is_ear(flat: &[DVec2], left: &[usize], i: usize) -> bool {
    let [a, b, c] = around(left, i).map(|k| flat[k]);
    if turn(a, b, c) <= 0.0 {
        return false;
    }
    let blocks = |p: DVec2| {
        // An outline with a slit to a hole visits the same point twice; a corner does not block itself.
        p != a
            && p != b
            && p != c
            && turn(a, b, p) >= 0.0
            && turn(b, c, p) >= 0.0
            && turn(c, a, p) >= 0.0
    };
    !left.iter().any(|&k| blocks(flat[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangulate(points: &[DVec3]) -> Vec<[usize; 3]> {
        Triangulator::for_corners(points.len()).triangulate(points)
    }

    fn area(points: &[DVec3]) -> f64 {
        triangulate(points)
            .iter()
            .map(|t| {
                0.5 * (points[t[1]] - points[t[0]])
                    .cross(points[t[2]] - points[t[0]])
                    .length()
            })
            .sum()
    }

    fn flat(points: &[(f64, f64)]) -> Vec<DVec3> {
        // On a tilted plane, to test the projection.
        points
            .iter()
            .map(|(x, y)| DVec3::new(*x, 0.6 * y, 0.8 * y))
            .collect()
    }

    #[test]
    fn convex_polygons_are_fans() {
        let square = flat(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert_eq!(triangulate(&square), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        let arrow = flat(&[(0.0, 0.0), (2.0, 2.0), (0.0, 1.0), (-2.0, 2.0)]);
        assert!((area(&arrow) - 2.0).abs() < 1e-12, "{}", area(&arrow));
        let l_shape = flat(&[
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
            (0.0, 0.0),
            (3.0, 0.0),
            (3.0, 1.0),
        ]);
        assert!((area(&l_shape) - 5.0).abs() < 1e-12);
        let clockwise: Vec<_> = l_shape.into_iter().rev().collect();
        assert!(
            (area(&clockwise) - 5.0).abs() < 1e-12,
            "the other winding too"
        );
    }

    #[test]
    fn a_hole_on_a_slit_stays_open() {
        let outer = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0), (0.0, 0.0)];
        let hole = [(1.0, 1.0), (1.0, 2.0), (2.0, 2.0), (2.0, 1.0), (1.0, 1.0)];
        let outline: Vec<_> = outer.into_iter().chain(hole).collect();
        assert!(
            (area(&flat(&outline)) - 8.0).abs() < 1e-12,
            "{}",
            area(&flat(&outline))
        );
    }

    #[test]
    fn degenerate_polygons_end() {
        assert!(triangulate(&[]).is_empty());
        assert_eq!(triangulate(&[DVec3::ZERO; 7]).len(), 5);
        let bow = flat(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(triangulate(&bow).len(), 2);
        let comb: Vec<_> = (0..3000)
            .map(|i| (f64::from(i), f64::from(i % 2)))
            .collect();
        assert_eq!(triangulate(&flat(&comb)).len(), 2998);
        let broken = [DVec3::NAN, DVec3::X, DVec3::Y, DVec3::Z];
        assert_eq!(triangulate(&broken).len(), 2);
    }
}
