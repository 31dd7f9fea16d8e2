//! Keyboard and mouse bindings, and their actions.

use winit::keyboard::{Key, KeyCode, NamedKey, PhysicalKey};

use crate::options::Show;

/// Action of a key or button.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action {
    /// Toggle the user interface.
    ToggleInterface,
    /// Work the panel by keyboard.
    Panel,
    /// Toggle the help.
    Help,
    /// Frame the subject of the scene.
    FrameAll,
    /// Save the current viewpoint.
    SaveViewpoint,
    /// Go to the next viewpoint.
    NextViewpoint,
    /// Shift the moment.
    Shift(Shift),
    /// Start or stop the clock.
    Play,
    /// Put the sun behind the camera.
    LightFromView,
    /// Show another quantity.
    Show(Show),
    /// Toggle compass and sun path.
    ToggleSunPath,
    /// Toggle the pass times.
    ToggleTimings,
    /// Save the image as PNG and EXR.
    Screenshot,
    /// Copy the command that renders this image.
    CopyCommand,
    /// Reload the shaders.
    ReloadShaders,
    /// Toggle full screen.
    FullScreen,
    /// Close the help and all messages.
    Dismiss,
}

/// A step in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shift {
    /// Hours of the clock.
    pub(super) hours: f64,
    /// Steps of a weather file instead, where its hours are shown.
    pub(super) records: Steps,
}

/// Steps through the hours of a weather file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Steps {
    /// To the next hour, or the one before.
    Hours(i64),
    /// To the same hour of another day.
    Days(i64),
}

/// One line in the help.
pub(super) struct Binding {
    /// Keys or mouse gesture.
    pub(super) keys: &'static str,
    /// What it does.
    pub(super) what: &'static str,
}

/// All keys and gestures, in help order.
pub(super) const BINDINGS: &[Binding] = &[
    binding("drag, one finger", "orbit about the centre of the view"),
    binding("right drag", "look around"),
    binding("middle drag, Shift + drag, two fingers", "pan"),
    binding(
        "wheel, pinch",
        "zoom toward the pointer; while looking around: flight speed",
    ),
    binding("double click", "orbit about the point under the pointer"),
    binding("W A S D, Q E", "fly; Shift: faster, Ctrl: slower"),
    binding(
        "F",
        "frame what is worth seeing: a house, not its whole ground",
    ),
    binding("O, Shift + O", "save this viewpoint; go to the next one"),
    binding(
        "H, Shift + H",
        "half an hour later, earlier; of a weather file the next hour, the one before",
    ),
    binding("J, Shift + J", "a day later, earlier"),
    binding("Space", "start or stop the clock"),
    binding("L", "put the sun behind the camera"),
    binding(
        "1 .. 9",
        "show: beauty, sun, sky, sun-specular, sky-specular, visibility, occlusion, irradiance, normal",
    ),
    binding("X", "compass and sun path"),
    binding("T", "time of each pass"),
    binding("P, F12", "save the picture as PNG and EXR"),
    binding("C", "copy the command that renders this picture"),
    binding(
        "R",
        "reload the shaders (builds with the feature hot-reload)",
    ),
    binding("F11", "full screen"),
    binding("Tab", "hide or show the user interface"),
    binding(
        "F6",
        "work the panel by keyboard: Tab to the next field, arrows change it, Esc back to the picture",
    ),
    binding("?", "this list"),
];

const fn binding(keys: &'static str, what: &'static str) -> Binding {
    Binding { keys, what }
}

/// Quantities on the keys 1 to 9.
pub(super) const DIGITS: [Show; 9] = [
    Show::Beauty,
    Show::Sun,
    Show::Sky,
    Show::SunSpecular,
    Show::SkySpecular,
    Show::Visibility,
    Show::Occlusion,
    Show::Irradiance,
    Show::Normal,
];

/// Action of a key while no text is being edited.
pub(super) fn action(key: &Key, shift: bool) -> Option<Action> {
    match key {
        Key::Named(named) => named_action(*named),
        Key::Character(text) => character_action(text.chars().next()?, shift),
        _ => None,
    }
}

/// Action of a digit by its place on the keyboard: on French ones the digits need Shift.
pub(super) fn digit(key: PhysicalKey) -> Option<Action> {
    const ROW: [KeyCode; 9] = [
        KeyCode::Digit1,
        KeyCode::Digit2,
        KeyCode::Digit3,
        KeyCode::Digit4,
        KeyCode::Digit5,
        KeyCode::Digit6,
        KeyCode::Digit7,
        KeyCode::Digit8,
        KeyCode::Digit9,
    ];
    let at = ROW.iter().position(|code| key == *code)?;
    Some(Action::Show(DIGITS[at]))
}

fn named_action(key: NamedKey) -> Option<Action> {
    match key {
        NamedKey::Tab => Some(Action::ToggleInterface),
        NamedKey::Space => Some(Action::Play),
        NamedKey::F1 => Some(Action::Help),
        NamedKey::F6 => Some(Action::Panel),
        NamedKey::F11 => Some(Action::FullScreen),
        NamedKey::F12 => Some(Action::Screenshot),
        NamedKey::Escape => Some(Action::Dismiss),
        _ => None,
    }
}

fn character_action(character: char, shift: bool) -> Option<Action> {
    let action = match character.to_ascii_lowercase() {
        'f' => Action::FrameAll,
        'o' if shift => Action::NextViewpoint,
        'o' => Action::SaveViewpoint,
        'h' => later(0.5, Steps::Hours(1), shift),
        'j' => later(24.0, Steps::Days(1), shift),
        'l' => Action::LightFromView,
        'x' => Action::ToggleSunPath,
        't' => Action::ToggleTimings,
        'p' => Action::Screenshot,
        'c' => Action::CopyCommand,
        'r' => Action::ReloadShaders,
        '?' => Action::Help,
        digit @ '1'..='9' => Action::Show(DIGITS[digit as usize - '1' as usize]),
        _ => return None,
    };
    Some(action)
}

/// A step in time, back with Shift.
fn later(hours: f64, records: Steps, is_back: bool) -> Action {
    let (sign, count) = if is_back { (-1.0, -1) } else { (1.0, 1) };
    Action::Shift(Shift {
        hours: sign * hours,
        records: match records {
            Steps::Hours(n) => Steps::Hours(count * n),
            Steps::Days(n) => Steps::Days(count * n),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(text: &str, shift: bool) -> Option<Action> {
        action(&Key::Character(text.into()), shift)
    }

    #[test]
    fn the_frameworks_keys_do_what_they_did() {
        let half = |hours, records| Some(Action::Shift(Shift { hours, records }));
        assert_eq!(typed("h", false), half(0.5, Steps::Hours(1)));
        assert_eq!(typed("H", true), half(-0.5, Steps::Hours(-1)));
        assert_eq!(typed("J", true), half(-24.0, Steps::Days(-1)));
        assert_eq!(typed("l", false), Some(Action::LightFromView));
        assert_eq!(typed("r", false), Some(Action::ReloadShaders));
        assert_eq!(typed("1", false), Some(Action::Show(Show::Beauty)));
        assert_eq!(typed("9", false), Some(Action::Show(Show::Normal)));
        assert_eq!(typed("0", false), None);
        assert_eq!(action(&Key::Named(NamedKey::F12), false), typed("p", false));
    }

    #[test]
    fn digits_are_known_by_their_place_too() {
        // The key of 1 on a French keyboard gives & without Shift.
        assert_eq!(typed("&", false), None);
        let first = digit(PhysicalKey::Code(KeyCode::Digit1));
        assert_eq!(first, typed("1", true));
        assert_eq!(digit(PhysicalKey::Code(KeyCode::Digit0)), None);
    }

    #[test]
    fn keys_of_flight_are_free() {
        for key in ["w", "a", "s", "d", "q", "e"] {
            assert_eq!(typed(key, false), None, "{key}");
        }
    }

    #[test]
    fn the_help_names_the_digits_in_their_order() {
        let names: Vec<&str> = DIGITS
            .iter()
            .map(|show| crate::options::name(*show))
            .collect();
        let line = BINDINGS
            .iter()
            .find(|b| b.keys == "1 .. 9")
            .expect("a line");
        assert_eq!(line.what, format!("show: {}", names.join(", ")));
    }
}
