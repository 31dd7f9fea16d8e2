//! Camera control: orbit, pan, dolly, look, fly, frame the scene, travel to a viewpoint.
//!
//! Takes plain numbers and yields a [`Camera`]. The camera never rolls, and drags keep its pitch short of the vertical. Drags
//! act at once; flight and travel advance in [`Controls::advance`] in closed form, independent of the frame rate.

use glam::DVec3;

use crate::daylight::sun_position::{azimuth_elevation, direction};
use crate::scene::{Bounds, Camera};

/// Steepest pitch reachable by dragging, degrees. Closer to the vertical, the heading is lost to rounding.
const MAX_PITCH_DEG: f64 = 89.5;
/// Orbit angle for a drag over the full image height, degrees.
const ORBIT_DEG: f64 = 180.0;
/// Look angle for a drag over the full image height, degrees.
const LOOK_DEG: f64 = 90.0;
/// Factor on the distance to the pivot per wheel step.
const DOLLY_STEP: f64 = 0.85;
/// Factor on the flight speed per wheel step.
const SPEED_STEP: f64 = 1.25;
/// Range of the wheel factor on the flight speed.
const SPEED_RANGE: (f64, f64) = (1.0 / 64.0, 64.0);
/// Flight speed, scene sizes per second.
const CRUISE: f64 = 0.15;
/// Speed factor of the fast key; the slow key divides by it.
const FAST: f64 = 4.0;
/// Time constant of acceleration, seconds.
const INERTIA_S: f64 = 0.08;
/// Longest time step, seconds. Limits the motion after a stalled frame.
const LONGEST_STEP_S: f64 = 0.5;
/// Travel time to a viewpoint, seconds.
const TRAVEL_S: f64 = 0.35;
/// Smallest and largest distance from eye to pivot, in scene sizes. The largest also bounds the pivot's distance from the scene.
const REACH: (f64, f64) = (1e-4, 100.0);
/// Smallest distance to the target, relative to the largest coordinate. Any closer, rounding would turn the camera.
const TARGET_SHARE: f64 = 0.01;

/// Pointer movement, in image heights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Drag {
    /// To the right.
    pub right: f64,
    /// Downward.
    pub down: f64,
}

/// Held flight keys.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FlyKeys {
    /// W: in the viewing direction.
    pub forward: bool,
    /// S.
    pub back: bool,
    /// A.
    pub left: bool,
    /// D.
    pub right: bool,
    /// E: up, regardless of the viewing direction.
    pub up: bool,
    /// Q.
    pub down: bool,
    /// Four times the speed.
    pub fast: bool,
    /// A quarter of the speed.
    pub slow: bool,
}

/// Camera pose in orbit coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pose {
    /// Centre of orbit and dolly, metres.
    pivot: DVec3,
    /// Azimuth of the viewing direction, degrees clockwise from north.
    azimuth_deg: f64,
    /// Elevation of the viewing direction, degrees.
    elevation_deg: f64,
    /// Distance from the eye to the pivot, metres.
    distance: f64,
    /// Vertical field of view, degrees.
    fov_deg: f64,
}

impl Pose {
    fn of(camera: &Camera) -> Self {
        let (eye, target) = (camera.eye.as_dvec3(), camera.target.as_dvec3());
        let sight = (target - eye)
            .try_normalize()
            .unwrap_or(camera.forward().as_dvec3());
        let (azimuth, elevation_deg) = azimuth_elevation(sight);
        // A camera that looks straight up has north at the top of the image, as if it had tilted up and over from facing south.
        let zenith = elevation_deg >= 90.0;
        Self {
            pivot: target,
            azimuth_deg: if zenith { 180.0 } else { azimuth },
            elevation_deg,
            distance: eye.distance(target),
            fov_deg: camera.fov_deg.into(),
        }
    }

    fn forward(&self) -> DVec3 {
        direction(self.azimuth_deg, self.elevation_deg)
    }

    /// Right vector; horizontal, since the camera never rolls.
    fn right(&self) -> DVec3 {
        direction(self.azimuth_deg + 90.0, 0.0)
    }

    fn eye(&self) -> DVec3 {
        self.pivot - self.forward() * self.distance
    }

    fn turn(&mut self, azimuth_deg: f64, elevation_deg: f64) {
        self.azimuth_deg = (self.azimuth_deg + azimuth_deg).rem_euclid(360.0);
        self.elevation_deg =
            (self.elevation_deg + elevation_deg).clamp(-MAX_PITCH_DEG, MAX_PITCH_DEG);
    }

    /// Interpolates to `other`; `t` in 0..1.
    fn toward(&self, other: &Self, t: f64) -> Self {
        let turn = (other.azimuth_deg - self.azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
        let mix = |a: f64, b: f64| a + (b - a) * t;
        Self {
            pivot: self.pivot.lerp(other.pivot, t),
            azimuth_deg: self.azimuth_deg + turn * t,
            elevation_deg: mix(self.elevation_deg, other.elevation_deg),
            distance: self.distance.powf(1.0 - t) * other.distance.powf(t),
            fov_deg: mix(self.fov_deg, other.fov_deg),
        }
    }
}

/// Travel from one pose to another.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Travel {
    from: Pose,
    to: Pose,
    elapsed_s: f64,
}

/// Camera controls.
#[derive(Debug, Clone, PartialEq)]
pub struct Controls {
    pose: Pose,
    near: f32,
    /// Scene size, metres; scales speeds and limits.
    size: f64,
    /// Scene centre, metres.
    centre: DVec3,
    /// Largest distance of the pivot from the scene centre and from the eye, metres.
    reach: f64,
    /// Wheel factor on the flight speed.
    speed: f64,
    /// Flight velocity, m/s.
    velocity: DVec3,
    travel: Option<Travel>,
}

impl Controls {
    /// Starts with `camera` in a scene within `bounds`. [`Controls::camera`] returns it unchanged until something moves.
    pub fn new(camera: &Camera, bounds: &Bounds) -> Self {
        let pose = Pose::of(camera);
        let centre = bounds.centre().as_dvec3();
        let diagonal = f64::from(bounds.diagonal());
        let size = if diagonal > 0.0 {
            diagonal
        } else {
            pose.distance
        };
        // A camera that starts farther away may stay there.
        let start = pose.distance.max(pose.pivot.distance(centre));
        Self {
            pose,
            near: camera.near,
            size,
            centre,
            reach: (REACH.1 * size).max(start),
            speed: 1.0,
            velocity: DVec3::ZERO,
            travel: None,
        }
    }

    /// The current camera.
    pub fn camera(&self) -> Camera {
        let eye = self.pose.eye();
        let nearest = TARGET_SHARE * eye.abs().max_element();
        let target = eye + self.pose.forward() * self.pose.distance.max(nearest);
        Camera {
            eye: eye.as_vec3(),
            target: target.as_vec3(),
            fov_deg: self.pose.fov_deg as f32,
            near: self.near,
        }
    }

    /// Orbit centre, metres.
    pub fn pivot(&self) -> DVec3 {
        self.pose.pivot
    }

    /// Flight speed without the fast or slow key, m/s.
    pub fn fly_speed(&self) -> f64 {
        CRUISE * self.size * self.speed
    }

    /// Whether the camera keeps moving without further events.
    pub fn is_moving(&self) -> bool {
        self.travel.is_some() || self.velocity != DVec3::ZERO
    }

    /// Orbits the eye about the pivot.
    pub fn orbit(&mut self, drag: Drag) {
        self.by_hand(drag, |pose, drag| {
            pose.turn(ORBIT_DEG * drag.right, -ORBIT_DEG * drag.down);
        });
    }

    /// Looks around; the eye stays in place.
    pub fn look(&mut self, drag: Drag) {
        self.by_hand(drag, |pose, drag| {
            let eye = pose.eye();
            pose.turn(LOOK_DEG * drag.right, -LOOK_DEG * drag.down);
            pose.pivot = eye + pose.forward() * pose.distance;
        });
    }

    /// Pans: points at the pivot's distance follow the pointer.
    pub fn pan(&mut self, drag: Drag) {
        self.by_hand(drag, |pose, drag| {
            let height = 2.0 * pose.distance * (0.5 * pose.fov_deg).to_radians().tan();
            let up = pose.right().cross(pose.forward());
            pose.pivot += (up * drag.down - pose.right() * drag.right) * height;
        });
    }

    /// Moves toward (`steps` > 0) or away from `about` (metres; default: the pivot). Each step scales the distance equally.
    pub fn dolly(&mut self, steps: f64, about: Option<DVec3>) {
        self.magnify(DOLLY_STEP.powf(-steps), about);
    }

    /// Moves toward (`ratio` > 1) or away from `about` (metres; default: the pivot), to the distance divided by `ratio`.
    pub fn magnify(&mut self, ratio: f64, about: Option<DVec3>) {
        let about = about.filter(|p| p.is_finite());
        if !ratio.is_finite() || ratio <= 0.0 {
            return;
        }
        self.travel = None;
        let distance = self.within_reach(self.pose.distance / ratio);
        let centre = about.unwrap_or(self.pose.pivot);
        // The pose is scaled about this point, so the point stays where it is in the image.
        self.pose.pivot = centre + (self.pose.pivot - centre) * (distance / self.pose.distance);
        self.pose.distance = distance;
        self.hold();
    }

    /// Increases (`steps` > 0) or decreases the flight speed.
    pub fn change_speed(&mut self, steps: f64) {
        if steps.is_finite() {
            let speed = self.speed * SPEED_STEP.powf(steps);
            self.speed = speed.clamp(SPEED_RANGE.0, SPEED_RANGE.1);
        }
    }

    /// Advances flight and travel by `seconds` with these keys held; returns whether the camera moved.
    pub fn advance(&mut self, seconds: f64, keys: FlyKeys) -> bool {
        let t = if seconds.is_finite() {
            seconds.clamp(0.0, LONGEST_STEP_S)
        } else {
            0.0
        };
        let before = self.pose;
        let goal = self.wanted_velocity(keys);
        if goal != DVec3::ZERO {
            self.travel = None;
        }
        self.travel_on(t);
        self.fly_on(goal, t);
        self.pose != before
    }

    /// Integrates dv/dt = (goal − v)/τ in closed form, independent of the frame rate.
    fn fly_on(&mut self, goal: DVec3, t: f64) {
        let left = (-t / INERTIA_S).exp();
        let lag = self.velocity - goal;
        self.pose.pivot += goal * t + lag * (INERTIA_S * (1.0 - left));
        self.velocity = goal + lag * left;
        if goal == DVec3::ZERO && self.velocity.length() < 1e-3 * self.fly_speed() {
            self.velocity = DVec3::ZERO;
        }
        self.hold();
    }

    fn wanted_velocity(&self, keys: FlyKeys) -> DVec3 {
        let axis = |plus: bool, minus: bool| f64::from(i8::from(plus) - i8::from(minus));
        let way = self.pose.forward() * axis(keys.forward, keys.back)
            + self.pose.right() * axis(keys.right, keys.left)
            + DVec3::Y * axis(keys.up, keys.down);
        let haste = FAST.powf(axis(keys.fast, keys.slow));
        way.normalize_or_zero() * (self.fly_speed() * haste)
    }

    fn travel_on(&mut self, t: f64) {
        let Some(travel) = &mut self.travel else {
            return;
        };
        travel.elapsed_s += t;
        let share = travel.elapsed_s / TRAVEL_S;
        self.pose = if share < 1.0 {
            // Ease in and out.
            travel
                .from
                .toward(&travel.to, share * share * (3.0 - 2.0 * share))
        } else {
            travel.to
        };
        if share >= 1.0 {
            self.travel = None;
        }
    }

    /// Travels to a pose that has all of `bounds` in view, in the current viewing direction. `aspect` is width / height.
    pub fn frame_all(&mut self, bounds: &Bounds, aspect: f32) {
        let mut pose = self.pose;
        pose.turn(0.0, 0.0);
        let toward_eye = -pose.forward().as_vec3();
        let framed =
            Camera::framing_from(bounds, toward_eye, pose.fov_deg as f32, aspect.max(1e-3));
        self.go(Pose {
            pivot: framed.target.as_dvec3(),
            distance: f64::from(framed.eye.distance(framed.target)),
            ..pose
        });
    }

    /// Travels to `camera`.
    pub fn go_to(&mut self, camera: &Camera) {
        self.go(Pose::of(camera));
    }

    /// Turns toward `point` (metres) and makes it the pivot. Does nothing when it is out of reach.
    pub fn focus(&mut self, point: DVec3) {
        let eye = self.pose.eye();
        let distance = eye.distance(point);
        let limits = REACH.0 * self.size..=self.reach;
        if !(point.is_finite() && limits.contains(&distance)) {
            return;
        }
        let (azimuth_deg, elevation_deg) = azimuth_elevation(point - eye);
        let mut pose = Pose {
            pivot: point,
            azimuth_deg,
            elevation_deg,
            distance,
            ..self.pose
        };
        pose.turn(0.0, 0.0);
        self.go(pose);
    }

    /// Completes a travel and stops flight at once.
    pub fn arrive(&mut self) {
        if let Some(travel) = self.travel.take() {
            self.pose = travel.to;
        }
        self.velocity = DVec3::ZERO;
    }

    fn go(&mut self, to: Pose) {
        self.velocity = DVec3::ZERO;
        self.travel = (to != self.pose).then_some(Travel {
            from: self.pose,
            to,
            elapsed_s: 0.0,
        });
    }

    /// Applies a drag and cancels any travel. Ignores zero and non-finite movement.
    fn by_hand(&mut self, drag: Drag, act: impl FnOnce(&mut Pose, Drag)) {
        if drag == Drag::default() || !(drag.right.is_finite() && drag.down.is_finite()) {
            return;
        }
        self.travel = None;
        act(&mut self.pose, drag);
        self.hold();
    }

    fn within_reach(&self, distance: f64) -> f64 {
        distance.clamp(REACH.0 * self.size, self.reach)
    }

    /// Clamps the pivot to within reach of the scene.
    fn hold(&mut self) {
        let offset = self.pose.pivot - self.centre;
        self.pose.pivot = self.centre + offset.clamp_length_max(self.reach);
    }
}

#[cfg(test)]
#[path = "controls_tests.rs"]
pub(super) mod tests;
