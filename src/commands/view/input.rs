//! Camera movement from pointer and keyboard events that the user interface does not consume.

use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta};
use winit::keyboard::{KeyCode, ModifiersState, PhysicalKey};

use super::controls::{Controls, Drag, FlyKeys};

/// Scroll distance of one wheel step, pixels.
const PIXELS_A_STEP: f64 = 50.0;
/// Longest interval between the clicks of a double click, seconds.
const DOUBLE_CLICK_S: f64 = 0.4;
/// Largest pointer movement between the clicks of a double click, pixels.
const DOUBLE_CLICK_PIXELS: f64 = 4.0;

/// Effect of a drag.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Gesture {
    Orbit,
    Pan,
    Look,
}

/// Held keys and buttons, and the pointer position.
#[derive(Debug, Default)]
pub(super) struct Input {
    /// Modifier keys.
    pub(super) modifiers: ModifiersState,
    keys: FlyKeys,
    pointer: Option<[f64; 2]>,
    gesture: Option<(MouseButton, Gesture)>,
    clicked: Option<(f64, [f64; 2])>,
}

impl Input {
    /// Held flight keys with the current modifiers.
    pub(super) fn fly_keys(&self) -> FlyKeys {
        FlyKeys {
            fast: self.modifiers.shift_key(),
            slow: self.modifiers.control_key(),
            ..self.keys
        }
    }

    /// Whether any flight key is held.
    pub(super) fn is_flying(&self) -> bool {
        self.keys != FlyKeys::default()
    }

    /// Whether the user is dragging.
    pub(super) fn is_dragging(&self) -> bool {
        self.gesture.is_some()
    }

    /// Pointer position, pixels; `None` outside the window.
    pub(super) fn pointer(&self) -> Option<[f64; 2]> {
        self.pointer
    }

    /// Handles a key press or release. `free`: no text is being edited.
    pub(super) fn key(&mut self, event: &KeyEvent, free: bool) {
        let PhysicalKey::Code(code) = event.physical_key else {
            return;
        };
        let held = event.state == ElementState::Pressed && free;
        // Physical key codes: the same position on every keyboard layout.
        match code {
            KeyCode::KeyW => self.keys.forward = held,
            KeyCode::KeyS => self.keys.back = held,
            KeyCode::KeyA => self.keys.left = held,
            KeyCode::KeyD => self.keys.right = held,
            KeyCode::KeyE => self.keys.up = held,
            KeyCode::KeyQ => self.keys.down = held,
            _ => {}
        }
    }

    /// Releases the flight keys and ends the drag when the window loses focus: their release events will not arrive.
    pub(super) fn let_go(&mut self) {
        self.keys = FlyKeys::default();
        self.gesture = None;
    }

    /// Handles pointer movement to `to`, pixels, in a window `height` pixels high.
    pub(super) fn moved(&mut self, to: [f64; 2], height: f64, controls: Option<&mut Controls>) {
        let from = self.pointer.replace(to).unwrap_or(to);
        let (Some(controls), Some((_, gesture))) = (controls, self.gesture) else {
            return;
        };
        let drag = Drag {
            right: (to[0] - from[0]) / height.max(1.0),
            down: (to[1] - from[1]) / height.max(1.0),
        };
        match gesture {
            Gesture::Orbit => controls.orbit(drag),
            Gesture::Pan => controls.pan(drag),
            Gesture::Look => controls.look(drag),
        }
    }

    /// Handles the pointer leaving the window.
    pub(super) fn left(&mut self) {
        self.pointer = None;
    }

    /// Handles a button press over the image at `now`, seconds. Returns whether it completes a double click.
    pub(super) fn pressed(&mut self, button: MouseButton, now: f64) -> bool {
        let gesture = match button {
            MouseButton::Left if self.modifiers.shift_key() => Gesture::Pan,
            MouseButton::Left => Gesture::Orbit,
            MouseButton::Middle => Gesture::Pan,
            MouseButton::Right => Gesture::Look,
            _ => return false,
        };
        self.gesture = Some((button, gesture));
        let (Some(at), MouseButton::Left) = (self.pointer, button) else {
            return false;
        };
        let is_second = self.clicked.is_some_and(|(before, there)| {
            let apart = (at[0] - there[0]).hypot(at[1] - there[1]);
            now - before < DOUBLE_CLICK_S && apart < DOUBLE_CLICK_PIXELS
        });
        self.clicked = (!is_second).then_some((now, at));
        is_second
    }

    /// Handles a button release anywhere.
    pub(super) fn released(&mut self, button: MouseButton) {
        if self.gesture.is_some_and(|(held, _)| held == button) {
            self.gesture = None;
        }
    }

    /// Wheel steps, positive away from the user. They change the flight speed while looking around.
    pub(super) fn wheel(&self, delta: MouseScrollDelta) -> Wheel {
        let steps = match delta {
            MouseScrollDelta::LineDelta(_, rows) => f64::from(rows),
            MouseScrollDelta::PixelDelta(pixels) => pixels.y / PIXELS_A_STEP,
        };
        if self.gesture.is_some_and(|(_, g)| g == Gesture::Look) {
            Wheel::Speed(steps)
        } else {
            Wheel::Dolly(steps)
        }
    }
}

/// Effect of the wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wheel {
    /// Dolly in by this many steps.
    Dolly(f64),
    /// Increase the flight speed by this many steps.
    Speed(f64),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::view::controls::tests::start;

    #[test]
    fn a_drag_begins_where_the_button_went_down() {
        let mut input = Input::default();
        let mut controls = start();
        let first = controls.camera();
        input.moved([10.0, 10.0], 100.0, Some(&mut controls));
        assert_eq!(controls.camera(), first);
        input.pressed(MouseButton::Left, 0.0);
        input.moved([20.0, 10.0], 100.0, Some(&mut controls));
        assert_ne!(controls.camera(), first);
        let turned = controls.camera();
        input.released(MouseButton::Left);
        input.moved([90.0, 10.0], 100.0, Some(&mut controls));
        assert_eq!(controls.camera(), turned);
    }

    #[test]
    fn two_clicks_at_one_place_are_a_double_click() {
        let mut input = Input::default();
        input.moved([10.0, 10.0], 100.0, None);
        assert!(!input.pressed(MouseButton::Left, 1.0));
        assert!(input.pressed(MouseButton::Left, 1.2));
        // A third click starts over; a late or distant second click counts as a first one.
        assert!(!input.pressed(MouseButton::Left, 1.3));
        assert!(!input.pressed(MouseButton::Left, 2.0));
        input.moved([30.0, 10.0], 100.0, None);
        assert!(!input.pressed(MouseButton::Left, 2.1));
    }

    #[test]
    fn the_wheel_sets_the_speed_while_looking_around() {
        let mut input = Input::default();
        let step = MouseScrollDelta::LineDelta(0.0, 1.0);
        assert_eq!(input.wheel(step), Wheel::Dolly(1.0));
        input.pressed(MouseButton::Right, 0.0);
        assert_eq!(input.wheel(step), Wheel::Speed(1.0));
        input.let_go();
        assert_eq!(input.wheel(step), Wheel::Dolly(1.0));
    }
}
