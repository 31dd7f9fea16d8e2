//! Which casters a map of the sun needs: those that can shade what the camera sees in it. Beside all of it, as the sun sees
//! it, and behind all of it a caster shades nothing that is in the picture.

use glam::{Vec2, Vec3};

use crate::scene::{Bounds, Cluster};

/// Directions across the light in which the extent is known: evenly over half a turn.
const ACROSS: usize = 8;
/// Those, and the one toward the light.
const DIRECTIONS: usize = ACROSS + 1;
/// Room for what comes into view while the map stays, as a share of the extent in each direction.
const ROOM: f32 = 1.0 / 24.0;

/// A convex region by its extent in some directions (a k-DOP; Klosowski et al. 1998), metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shade {
    directions: [Vec3; DIRECTIONS],
    ends: [[f32; 2]; DIRECTIONS],
}

impl Shade {
    /// Nothing yet, under a light; `right` and `up` are unit vectors across it.
    pub fn none([right, up, toward]: [Vec3; 3]) -> Self {
        let across = |i: usize| {
            let (sin, cos) = (std::f32::consts::PI * i as f32 / ACROSS as f32).sin_cos();
            right * cos + up * sin
        };
        Self {
            directions: std::array::from_fn(|i| if i < ACROSS { across(i) } else { toward }),
            ends: [[f32::INFINITY, f32::NEG_INFINITY]; DIRECTIONS],
        }
    }

    /// Everything.
    pub const ALL: Self = Self {
        directions: [Vec3::ZERO; DIRECTIONS],
        ends: [[f32::NEG_INFINITY, f32::INFINITY]; DIRECTIONS],
    };

    /// Whether it is nothing.
    pub fn is_nothing(&self) -> bool {
        self.ends.iter().any(|[low, high]| low > high)
    }

    /// Takes in a box.
    pub fn add(&mut self, bounds: &Bounds) {
        let (centre, half) = (bounds.centre(), 0.5 * bounds.extent());
        for (direction, ends) in self.directions.iter().zip(&mut self.ends) {
            let (at, reach) = (direction.dot(centre), direction.abs().dot(half));
            *ends = [ends[0].min(at - reach), ends[1].max(at + reach)];
        }
    }

    /// Its lowest and highest coordinates across the light, along the axes `right` and `up`, metres; none if it is nothing or has
    /// no end.
    pub fn across(&self) -> Option<[Vec2; 2]> {
        let (right, up) = (self.ends[0], self.ends[ACROSS / 2]);
        let [low, high] = [0, 1].map(|i| Vec2::new(right[i], up[i]));
        (low.is_finite() && high.is_finite()).then_some([low, high])
    }

    /// Whether something of a cluster may stand between the region and the light.
    pub fn may_be_shaded_by(&self, cluster: &Cluster) -> bool {
        let (centre, half) = (cluster.bounds.centre(), 0.5 * cluster.bounds.extent());
        let mut slabs = self.directions.iter().zip(&self.ends).enumerate();
        slabs.all(|(i, (direction, ends))| {
            let (at, reach) = (direction.dot(centre), direction.abs().dot(half));
            // However near the light: it shades what is behind.
            at + reach >= ends[0] && (i == ACROSS || at - reach <= ends[1])
        })
    }

    /// Wider by so many metres on all sides.
    pub fn grown(&self, by: f32) -> Self {
        Self {
            ends: self.ends.map(|[low, high]| [low - by, high + by]),
            ..*self
        }
    }

    /// With room for what may come into view, along each direction by its own extent: what is seen of a narrow view is a strip.
    pub fn with_room(&self) -> Self {
        let across = self.ends[..ACROSS].iter().map(|[low, high]| high - low);
        let most = across.fold(0.0, f32::max);
        let mut wider = *self;
        for (i, [low, high]) in wider.ends.iter_mut().enumerate() {
            let room = ROOM * if i < ACROSS { *high - *low } else { most };
            (*low, *high) = (*low - room, *high + room);
        }
        wider
    }

    /// Whether all of another region is within this one.
    pub fn holds(&self, other: &Self) -> bool {
        let mut ends = self.ends.iter().zip(&other.ends);
        ends.all(|(mine, others)| mine[0] <= others[0] && others[1] <= mine[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(centre: Vec3) -> Cluster {
        Cluster {
            first: 0,
            count: 3,
            bounds: Bounds {
                min: centre - 0.5,
                max: centre + 0.5,
            },
            solid: None,
            is_wound: false,
        }
    }

    #[test]
    fn what_stands_toward_the_light_shades_and_what_stands_beside_or_behind_does_not() {
        let toward = Vec3::new(0.6, 0.8, 0.0);
        let right = Vec3::Y.cross(toward).normalize();
        let mut shade = Shade::none([right, toward.cross(right), toward]);
        assert!(
            !shade.may_be_shaded_by(&at(Vec3::ZERO)),
            "nothing is shaded"
        );
        assert!(shade.is_nothing() && shade.grown(1.0).with_room().is_nothing());
        shade.add(&at(Vec3::ZERO).bounds);
        assert!(!shade.is_nothing() && !Shade::ALL.is_nothing());
        let [low, high] = shade.across().expect("ends");
        assert!(low.x == -high.x && low.y == -high.y && high.cmpgt(Vec2::splat(0.49)).all());
        assert_eq!(Shade::ALL.across(), None);
        for distance in [0.0, 5.0, 1e4] {
            assert!(shade.may_be_shaded_by(&at(toward * distance)), "{distance}");
        }
        assert!(!shade.may_be_shaded_by(&at(-toward * 3.0)));
        for beside in [right, -right, toward.cross(right)] {
            assert!(!shade.may_be_shaded_by(&at(toward * 20.0 + beside * 3.0)));
        }
        assert!(Shade::ALL.may_be_shaded_by(&at(-toward * 3e3)));
    }

    #[test]
    fn room_holds_what_moves_a_little() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let of = |x: f32| {
            let mut shade = Shade::none(axes);
            shade.add(&at(Vec3::X * x).bounds);
            shade
        };
        let drawn = of(0.0).with_room();
        // A twenty-fourth of the edge.
        assert!(drawn.holds(&of(0.04)));
        assert!(!drawn.holds(&of(0.045)));
        assert!(drawn.holds(&Shade::none(axes)), "nothing needs nothing");
    }
}
