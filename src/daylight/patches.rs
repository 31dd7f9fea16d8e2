//! Patches of the sky, for daylight coefficients.
//!
//! Tregenza 1987, "Subdivision of the sky hemisphere for luminance measurements": rows of 30, 30, 24, 24, 18, 12 and 6 patches and the
//! zenith. Reinhart's subdivision MF:m cuts each into m x m, as the programs of Radiance do: rows of 90°/(7m + ½), m times the patches of
//! Tregenza's row in each. Patch 0 is everything below the horizon; the others begin at the horizon in the north and go clockwise, row by row.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::sun_position::direction;

/// Patches of Tregenza's rows; the zenith is one more.
const TREGENZA: [usize; 7] = [30, 30, 24, 24, 18, 12, 6];

/// A subdivision of the sky.
#[derive(Debug, Clone, PartialEq)]
pub struct Patches {
    /// Number of the first patch of each row; one more for the end of the last row, which is the zenith's number.
    first: Vec<usize>,
    /// Height of a row, radians.
    height: f64,
}

impl Patches {
    /// MF:`multiplier`, 1 or more.
    pub fn new(multiplier: usize) -> Self {
        let counts = TREGENZA
            .iter()
            .flat_map(|n| vec![n * multiplier; multiplier]);
        let mut first = vec![1];
        first.extend(counts.scan(1, |at, count| {
            *at += count;
            Some(*at)
        }));
        Self {
            first,
            height: FRAC_PI_2 / (7.0 * multiplier as f64 + 0.5),
        }
    }

    /// Number of patches, with that below the horizon.
    pub fn count(&self) -> usize {
        self.zenith() + 1
    }

    /// The patch in which a unit direction lies.
    pub fn index(&self, direction: DVec3) -> usize {
        if direction.y < 0.0 {
            return 0;
        }
        let row = (direction.y.min(1.0).asin() / self.height) as usize;
        let Some(&[first, end]) = self.first.get(row..row + 2) else {
            return self.zenith();
        };
        let count = end - first;
        let turn = (direction.x.atan2(-direction.z) / TAU).rem_euclid(1.0);
        first + (turn * count as f64).round() as usize % count
    }

    /// Unit direction of the middle of each patch, straight down for patch 0.
    pub fn centres(&self) -> Vec<DVec3> {
        let mut centres = vec![DVec3::NEG_Y];
        for (row, ends) in self.first.windows(2).enumerate() {
            let elevation = ((row as f64 + 0.5) * self.height).to_degrees();
            let count = ends[1] - ends[0];
            let azimuth = |at: usize| 360.0 * at as f64 / count as f64;
            centres.extend((0..count).map(|at| direction(azimuth(at), elevation)));
        }
        centres.push(DVec3::Y);
        centres
    }

    /// Illuminance of a horizontal plane by each patch of luminance 1: its solid angle weighted by the cosine, sr; 0 for patch 0.
    pub fn horizontal_weights(&self) -> Vec<f64> {
        let sine_squared = |row: usize| (row as f64 * self.height).sin().powi(2);
        let mut weights = vec![0.0];
        for (row, ends) in self.first.windows(2).enumerate() {
            let count = ends[1] - ends[0];
            let ring = PI * (sine_squared(row + 1) - sine_squared(row));
            weights.extend(vec![ring / count as f64; count]);
        }
        weights.push(PI * (1.0 - sine_squared(self.first.len() - 1)));
        weights
    }

    fn zenith(&self) -> usize {
        self.first[self.first.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_patches_are_those_of_radiance() {
        let counts = [1, 2, 4, 8].map(|m| Patches::new(m).count());
        assert_eq!(counts, [146, 578, 2306, 9218]);
        let first = Patches::new(1);
        assert_eq!(first.index(direction(0.0, 1.0)), 1);
        assert_eq!(first.index(direction(12.0, 1.0)), 2);
        assert_eq!(first.index(direction(359.0, 13.0)), 31);
        assert_eq!(first.index(DVec3::Y), 145);
        assert_eq!(first.index(direction(0.0, -1.0)), 0);
    }

    #[test]
    fn patches_cover_the_sky_once() {
        for multiplier in [1, 3, 4] {
            let patches = Patches::new(multiplier);
            let (centres, weights) = (patches.centres(), patches.horizontal_weights());
            assert_eq!(centres.len(), patches.count());
            assert_eq!(weights.len(), patches.count());
            let sum: f64 = weights.iter().sum();
            assert!((sum / PI - 1.0).abs() < 1e-12, "{sum}");
            for (number, centre) in centres.iter().enumerate() {
                assert_eq!(patches.index(*centre), number, "MF:{multiplier}");
            }
        }
    }
}
