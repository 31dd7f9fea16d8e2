//! How one light follows from another: what cells keep of the old one.

use glam::{DVec3, Vec3};

use crate::daylight::colour::luminance;
use crate::daylight::sky::Daylight;

/// Turn of the sun after which the old light says nothing about the new one, degrees.
const JUMP_DEG: f64 = 10.0;

/// How much two lights differ: 0 not at all, 1 so much that one says nothing about the other.
pub(super) fn change(old: &Daylight, new: &Daylight) -> f64 {
    if old == new {
        return 0.0;
    }
    let angle = |a: DVec3, b: DVec3| a.dot(b).clamp(-1.0, 1.0).acos().to_degrees();
    let sun = angle(old.sun_direction, new.sun_direction);
    // At dusk the moon takes the place of the sun while neither matters.
    let direct = match (direct(old), direct(new)) {
        (Some(old), Some(new)) => angle(old, new),
        _ => 0.0,
    };
    let level = |day: &Daylight| luminance(day.horizontal()).max(1e-3);
    let dimming = (level(new) / level(old)).ln().abs();
    (sun.max(direct) / JUMP_DEG + dimming).clamp(1e-3, 1.0)
}

/// Direction of the directional light if it gives open ground more than a hundredth of its light.
fn direct(day: &Daylight) -> Option<DVec3> {
    let (all, sky) = (day.horizontal(), day.sky_irradiance_up);
    (luminance(all - sky) > 0.01 * luminance(all)).then(|| day.direct_light().direction)
}

/// Quotient of two lights, component by component; 1 where the old one is black.
pub(super) fn ratio(new: DVec3, old: DVec3) -> Vec3 {
    let quotient = |i: usize| if old[i] > 0.0 { new[i] / old[i] } else { 1.0 };
    DVec3::new(quotient(0), quotient(1), quotient(2)).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::moon::Moon;
    use crate::daylight::sky::Conditions;

    fn day(elevation: f64) -> Daylight {
        Daylight::new(&Conditions {
            sun_elevation_deg: elevation,
            ..Conditions::default()
        })
    }

    #[test]
    fn a_change_grows_with_the_turn_of_the_sun_up_to_a_jump() {
        let changes =
            [40.0, 40.1, 41.0, 44.0, 60.0].map(|elevation| change(&day(40.0), &day(elevation)));
        assert_eq!(changes[0], 0.0);
        assert!(changes.is_sorted(), "{changes:?}");
        assert!(changes[1] > 0.0 && changes[1] < 0.05, "{changes:?}");
        assert_eq!(changes[4], 1.0);
    }

    #[test]
    fn the_moon_counts_when_it_is_the_light() {
        let moonlit = |sun_elevation_deg, azimuth_deg| {
            let moon = Moon {
                azimuth_deg,
                elevation_deg: 40.0,
                apparent_elevation_deg: 40.0,
                distance_km: 384_400.0,
                phase_angle_deg: 5.0,
                sunward: DVec3::Y,
            };
            Daylight::new(&Conditions {
                sun_elevation_deg,
                moon: Some(moon),
                ..Conditions::default()
            })
        };
        let turned = |elevation| change(&moonlit(elevation, 90.0), &moonlit(elevation, 120.0));
        assert_eq!(turned(-30.0), 1.0);
        assert!(turned(-1.0) < 0.01, "{}", turned(-1.0));
        // The sun's disc sets: no jump.
        let sunset = change(&moonlit(-0.2, 90.0), &moonlit(-0.3, 90.0));
        assert!(sunset < 0.2, "{sunset}");
    }

    #[test]
    fn a_ratio_is_one_where_there_was_no_light() {
        let of = ratio(DVec3::new(4.0, 3.0, 0.0), DVec3::new(2.0, 0.0, 0.0));
        assert_eq!(of, Vec3::new(2.0, 1.0, 1.0));
    }
}
