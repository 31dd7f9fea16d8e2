//! Where a model lies: city, terrain and building models have coordinates of a map, millions of metres from their origin.

use glam::DVec3;

/// Distance along an axis below which a model stays where it is, metres: `f32` resolves 8 micrometres there.
const NEAR: f64 = 100.0;
/// Distance along an axis from which it is moved, as a multiple of its size.
const FAR: f64 = 2.0;
/// Distances from the centre of the earth of places on it, metres: from below the polar to above the equatorial radius (WGS 84).
const EARTH: std::ops::Range<f64> = 6_340_000.0..6_390_000.0;

/// Middle and size of most points of a model, metres; single points far from the others do not count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Middle {
    at: DVec3,
    size: f64,
}

/// Finds the middle of points, which must be finite. Reorders them.
pub fn middle(points: &mut [DVec3]) -> Middle {
    let mut middle = Middle {
        at: DVec3::ZERO,
        size: 0.0,
    };
    let Some(last) = points.len().checked_sub(1) else {
        return middle;
    };
    for axis in 0..3 {
        points.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
        let at = |share: f64| points[(share * last as f64).round() as usize][axis];
        middle.at[axis] = at(0.5);
        middle.size = middle.size.max(at(0.9) - at(0.1));
    }
    middle
}

impl Middle {
    /// The origin for positions around it, whole metres: 0 on the axes along which the model is not far away.
    pub fn origin(&self) -> DVec3 {
        let far = NEAR.max(FAR * self.size);
        let whole = |v: f64| if v.abs() > far { v.round() } else { 0.0 };
        DVec3::from(self.at.to_array().map(whole))
    }

    /// Whether the coordinates are those of a place on earth relative to its centre.
    pub fn is_geocentric(&self) -> bool {
        let inland = self.at.abs().min_element() > 20_000.0;
        inland && EARTH.contains(&self.at.length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn house(at: DVec3) -> Vec<DVec3> {
        (0..100)
            .map(|i| at + DVec3::new(f64::from(i % 10), f64::from(i % 7), f64::from(i / 10)))
            .collect()
    }

    #[test]
    fn only_far_models_are_moved() {
        let origin = |at| middle(&mut house(at)).origin();
        assert_eq!(origin(DVec3::ZERO), DVec3::ZERO);
        assert_eq!(origin(DVec3::new(80.0, 0.0, -90.0)), DVec3::ZERO);
        let utm = origin(DVec3::new(5e5, 40.0, -6.1e6));
        assert!(
            (utm - DVec3::new(5e5, 0.0, -6.1e6)).length() < 10.0,
            "{utm}"
        );
        assert_eq!(utm, utm.round());
    }

    #[test]
    fn a_wide_terrain_stays_and_single_points_do_not_count() {
        let mut terrain: Vec<DVec3> = house(DVec3::ZERO);
        terrain.iter_mut().for_each(|p| *p *= 10_000.0);
        assert_eq!(middle(&mut terrain).origin(), DVec3::ZERO);
        let mut far = house(DVec3::new(1e6, 0.0, 0.0));
        far.push(DVec3::ZERO);
        assert!((middle(&mut far).origin().x - 1e6).abs() < 10.0);
        assert_eq!(middle(&mut []).origin(), DVec3::ZERO);
    }

    #[test]
    fn geocentric_coordinates_are_known_from_those_of_maps() {
        let is = |at| middle(&mut house(at)).is_geocentric();
        // Copenhagen: ECEF with each axis as up, UTM 32 N with y and z up, web Mercator.
        assert!(is(DVec3::new(3_512_000.0, 780_000.0, 5_248_000.0)));
        assert!(is(DVec3::new(3_512_000.0, 5_248_000.0, -780_000.0)));
        for at in [
            [723_000.0, 10.0, -6_330_000.0],
            [723_000.0, 6_330_000.0, 10.0],
            [1_399_000.0, 10.0, -7_494_000.0],
        ] {
            assert!(!is(DVec3::from(at)), "{at:?}");
        }
    }
}
