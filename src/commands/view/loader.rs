//! Loading off the event loop: a thread reads the scene and tells how far it is; the window goes on.

use std::path::PathBuf;
use std::thread;

use winit::event_loop::EventLoopProxy;

use crate::commands::job::load_options;
use crate::scene::{self, Loaded, SceneError};
use crate::settings::Options;

/// What threads tell the event loop.
#[derive(Debug)]
pub(super) enum Message {
    /// How far a load is.
    Progress {
        /// Which load.
        ticket: u64,
        /// 0..1.
        share: f32,
        /// What is being done.
        stage: &'static str,
    },
    /// The end of a load.
    Loaded {
        /// Which load.
        ticket: u64,
        /// From where.
        path: Option<PathBuf>,
        /// The scene, or why not.
        result: Box<Result<Loaded, SceneError>>,
    },
}

/// Starts loads; only the newest counts.
pub(super) struct Loader {
    proxy: EventLoopProxy<Message>,
    newest: u64,
}

impl Loader {
    pub(super) fn new(proxy: EventLoopProxy<Message>) -> Self {
        Self { proxy, newest: 0 }
    }

    /// Loads a scene (or the bundled one) in the background.
    pub(super) fn start(&mut self, path: Option<PathBuf>, options: &Options) {
        self.newest += 1;
        let (ticket, proxy, options) = (self.newest, self.proxy.clone(), load_options(options));
        thread::spawn(move || {
            let tell = |share: f32, stage: &'static str| {
                // A window that is gone needs to hear nothing.
                let _ = proxy.send_event(Message::Progress {
                    ticket,
                    share,
                    stage,
                });
            };
            let result = Box::new(scene::load_with_progress(path.as_deref(), &options, &tell));
            let _ = proxy.send_event(Message::Loaded {
                ticket,
                path,
                result,
            });
        });
    }

    /// Whether a message is about the newest load.
    pub(super) fn is_newest(&self, ticket: u64) -> bool {
        ticket == self.newest
    }
}
