//! The window: a walk through daylight.
//!
//! - [`controls`]: from drags, wheel and keys to a camera; no device, no window. [`viewpoints`]: places to come back to.
//! - `app` and `events`: the event loop; `stage`: the window with its device; `document`: the scene that is open.
//! - `keys` and `input`: what keys and pointer do. `interface`: what lies over the picture, panel by panel.
//! - `loader`: scenes in the background. `capture`: pictures to files. `resume`: settings for the next time.

mod adaptation;
mod app;
mod capture;
pub mod controls;
mod document;
mod events;
mod input;
mod interface;
mod keys;
mod loader;
mod resume;
mod stage;
mod style;
pub mod viewpoints;

use std::path::Path;

use winit::event_loop::EventLoop;

use crate::error::{Error, Result};
use crate::settings::Options;

use app::App;

/// Opens the window on `scene`, or on the bundled scene, and returns when it is closed; `resumes` with the settings that this
/// scene was left with.
///
/// # Errors
/// No display, no device that presents to it, or a device that is lost. A scene that cannot be loaded is told in the window.
pub fn run(scene: Option<&Path>, resumes: bool, options: Options) -> Result<()> {
    let options = if resumes {
        resume::recall(scene, options)?
    } else {
        options
    };
    let event_loop = EventLoop::with_user_event()
        .build()
        .map_err(|e| Error::NoDisplay(e.to_string()))?;
    let mut app = App::new(
        event_loop.create_proxy(),
        scene.map(Path::to_owned),
        options,
    );
    event_loop
        .run_app(&mut app)
        .map_err(|e| Error::NoDisplay(e.to_string()))?;
    app.into_result()
}
