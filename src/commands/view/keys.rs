//! What the keys do: one table for the event loop, the help and the README.

use winit::keyboard::{Key, NamedKey};

use crate::options::Show;

/// What a key or a button asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action {
    /// Hides the user interface, or shows it.
    ToggleInterface,
    /// Shows what the keys do.
    Help,
    /// Brings everything into view.
    FrameAll,
    /// Keeps this view.
    SaveViewpoint,
    /// Goes to the next view kept.
    NextViewpoint,
    /// Moves the time by so many hours.
    ShiftHours(f64),
    /// Lets the day pass, or stops it.
    Play,
    /// Puts the sun where one looks.
    LightFromView,
    /// Shows something else.
    Show(Show),
    /// Compass and sun path.
    ToggleSunPath,
    /// Times of the passes.
    ToggleTimings,
    /// Writes PNG and EXR.
    Screenshot,
    /// Puts the command that renders this picture on the clipboard.
    CopyCommand,
    /// Compiles the shaders anew.
    ReloadShaders,
    /// The window over the whole screen, or not.
    FullScreen,
    /// Closes what is open over the picture.
    Dismiss,
}

/// A line of the table.
pub(super) struct Binding {
    /// As people call it.
    pub(super) keys: &'static str,
    /// What it does.
    pub(super) what: &'static str,
}

/// Every key and gesture, in the order of the help.
pub(super) const BINDINGS: &[Binding] = &[
    binding("drag", "orbit about what is in the middle"),
    binding("right drag", "look around"),
    binding("middle drag, Shift + drag", "shift the view"),
    binding(
        "wheel",
        "nearer and farther, toward the pointer; while looking around: speed of flight",
    ),
    binding(
        "double click",
        "turn to what is under the pointer and orbit about it",
    ),
    binding("W A S D, Q E", "fly; with Shift faster, with Ctrl slower"),
    binding("F", "everything into view"),
    binding("O, Shift + O", "keep this viewpoint, go to the next"),
    binding("H, Shift + H", "half an hour of solar time later, earlier"),
    binding("Space", "let the day pass"),
    binding("L", "sun from where you look from"),
    binding(
        "1 .. 9",
        "show: beauty, sun, sky, sun-specular, sky-specular, visibility, occlusion, irradiance, normal",
    ),
    binding("X", "compass and sun path"),
    binding("T", "time of every pass"),
    binding("P, F12", "write the picture as PNG and EXR"),
    binding("C", "copy the command that renders this picture"),
    binding(
        "R",
        "reload the shaders (builds with the feature hot-reload)",
    ),
    binding("F11", "full screen"),
    binding("Tab", "hide and show everything but the picture"),
    binding("?", "this list"),
];

const fn binding(keys: &'static str, what: &'static str) -> Binding {
    Binding { keys, what }
}

/// The quantities on the digits, from 1.
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

/// What a key asks for, when no text is being edited.
pub(super) fn action(key: &Key, shift: bool) -> Option<Action> {
    match key {
        Key::Named(named) => named_action(*named),
        Key::Character(text) => character_action(text.chars().next()?, shift),
        _ => None,
    }
}

fn named_action(key: NamedKey) -> Option<Action> {
    match key {
        NamedKey::Tab => Some(Action::ToggleInterface),
        NamedKey::Space => Some(Action::Play),
        NamedKey::F1 => Some(Action::Help),
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
        'h' => Action::ShiftHours(if shift { -0.5 } else { 0.5 }),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(text: &str, shift: bool) -> Option<Action> {
        action(&Key::Character(text.into()), shift)
    }

    #[test]
    fn the_frameworks_keys_do_what_they_did() {
        assert_eq!(typed("h", false), Some(Action::ShiftHours(0.5)));
        assert_eq!(typed("H", true), Some(Action::ShiftHours(-0.5)));
        assert_eq!(typed("l", false), Some(Action::LightFromView));
        assert_eq!(typed("r", false), Some(Action::ReloadShaders));
        assert_eq!(typed("1", false), Some(Action::Show(Show::Beauty)));
        assert_eq!(typed("9", false), Some(Action::Show(Show::Normal)));
        assert_eq!(typed("0", false), None);
        assert_eq!(action(&Key::Named(NamedKey::F12), false), typed("p", false));
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
