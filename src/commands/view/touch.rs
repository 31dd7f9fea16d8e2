//! Fingers on a touch screen: one orbits, two pan and zoom.

use winit::event::{Touch, TouchPhase};

use super::controls::{Controls, Drag};

/// Least distance of two fingers whose ratio counts, pixels: closer ones are measured too coarsely.
const LEAST_APART: f64 = 8.0;

/// The fingers on the picture.
#[derive(Debug, Default)]
pub(super) struct Touches {
    /// Number and place of each, pixels, from the earliest.
    fingers: Vec<(u64, [f64; 2])>,
}

impl Touches {
    /// Handles a finger in a window `height` pixels high. `is_taken`: it went down on the user interface.
    pub(super) fn on_touch(
        &mut self,
        touch: &Touch,
        height: f64,
        is_taken: bool,
        controls: Option<&mut Controls>,
    ) {
        let at: [f64; 2] = touch.location.into();
        match touch.phase {
            TouchPhase::Started if !is_taken => self.fingers.push((touch.id, at)),
            TouchPhase::Moved => {
                let before = self.fingers.clone();
                for finger in self.fingers.iter_mut().filter(|f| f.0 == touch.id) {
                    finger.1 = at;
                }
                if let Some(controls) = controls {
                    self.move_camera(&before, height.max(1.0), controls);
                }
            }
            TouchPhase::Ended | TouchPhase::Cancelled => self.fingers.retain(|f| f.0 != touch.id),
            TouchPhase::Started => {}
        }
    }

    fn move_camera(&self, before: &[(u64, [f64; 2])], height: f64, controls: &mut Controls) {
        let drag = |from: [f64; 2], to: [f64; 2]| Drag {
            right: (to[0] - from[0]) / height,
            down: (to[1] - from[1]) / height,
        };
        match (before, self.fingers.as_slice()) {
            ([(_, from)], [(_, to)]) => controls.orbit(drag(*from, *to)),
            ([(_, a), (_, b), ..], [(_, c), (_, d), ..]) => {
                controls.pan(drag(middle(*a, *b), middle(*c, *d)));
                let ratio = apart(*c, *d).max(LEAST_APART) / apart(*a, *b).max(LEAST_APART);
                controls.magnify(ratio, None);
            }
            _ => {}
        }
    }
}

fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| 0.5 * (a[i] + b[i]))
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::view::controls::tests::start;
    use winit::event::DeviceId;

    /// Touches of one screen, on a picture 100 pixels high.
    struct Screen {
        touches: Touches,
        controls: Controls,
    }

    impl Screen {
        fn touch(&mut self, id: u64, phase: TouchPhase, at: [f64; 2], is_taken: bool) {
            let touch = Touch {
                device_id: DeviceId::dummy(),
                phase,
                location: at.into(),
                force: None,
                id,
            };
            let controls = Some(&mut self.controls);
            self.touches.on_touch(&touch, 100.0, is_taken, controls);
        }

        fn distance(&self) -> f32 {
            let camera = self.controls.camera();
            camera.eye.distance(camera.target)
        }
    }

    #[test]
    fn one_finger_orbits_and_two_pan_and_zoom() {
        let mut screen = Screen {
            touches: Touches::default(),
            controls: start(),
        };
        let start = screen.controls.camera();
        screen.touch(1, TouchPhase::Started, [50.0, 50.0], false);
        screen.touch(1, TouchPhase::Moved, [60.0, 50.0], false);
        let turned = screen.controls.camera();
        assert!((turned.target - start.target).length() < 1e-5);
        assert!((turned.eye - start.eye).length() > 0.1);
        screen.touch(2, TouchPhase::Started, [80.0, 50.0], false);
        let far = screen.distance();
        // Twice as far apart, about another middle: half the distance, and another target.
        screen.touch(2, TouchPhase::Moved, [100.0, 50.0], false);
        assert!((screen.distance() / far - 0.5).abs() < 1e-5);
        assert!((screen.controls.camera().target - turned.target).length() > 0.01);
        screen.touch(1, TouchPhase::Ended, [60.0, 50.0], false);
        screen.touch(2, TouchPhase::Cancelled, [100.0, 50.0], false);
        let end = screen.controls.camera();
        screen.touch(3, TouchPhase::Moved, [10.0, 10.0], false);
        assert_eq!(screen.controls.camera(), end);
    }

    #[test]
    fn fingers_on_the_panel_leave_the_camera_alone() {
        let mut screen = Screen {
            touches: Touches::default(),
            controls: start(),
        };
        let start = screen.controls.camera();
        screen.touch(1, TouchPhase::Started, [50.0, 50.0], true);
        screen.touch(1, TouchPhase::Moved, [60.0, 50.0], false);
        assert_eq!(screen.controls.camera(), start);
    }
}
