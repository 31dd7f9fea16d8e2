//! Background loading: a thread reads the scene and reports its progress to the event loop.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use winit::event_loop::EventLoopProxy;

use crate::commands::job::load_options;
use crate::options::Options;
use crate::scene::{self, Loaded, SceneError};

use super::background::Wake;

/// Message from a loading thread to the event loop.
#[derive(Debug)]
pub(super) enum Message {
    /// Progress of a load.
    Progress {
        /// Number of the load; the newest is highest.
        ticket: u64,
        /// Progress, 0..1.
        share: f32,
        /// Current stage.
        stage: &'static str,
    },
    /// End of a load.
    Loaded {
        /// Number of the load.
        ticket: u64,
        /// Scene file; `None` for the bundled scene.
        path: Option<PathBuf>,
        /// The loaded scene, or an error.
        result: Box<Result<Loaded, SceneError>>,
    },
    /// Work in the background has ended ([`Background`](super::background::Background)).
    Done,
}

/// Starts loading threads. A new load supersedes earlier ones.
pub(super) struct Loader {
    proxy: EventLoopProxy<Message>,
    newest: u64,
}

impl Loader {
    pub(super) fn new(proxy: EventLoopProxy<Message>) -> Self {
        Self { proxy, newest: 0 }
    }

    /// Wakes the event loop.
    pub(super) fn wake(&self) -> Wake {
        let proxy = Mutex::new(self.proxy.clone());
        Arc::new(move || {
            let proxy = proxy.lock().unwrap_or_else(PoisonError::into_inner);
            // Fails only when the event loop has ended.
            let _ = proxy.send_event(Message::Done);
        })
    }

    /// Loads a scene in the background; the bundled one without `path`.
    pub(super) fn start(&mut self, path: Option<PathBuf>, options: &Options) {
        self.newest += 1;
        let (ticket, proxy, options) = (self.newest, self.proxy.clone(), load_options(options));
        thread::spawn(move || {
            let tell = |share: f32, stage: &'static str| {
                // Fails only when the event loop has ended.
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

    /// Whether `ticket` belongs to the newest load.
    pub(super) fn is_newest(&self, ticket: u64) -> bool {
        ticket == self.newest
    }
}
