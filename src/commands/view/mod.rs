//! The interactive window.
//!
//! - [`controls`]: camera control by drags, wheel and keys; needs neither device nor window. [`viewpoints`]: saved views.
//! - `app` and `events`: the event loop. `stage`: the window and its device. `document`: the open scene. `adaptation`: its
//!   exposure over time.
//! - `keys`, `input` and `touch`: keyboard, mouse and touch screen. `interface`: the user interface, panel by panel.
//! - `trouble`: what is done about errors, a lost device among them.
//! - `background`: work of other threads. `loader` and `opening`: scenes are read, and prepared for the device. `light_ahead` and `passes_ahead`: daylight and passes of changed options,
//!   made while the window goes on. `year`: the hours of a weather file. `desk`: sensors of a grid, drawn by `grid_overlay`. `surfaces`: changed reflectances. `capture`: screenshots. `pace`: measures frames. `resume`: settings of the last session.

mod adaptation;
mod app;
mod background;
mod capture;
pub mod controls;
mod desk;
mod document;
mod events;
mod grid_overlay;
mod input;
mod interface;
mod keys;
mod light_ahead;
mod loader;
mod opening;
mod pace;
mod passes_ahead;
mod resume;
mod stage;
mod style;
mod surfaces;
mod touch;
mod trouble;
pub mod viewpoints;
mod year;

use std::path::Path;

use winit::event_loop::EventLoop;

use crate::cli::ViewArgs;
use crate::commands::hour::window;
use crate::error::{Error, Result};
use crate::options::OptionValues;
use crate::scene::bundled_name;

use app::App;
use desk::Grid;
use document::Asked;

/// The scene without one on the command line, if no file of that name is in the way.
const OPENING: &str = "island";

/// Opens the window on a scene, or on a bundled one, and returns when it is closed.
///
/// # Errors
/// No display, no device that can present to it, a window that another program destroyed, or a device that was lost twice. A
/// scene that fails to load is reported in the window.
pub fn run(args: &ViewArgs, user: OptionValues) -> Result<()> {
    let scene = args.scene.as_deref();
    let (user, weather) = window(&args.at, scene, user)?;
    let opening = Path::new(OPENING);
    let scene = scene.or_else(|| bundled_name(opening).map(|_| opening));
    let user = if args.resume {
        resume::recall(scene, user)?
    } else {
        user
    };
    let options = user.alone()?;
    let event_loop = EventLoop::with_user_event()
        .build()
        .map_err(|e| Error::NoDisplay(reason(&e)))?;
    let mut app = App::new(
        event_loop.create_proxy(),
        scene.map(Path::to_owned),
        Asked {
            options: user,
            weather,
            grid: Grid::asked(args),
        },
        options,
    );
    event_loop
        .run_app(&mut app)
        .map_err(|e| Error::NoDisplay(reason(&e)))?;
    app.into_result()
}

/// The message of a winit error without its prefix `os error at FILE:LINE: `.
fn reason(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    let after_line = |rest: &str| {
        let rest = rest.trim_start_matches(|c: char| c.is_ascii_digit());
        rest.trim_start_matches(": ").to_owned()
    };
    match text.split_once(".rs:") {
        Some((_, rest)) => after_line(rest),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::reason;

    #[test]
    fn no_place_in_a_source_is_told() {
        let long = "os error at /home/me/.cargo/x/mod.rs:765: neither DISPLAY nor another: is set.";
        assert_eq!(reason(&long), "neither DISPLAY nor another: is set.");
        assert_eq!(reason(&"event loop gone"), "event loop gone");
    }
}
