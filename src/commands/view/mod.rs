//! The interactive window.
//!
//! - [`controls`]: camera control by drags, wheel and keys; needs no device and no window. [`viewpoints`]: saved views.
//! - `app` and `events`: the event loop; `stage`: the window with its device; `document`: the open scene; `adaptation`: its
//!   exposure over time.
//! - `keys` and `input`: keyboard and mouse. `interface`: the user interface, panel by panel.
//! - `loader`: background loading. `capture`: screenshots. `resume`: settings of the last session.

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

/// Opens the window on `scene`, or on the bundled scene, and returns when it is closed; `resumes` restores the settings of
/// the last session with this scene.
///
/// # Errors
/// No display, no device that can present to it, or a lost device. Loading errors are shown in the window.
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
