//! Grids of sensors as plane figures: which lie on one plane, the cell of each, and which are neighbours.
//!
//! Nothing is known of how a grid was made: spacings and directions are found from the positions.

use std::collections::BTreeMap;

use glam::{DVec2, Vec3};

use super::Sensor;

/// Distance of planes that still are one, metres.
const SAME_PLANE: f32 = 0.02;

/// Cosine from which a plane counts as level.
const LEVEL: f32 = 0.9;

/// Width of the cell of a sensor alone, metres.
const ALONE: f64 = 0.5;

/// A neighbour is at most this many steps away,
const REACH: f64 = 1.35;

/// and at most this many beside the line of the grid.
const ASIDE: f64 = 0.25;

/// Sensors on one plane, all facing its way.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Unit vector toward which they face.
    pub normal: Vec3,
    /// Distance of the plane from the origin along it, metres.
    pub offset: f32,
    /// Direction that is right in a picture of it: east in plans; on walls as seen from before them.
    pub right: Vec3,
    /// Direction that is up in it: north in plans.
    pub up: Vec3,
    /// Numbers of its sensors in their list.
    pub members: Vec<usize>,
    /// Place of each member on the plane: right, up, metres.
    pub places: Vec<DVec2>,
    /// Corners of the cell of each member.
    pub cells: Vec<[DVec2; 4]>,
    /// Members at the corners of squares of the grid, around each.
    pub quads: Vec<[usize; 4]>,
}

impl Sheet {
    /// Whether it is a plan: level.
    pub fn is_level(&self) -> bool {
        self.normal.y.abs() > LEVEL
    }

    /// Place of a point on the plane, metres.
    pub fn place(&self, point: Vec3) -> DVec2 {
        place(point, self.right, self.up)
    }
}

fn place(point: Vec3, right: Vec3, up: Vec3) -> DVec2 {
    let point = point.as_dvec3();
    DVec2::new(point.dot(right.as_dvec3()), point.dot(up.as_dvec3()))
}

/// The planes of some sensors, in the order of their first ones. `walls` are the lines of a sheet, of which only
/// the frame is known then, across which sensors are no neighbours.
pub fn sheets(
    sensors: &[Sensor],
    walls: impl Fn(&Sheet) -> Vec<[DVec2; 2]>,
) -> Vec<(Sheet, Vec<[DVec2; 2]>)> {
    let mut found: Vec<Sheet> = Vec::new();
    let mut of_normal: BTreeMap<[i32; 3], Vec<usize>> = BTreeMap::new();
    for (number, sensor) in sensors.iter().enumerate() {
        let key = sensor.normal.to_array().map(|v| (v * 500.0).round() as i32);
        let offset = sensor.normal.dot(sensor.position);
        let same = of_normal.entry(key).or_default();
        let known = same
            .iter()
            .find(|sheet| (found[**sheet].offset - offset).abs() < SAME_PLANE);
        let at = known.copied().unwrap_or_else(|| {
            same.push(found.len());
            found.push(empty(sensor.normal, offset));
            found.len() - 1
        });
        let sheet = &mut found[at];
        sheet.members.push(number);
        sheet.places.push(sheet.place(sensor.position));
    }
    let complete = |mut sheet: Sheet| {
        let walls = walls(&sheet);
        let lattice = Lattice::new(&sheet.places, &walls);
        sheet.cells = lattice.cells();
        sheet.quads = lattice.quads();
        (sheet, walls)
    };
    found.into_iter().map(complete).collect()
}

fn empty(normal: Vec3, offset: f32) -> Sheet {
    let (right, up) = if normal.y.abs() > LEVEL {
        (Vec3::X, Vec3::NEG_Z)
    } else {
        let right = Vec3::Y.cross(normal).normalize();
        (right, normal.cross(right))
    };
    Sheet {
        normal,
        offset,
        right,
        up,
        members: Vec::new(),
        places: Vec::new(),
        cells: Vec::new(),
        quads: Vec::new(),
    }
}

/// Sides of a cell: to the right, up, left, down, along the grid.
const SIDES: [DVec2; 4] = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];

/// A grid in its own directions.
struct Lattice {
    /// Unit vector along its rows.
    along: DVec2,
    /// Places in its directions.
    places: Vec<DVec2>,
    /// Distance of rows and columns, metres.
    step: DVec2,
    /// Neighbours on the four sides.
    neighbours: Vec<[Option<usize>; 4]>,
}

impl Lattice {
    fn new(places: &[DVec2], walls: &[[DVec2; 2]]) -> Self {
        let order = Order::new(places);
        let nearest = |at: usize| order.nearest(places, at, f64::INFINITY, |_| true);
        let apart: Vec<DVec2> = (0..places.len())
            .filter_map(nearest)
            .map(|(_, apart)| apart)
            .collect();
        let typical = median(apart.iter().map(|d| d.length())).unwrap_or(ALONE);
        // Angles modulo a quarter turn: the mean of four times the angle.
        let sum: DVec2 = apart
            .iter()
            .map(|d| DVec2::from_angle(4.0 * d.to_angle()))
            .sum();
        let along = DVec2::from_angle(sum.to_angle() / 4.0);
        let own: Vec<DVec2> = places
            .iter()
            .map(|p| DVec2::new(along.dot(*p), along.perp_dot(*p)))
            .collect();
        let order = Order::new(&own);
        let side = |at: usize, side: DVec2, reach: f64, aside: f64| {
            order.nearest(&own, at, reach, |d| {
                side.dot(d) > ASIDE * typical && side.perp_dot(d).abs() < aside
            })
        };
        let step_of = |axis: DVec2| {
            let next = |at| side(at, axis, f64::INFINITY, ASIDE * typical);
            median((0..own.len()).filter_map(next).map(|(_, d)| d.length()))
        };
        let [x, y] = [DVec2::X, DVec2::Y].map(step_of);
        let step = DVec2::new(x.or(y).unwrap_or(typical), y.or(x).unwrap_or(typical));
        let neighbours = (0..own.len()).map(|at| {
            SIDES.map(|direction| {
                let length = direction.abs().dot(step);
                let found = side(at, direction, REACH * length, ASIDE * typical)?.0;
                let line = [places[at], places[found]];
                (!walls.iter().any(|wall| crosses(line, *wall))).then_some(found)
            })
        });
        Self {
            neighbours: neighbours.collect(),
            along,
            places: own,
            step,
        }
    }

    /// Halfway to the neighbours; where there is none, half a step.
    fn cells(&self) -> Vec<[DVec2; 4]> {
        let cell = |at: usize| {
            let reach = |side: usize| {
                let whole = self.neighbours[at][side].map_or_else(
                    || SIDES[side].abs().dot(self.step),
                    |other| SIDES[side].dot(self.places[other] - self.places[at]),
                );
                0.5 * whole
            };
            let [right, up, left, down] = [0, 1, 2, 3].map(reach);
            [[-left, -down], [right, -down], [right, up], [-left, up]].map(|d| {
                let own = self.places[at] + DVec2::from(d);
                own.x * self.along + own.y * self.along.perp()
            })
        };
        (0..self.places.len()).map(cell).collect()
    }

    fn quads(&self) -> Vec<[usize; 4]> {
        let quad = |at: usize| {
            let [right, up] = [self.neighbours[at][0]?, self.neighbours[at][1]?];
            let corner = self.neighbours[right][1]?;
            (self.neighbours[up][0] == Some(corner)).then_some([at, right, corner, up])
        };
        (0..self.places.len()).filter_map(quad).collect()
    }
}

/// Whether two lines cross.
fn crosses([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Places sorted from left to right.
struct Order {
    sorted: Vec<usize>,
    rank: Vec<usize>,
}

impl Order {
    fn new(places: &[DVec2]) -> Self {
        let mut sorted: Vec<usize> = (0..places.len()).collect();
        sorted.sort_by(|a, b| places[*a].x.total_cmp(&places[*b].x));
        let mut rank = vec![0; places.len()];
        for (at, number) in sorted.iter().enumerate() {
            rank[*number] = at;
        }
        Self { sorted, rank }
    }

    /// The nearest other place within `reach` whose offset is accepted, and that offset.
    fn nearest(
        &self,
        places: &[DVec2],
        at: usize,
        reach: f64,
        accepts: impl Fn(DVec2) -> bool,
    ) -> Option<(usize, DVec2)> {
        let mut best = None;
        let mut least = reach;
        let (before, rest) = self.sorted.split_at(self.rank[at]);
        let mut look = |others: &mut dyn Iterator<Item = &usize>| {
            for other in others {
                let apart = places[*other] - places[at];
                if apart.x.abs() > least {
                    return;
                }
                let length = apart.length();
                // Two sensors at one place are no neighbours.
                if length > 1e-6 && length <= least && accepts(apart) {
                    (best, least) = (Some((*other, apart)), length);
                }
            }
        };
        look(&mut before.iter().rev());
        look(&mut rest.iter().skip(1));
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `columns` x `rows` sensors facing up, from a corner, `step` apart, the grid turned by an angle from east to north.
    fn grid([columns, rows]: [usize; 2], step: DVec2, angle: f64) -> Vec<Sensor> {
        let turn = DVec2::from_angle(angle);
        let sensor = |n: usize| {
            let own = step * DVec2::new((n % columns) as f64, (n / columns) as f64);
            let plan = turn.rotate(own);
            Sensor {
                position: Vec3::new(plan.x as f32, 0.8, -plan.y as f32),
                normal: Vec3::Y,
            }
        };
        (0..columns * rows).map(sensor).collect()
    }

    fn area(corners: &[DVec2; 4]) -> f64 {
        let [a, b, c, d] = *corners;
        0.5 * ((c - a).perp_dot(d - b))
    }

    #[test]
    fn cells_fill_the_plane_of_a_grid_in_any_direction() {
        for angle in [0.0, 0.3, 0.7, -1.2] {
            let step = DVec2::new(0.6, 0.45);
            let sensors = grid([7, 5], step, angle);
            let found = sheets(&sensors, |_| Vec::new());
            assert_eq!(found.len(), 1);
            let sheet = &found[0].0;
            assert_eq!(sheet.quads.len(), 6 * 4, "turned by {angle}");
            for (cell, place) in sheet.cells.iter().zip(&sheet.places) {
                assert!((area(cell) - 0.27).abs() < 1e-4, "{cell:?}");
                let centre = cell.iter().sum::<DVec2>() / 4.0;
                assert!(centre.distance(*place) < 1e-4);
            }
        }
    }

    #[test]
    fn a_wall_parts_neighbours() {
        let sensors = grid([4, 3], DVec2::ONE, 0.0);
        let wall = [DVec2::new(1.5, -9.0), DVec2::new(1.5, 9.0)];
        let found = sheets(&sensors, |_| vec![wall]);
        assert_eq!(found[0].0.quads.len(), 2 * 2);
    }

    #[test]
    fn planes_have_their_own_sheets_and_frames() {
        let mut sensors = grid([3, 3], DVec2::ONE, 0.0);
        let upstairs = sensors.clone().into_iter().map(|mut sensor| {
            sensor.position.y += 3.0;
            sensor
        });
        sensors.extend(upstairs.collect::<Vec<_>>());
        for x in 0..4 {
            sensors.push(Sensor {
                position: Vec3::new(x as f32, 5.0, 8.0),
                normal: Vec3::Z,
            });
        }
        let found: Vec<Sheet> = sheets(&sensors, |_| Vec::new())
            .into_iter()
            .map(|(sheet, _)| sheet)
            .collect();
        assert_eq!(
            found.iter().map(|s| s.members.len()).collect::<Vec<_>>(),
            [9, 9, 4]
        );
        assert!(found[0].is_level() && !found[2].is_level());
        // From the south: east is right.
        assert_eq!((found[2].right, found[2].up), (Vec3::X, Vec3::Y));
        assert_eq!(found[0].up, Vec3::NEG_Z);
        // A row alone has square cells.
        assert!((area(&found[2].cells[1]) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_sensor_alone_has_a_cell() {
        let found = sheets(&grid([1, 1], DVec2::ONE, 0.0), |_| Vec::new());
        assert!((area(&found[0].0.cells[0]) - ALONE * ALONE).abs() < 1e-9);
        assert!(sheets(&[], |_| Vec::new()).is_empty());
    }
}
