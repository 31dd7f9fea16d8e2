//! Axis-aligned bounding boxes.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// An axis-aligned box in world space, metres. Empty if `min > max` on every axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Minimum corner, metres.
    pub min: Vec3,
    /// Maximum corner, metres.
    pub max: Vec3,
}

impl Bounds {
    /// The empty box, the identity of [`Bounds::union`].
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The smallest box that contains the points.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }

    /// The smallest box that contains this one and `point`.
    #[must_use]
    pub fn with(self, point: Vec3) -> Self {
        Self {
            min: self.min.min(point),
            max: self.max.max(point),
        }
    }

    /// The smallest box that contains both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether it contains no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Centre, metres; the origin for an empty box.
    pub fn centre(&self) -> Vec3 {
        if self.is_empty() {
            return Vec3::ZERO;
        }
        0.5 * (self.min + self.max)
    }

    /// Edge lengths, metres; zero for an empty box.
    pub fn extent(&self) -> Vec3 {
        if self.is_empty() {
            return Vec3::ZERO;
        }
        self.max - self.min
    }

    /// Length of the space diagonal, metres; zero for an empty box.
    pub fn diagonal(&self) -> f32 {
        self.extent().length()
    }

    /// The eight corners, metres. Bits 0, 1 and 2 of the index select `max` along x, y and z.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| {
                if i >> axis & 1 == 1 {
                    self.max[axis]
                } else {
                    self.min[axis]
                }
            };
            Vec3::new(pick(0), pick(1), pick(2))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_the_smallest_box_around_its_points() {
        let bounds = Bounds::of([Vec3::new(1.0, -2.0, 3.0), Vec3::new(-1.0, 5.0, 0.0)]);
        assert_eq!(bounds.min, Vec3::new(-1.0, -2.0, 0.0));
        assert_eq!(bounds.max, Vec3::new(1.0, 5.0, 3.0));
        assert_eq!(bounds.centre(), Vec3::new(0.0, 1.5, 1.5));
        assert_eq!(bounds.extent(), Vec3::new(2.0, 7.0, 3.0));
        assert_eq!(Bounds::of(bounds.corners()), bounds);
    }

    #[test]
    fn the_empty_box_is_neutral() {
        let one = Bounds::of([Vec3::ONE]);
        assert!(Bounds::EMPTY.is_empty());
        assert!(!one.is_empty(), "a box of one point");
        assert_eq!(Bounds::EMPTY.union(one), one);
        assert_eq!(Bounds::EMPTY.diagonal(), 0.0);
        assert_eq!(Bounds::EMPTY.centre(), Vec3::ZERO);
    }
}
