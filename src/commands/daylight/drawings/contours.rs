//! Lines of equal value on a grid: marching squares (Lorensen & Cline 1987 in the plane), linear along the edges of each square.

use std::collections::HashMap;

use glam::DVec2;

/// The lines of a level through squares, of which each corner is told by its number.
pub fn contours(
    places: &[DVec2],
    values: &[f64],
    quads: &[[usize; 4]],
    level: f64,
) -> Vec<Vec<DVec2>> {
    let mut points: Vec<DVec2> = Vec::new();
    let mut of_edge: HashMap<[usize; 2], usize> = HashMap::new();
    let mut segments: Vec<[usize; 2]> = Vec::new();
    for quad in quads {
        let is_above = |k: usize| values[quad[k % 4]] >= level;
        let mut point = |k: usize| {
            let [a, b] = [quad[k], quad[(k + 1) % 4]];
            *of_edge.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let share = (level - values[a]) / (values[b] - values[a]);
                points.push(places[a].lerp(places[b], share));
                points.len() - 1
            })
        };
        let crossed = (0..4).filter(|k| is_above(*k) != is_above(k + 1));
        let crossed: Vec<usize> = crossed.map(&mut point).collect();
        match crossed[..] {
            [a, b] => segments.push([a, b]),
            [a, b, c, d] => {
                // A saddle: the mean tells which corners belong together.
                let mean = quad.iter().map(|k| values[*k]).sum::<f64>() / 4.0;
                // Edge 0 leads to corner 1: with the first corner on the side of the mean, the second is cut off.
                let pairs = if is_above(0) == (mean >= level) {
                    [[a, b], [c, d]]
                } else {
                    [[d, a], [b, c]]
                };
                segments.extend(pairs);
            }
            _ => (),
        }
    }
    joined(&points, &segments)
}

/// Segments that share points, as runs.
fn joined(points: &[DVec2], segments: &[[usize; 2]]) -> Vec<Vec<DVec2>> {
    let mut at_point: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
    for (number, ends) in segments.iter().enumerate() {
        ends.iter().for_each(|end| at_point[*end].push(number));
    }
    let mut is_used = vec![false; segments.len()];
    // Open lines begin at their ends, then closed ones anywhere.
    let is_end = |number: usize| segments[number].iter().any(|end| at_point[*end].len() == 1);
    let ends = (0..segments.len()).filter(|n| is_end(*n));
    let order: Vec<usize> = ends.chain(0..segments.len()).collect();
    let mut runs = Vec::new();
    for first in order {
        if is_used[first] {
            continue;
        }
        let [a, b] = segments[first];
        let mut at = if at_point[a].len() == 1 { a } else { b };
        let mut run = vec![points[at]];
        let mut next = Some(first);
        while let Some(number) = next {
            is_used[number] = true;
            let [a, b] = segments[number];
            at = if at == a { b } else { a };
            run.push(points[at]);
            next = at_point[at].iter().copied().find(|n| !is_used[*n]);
        }
        runs.push(run);
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of 9 x 7 places 0.5 apart, its squares, and the values of a function.
    fn grid(of: impl Fn(DVec2) -> f64) -> (Vec<DVec2>, Vec<f64>, Vec<[usize; 4]>) {
        let places: Vec<DVec2> = (0..63)
            .map(|n| 0.5 * DVec2::new((n % 9) as f64, (n / 9) as f64))
            .collect();
        let values = places.iter().map(|p| of(*p)).collect();
        let quads = (0..54).filter(|n| n % 9 < 8);
        let quads = quads.map(|n| [n, n + 1, n + 10, n + 9]).collect();
        (places, values, quads)
    }

    fn length(runs: &[Vec<DVec2>]) -> f64 {
        let of = |run: &Vec<DVec2>| run.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        runs.iter().map(of).sum()
    }

    #[test]
    fn the_contour_of_a_plane_is_a_straight_line() {
        // 3x + 4y = 7.1 in 4 m x 3 m: from (0, 1.775) to (2.366.., 0).
        let of = |p: DVec2| 3.0 * p.x + 4.0 * p.y;
        let (places, values, quads) = grid(of);
        let runs = contours(&places, &values, &quads, 7.1);
        assert_eq!(runs.len(), 1);
        for point in &runs[0] {
            assert!((of(*point) - 7.1).abs() < 1e-12, "{point}");
        }
        let expected = (7.1_f64 / 4.0).hypot(7.1 / 3.0);
        assert!((length(&runs) - expected).abs() < 1e-12);
    }

    #[test]
    fn a_hill_has_a_closed_contour_and_a_level_above_it_none() {
        let (places, values, quads) = grid(|p| -p.distance(DVec2::new(2.0, 1.5)));
        let runs = contours(&places, &values, &quads, -1.2);
        assert_eq!(runs.len(), 1);
        assert!(
            runs[0]
                .first()
                .expect("a point")
                .distance(*runs[0].last().expect("a point"))
                < 1e-12
        );
        // A circle, but for the corners of its polygon.
        let circle = std::f64::consts::TAU * 1.2;
        assert!(
            (length(&runs) / circle - 1.0).abs() < 0.03,
            "{}",
            length(&runs)
        );
        assert!(contours(&places, &values, &quads, 0.1).is_empty());
    }

    #[test]
    fn a_saddle_keeps_the_sides_of_its_mean_together() {
        let places = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let quad = [[0, 1, 2, 3]];
        for (values, cut_off) in [([1.0, 0.0, 1.0, 0.4], 1), ([1.0, 0.0, 0.6, 0.0], 0)] {
            let runs = contours(&places, &values, &quad, 0.5);
            assert_eq!(runs.len(), 2);
            let is_near = |run: &Vec<DVec2>| {
                let middle = (run[0] + run[1]) / 2.0;
                middle.distance(places[cut_off]) < 0.6
            };
            assert!(runs.iter().any(is_near), "{values:?}: {runs:?}");
        }
    }
}
