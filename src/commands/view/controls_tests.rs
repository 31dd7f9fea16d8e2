use super::*;
use crate::daylight::sampling::rnd;
use glam::Vec3;

fn house() -> Bounds {
    Bounds {
        min: Vec3::new(-5.0, 0.0, -4.0),
        max: Vec3::new(5.0, 8.0, 4.0),
    }
}

/// Before a house.
pub(in crate::commands::view) fn start() -> Controls {
    Controls::new(&Camera::framing(&house(), 45.0, 1.5), &house())
}

struct Random(u32);

impl Random {
    /// Next number in 0..1.
    fn next(&mut self) -> f64 {
        rnd(&mut self.0)
    }

    fn within(&mut self, size: f64) -> f64 {
        (2.0 * self.next() - 1.0) * size
    }

    fn drag(&mut self, size: f64) -> Drag {
        Drag {
            right: self.within(size),
            down: self.within(size),
        }
    }

    fn key(&mut self) -> bool {
        self.next() < 0.3
    }

    fn keys(&mut self) -> FlyKeys {
        FlyKeys {
            forward: self.key(),
            back: self.key(),
            left: self.key(),
            right: self.key(),
            up: self.key(),
            down: self.key(),
            fast: self.key(),
            slow: self.key(),
        }
    }
}

fn something(controls: &mut Controls, random: &mut Random) {
    match (random.next() * 10.0) as u32 {
        0 => controls.orbit(random.drag(2.0)),
        1 => controls.look(random.drag(2.0)),
        2 => controls.pan(random.drag(2.0)),
        3 => controls.dolly(random.within(20.0), None),
        4 => {
            let point = DVec3::from_array([(); 3].map(|()| random.within(9.0)));
            controls.dolly(random.within(5.0), Some(point));
        }
        5 => controls.change_speed(random.within(9.0)),
        6 => controls.frame_all(&house(), 1.5),
        7 => controls.focus(DVec3::from_array([(); 3].map(|()| random.within(9.0)))),
        8 => controls.orbit(Drag {
            right: f64::NAN,
            down: f64::INFINITY,
        }),
        _ => {
            let keys = random.keys();
            controls.advance(random.next(), keys);
        }
    }
}

#[test]
fn it_never_stands_on_its_head_nor_leans() {
    let mut random = Random(1);
    let mut controls = start();
    for step in 0..100_000 {
        something(&mut controls, &mut random);
        let camera = controls.camera();
        let world_from_view = camera.world_from_view();
        assert!(world_from_view.is_finite(), "{step}: {camera:?}");
        let (right, up) = (world_from_view.x_axis, world_from_view.y_axis);
        assert!(up.y > 0.0, "{step}: up is {up}");
        assert!(right.y.abs() < 1e-4, "{step}: right is {right}");
        let off = camera.eye.distance(house().centre());
        assert!(off < 300.0 * house().diagonal(), "{step}: {off} m off");
    }
}

#[test]
fn untouched_it_is_the_camera_it_was_given() {
    let mut random = Random(2);
    for _ in 0..1000 {
        let mut point = || Vec3::from_array([(); 3].map(|()| random.within(50.0) as f32));
        let camera = Camera {
            eye: point(),
            target: point(),
            fov_deg: 37.0,
            near: 0.01,
        };
        let mut controls = Controls::new(&camera, &house());
        assert_eq!(controls.camera(), camera);
        assert!(!controls.advance(0.1, FlyKeys::default()));
        assert_eq!(controls.camera(), camera);
    }
    for target in [Vec3::Y, Vec3::NEG_Y] {
        let vertical = Camera {
            eye: Vec3::ZERO,
            target,
            fov_deg: 40.0,
            near: 0.01,
        };
        let mut controls = Controls::new(&vertical, &house());
        let untouched = controls.camera().view_from_world();
        assert!(untouched.abs_diff_eq(vertical.view_from_world(), 1e-6));
        controls.orbit(Drag {
            right: 1e-9,
            down: 0.0,
        });
        let touched = controls.camera().view_from_world();
        // Turned by half a degree, not by half a turn.
        assert!(touched.abs_diff_eq(untouched, 0.02), "{target}");
    }
}

#[test]
fn orbit_keeps_the_distance_and_look_the_eye() {
    let mut random = Random(3);
    let mut controls = start();
    let (pivot, distance) = (controls.pivot(), controls.pose.distance);
    for _ in 0..10_000 {
        controls.orbit(random.drag(1.0));
        assert_eq!(controls.pivot(), pivot);
        let eye = controls.camera().eye.as_dvec3();
        assert!((eye.distance(pivot) / distance - 1.0).abs() < 1e-6);
    }
    let eye = controls.pose.eye();
    for _ in 0..10_000 {
        controls.look(random.drag(1.0));
        assert!(controls.pose.eye().distance(eye) < 1e-9);
    }
}

#[test]
fn dragging_right_brings_the_left_side_of_the_model_to_view() {
    // Seen from the south, left is west, so the eye moves west.
    let south = Camera {
        eye: Vec3::new(0.0, 4.0, 30.0),
        target: Vec3::new(0.0, 4.0, 0.0),
        fov_deg: 45.0,
        near: 0.01,
    };
    let mut controls = Controls::new(&south, &house());
    controls.orbit(Drag {
        right: 0.1,
        down: 0.0,
    });
    assert!(controls.camera().eye.x < -1.0);
    controls.orbit(Drag {
        right: 0.0,
        down: 0.1,
    });
    assert!(
        controls.camera().eye.y > 5.0,
        "pulling down looks from above"
    );
}

#[test]
fn pan_holds_what_is_under_the_pointer() {
    let mut controls = start();
    controls.orbit(Drag {
        right: 0.3,
        down: 0.2,
    });
    let aspect = 1.5;
    let project = |camera: &Camera, p: Vec3| {
        let clip_from_world = camera.clip_from_view(aspect) * camera.view_from_world();
        clip_from_world.project_point3(p)
    };
    let point = controls.pivot().as_vec3();
    let before = project(&controls.camera(), point);
    controls.pan(Drag {
        right: 0.25,
        down: -0.1,
    });
    let moved = project(&controls.camera(), point) - before;
    // Clip space is two units high; one image height across is 2 / aspect units.
    assert!((moved.x - 0.25 * 2.0 / aspect).abs() < 1e-4, "{moved}");
    assert!((moved.y + 0.1 * 2.0).abs() < 1e-4, "{moved}");
}

#[test]
fn dolly_in_and_out_is_nothing() {
    let mut random = Random(4);
    for about in [None, Some(DVec3::new(3.0, 2.0, -1.0))] {
        let mut controls = start();
        for _ in 0..1000 {
            let (steps, before) = (random.within(10.0), controls.pose);
            controls.dolly(steps, about);
            let closer = controls.pose.distance < before.distance;
            assert_eq!(closer, steps > 0.0);
            controls.dolly(-steps, about);
            assert!(controls.pose.eye().distance(before.eye()) < 1e-9);
        }
        controls.dolly(1e6, about);
        assert!(controls.pose.distance > 0.0, "the pivot is never reached");
    }
}

#[test]
fn dolly_holds_the_point_it_goes_to() {
    let mut controls = start();
    let point = Vec3::new(4.0, 7.0, 3.0);
    let seen = |c: &Controls| {
        let camera = c.camera();
        (camera.clip_from_view(1.5) * camera.view_from_world()).project_point3(point)
    };
    let before = seen(&controls);
    controls.dolly(5.0, Some(point.as_dvec3()));
    let after = seen(&controls);
    assert!(
        (after - before).truncate().length() < 1e-4,
        "{before} {after}"
    );
}

#[test]
fn flight_does_not_depend_on_the_rate_of_frames() {
    let held = FlyKeys {
        forward: true,
        up: true,
        ..FlyKeys::default()
    };
    let fast = FlyKeys { fast: true, ..held };
    let phases = [held, fast, FlyKeys::default()];
    let flight = |rate: u32, phases: &[FlyKeys]| {
        let mut controls = start();
        for keys in phases {
            for _ in 0..rate {
                controls.advance(1.0 / f64::from(rate), *keys);
            }
        }
        controls
    };
    for (count, tolerance) in [(1, 1e-12), (2, 1e-12), (3, 1e-3)] {
        let [slow, quick] = [5, 240].map(|rate| flight(rate, &phases[..count]));
        let way = slow.pivot().distance(start().pivot());
        let apart = slow.pivot().distance(quick.pivot());
        println!("flight of {way:.3} m: 5 and 240 frames a second end {apart:.1e} m apart");
        assert!(apart < tolerance * way, "{apart}");
    }
    let end = flight(60, &phases);
    // One second at cruise speed and one at four times that.
    let way = end.pivot().distance(start().pivot());
    assert!((way / (5.0 * start().fly_speed()) - 1.0).abs() < 1e-3);
    assert!(!end.is_moving(), "it comes to rest");
}

#[test]
fn flight_grows_with_the_scene_and_the_wheel() {
    let large = Bounds {
        min: house().min * 100.0,
        max: house().max * 100.0,
    };
    let far = Controls::new(&Camera::framing(&large, 45.0, 1.5), &large);
    assert!((far.fly_speed() / start().fly_speed() / 100.0 - 1.0).abs() < 1e-5);
    let mut controls = start();
    controls.change_speed(2.0);
    assert!(controls.fly_speed() > 1.5 * start().fly_speed());
    controls.change_speed(-2.0);
    assert!((controls.fly_speed() / start().fly_speed() - 1.0).abs() < 1e-12);
}

#[test]
fn framing_shows_all_of_it_from_anywhere() {
    let mut random = Random(5);
    for _ in 0..1000 {
        let aspect = (0.2 + 4.0 * random.next()) as f32;
        let mut controls = start();
        for _ in 0..5 {
            something(&mut controls, &mut random);
        }
        controls.frame_all(&house(), aspect);
        controls.arrive();
        let camera = controls.camera();
        let clip_from_world = camera.clip_from_view(aspect) * camera.view_from_world();
        for corner in house().corners() {
            let clip = clip_from_world * corner.extend(1.0);
            let inside =
                clip.w > camera.near && clip.truncate().truncate().abs().max_element() <= clip.w;
            assert!(
                inside,
                "aspect {aspect}: {corner} at {clip} from {camera:?}"
            );
        }
    }
}

#[test]
fn a_journey_ends_at_the_viewpoint_in_time() {
    let goal = Camera {
        eye: Vec3::new(-9.0, 2.0, 7.0),
        target: Vec3::new(1.0, 3.0, 0.0),
        fov_deg: 60.0,
        near: start().near,
    };
    let mut controls = start();
    controls.go_to(&goal);
    let mut frames = 0;
    while controls.is_moving() {
        assert!(controls.advance(0.01, FlyKeys::default()));
        frames += 1;
    }
    assert_eq!(controls.camera(), goal);
    assert!((30..40).contains(&frames), "{frames} frames of 10 ms");
    // A drag cancels the travel.
    controls.frame_all(&house(), 1.5);
    controls.orbit(Drag {
        right: 0.1,
        down: 0.0,
    });
    assert!(!controls.is_moving());
}

#[test]
fn focus_looks_at_the_point() {
    let mut controls = start();
    let eye = controls.camera().eye;
    let point = DVec3::new(4.0, 7.0, 3.0);
    controls.focus(point);
    controls.arrive();
    let camera = controls.camera();
    assert!(camera.eye.distance(eye) < 1e-4 && controls.pivot() == point);
    assert!((camera.target.as_dvec3() - point).length() < 1e-4);
}
