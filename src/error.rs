//! What ends the program: one line that names the thing and the remedy.

use std::path::PathBuf;

use crate::daylight::sun_position::SunPositionError;
use crate::gpu::GpuError;
use crate::options::{OptionsError, ResolveError};
use crate::scene::{SceneError, shown};
use crate::sensors::GridError;

/// Result of a command.
pub type Result<T> = std::result::Result<T, Error>;

/// Any failure.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// An option or a name that makes no sense.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// A scene that cannot be shown.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file of sensors that cannot be used.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A weather file that cannot be used.
    #[error("{}: {reason}", shown(path))]
    Weather {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A warning, of which `--strict` makes an error.
    #[error("{first}{more}; --strict makes warnings errors: nothing is written")]
    Strict {
        /// The first warning.
        first: String,
        /// How many more there are, or nothing.
        more: String,
    },
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A moment for which the sun cannot be placed.
    #[error(transparent)]
    Sun(#[from] SunPositionError),
    /// Nowhere to open a window.
    #[error("no display to open a window on ({0}); skylight render writes pictures without one")]
    NoDisplay(String),
    /// A window that another program destroyed.
    #[error("another program closed the window; skylight view --resume goes on where it was")]
    WindowGone,
    /// `--hdr on` on a screen without HDR.
    #[error("--hdr on: this window has no HDR signal; use --hdr auto. It offers {0}")]
    NoHdr(String),
    /// A device that was lost and could not be opened again: why.
    #[error("the device was lost (driver fault or reset), and opening it again failed: {0}")]
    LostForGood(Box<Error>),
    /// The command `view` in a build without the feature `window`.
    #[error(
        "this skylight is built without the window; skylight render writes pictures, and cargo build --release builds one with it"
    )]
    NoWindow,
    /// A file that cannot be written.
    #[error("cannot write {}: {reason}", shown(path))]
    Write {
        /// The file.
        path: PathBuf,
        /// Why, and what to do.
        reason: String,
    },
    /// A picture that cannot be read.
    #[error("cannot read {}: {reason}", shown(path))]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// Pictures that do not belong together.
    #[error("cannot compare: {0}")]
    Compare(String),
    /// Checks of a device that fail: which.
    #[error("{0}")]
    NotValid(String),
    /// Something takes longer than it may.
    #[error("slower than {factor} times {file}: {slower}")]
    Slower {
        /// The factor allowed.
        factor: f64,
        /// The earlier measurement.
        file: String,
        /// What is slower, with ratios.
        slower: String,
    },
    /// Ctrl-C before all was written.
    #[error("interrupted: {done} of {all} {what}")]
    Interrupted {
        /// How many are done.
        done: usize,
        /// How many were asked for.
        all: usize,
        /// What they are, and what became of them.
        what: &'static str,
    },
    /// Parts of a job that do not make a whole.
    #[error("cannot merge: {0}")]
    Merge(String),
    /// Results that nobody can read.
    #[error("cannot write to standard output: {0}")]
    Stdout(String),
}

impl From<ResolveError> for Error {
    fn from(error: ResolveError) -> Self {
        match error {
            ResolveError::Options(error) => Self::Options(error),
            ResolveError::Scene(error) => Self::Scene(error),
        }
    }
}

impl Error {
    /// Wrong usage: what is wrong, and the remedy.
    pub fn usage(what: impl Into<String>) -> Self {
        Self::Options(OptionsError(what.into()))
    }

    /// Whether nothing can be drawn any more.
    pub fn is_device_lost(&self) -> bool {
        matches!(self, Self::Gpu(error) if error.is_device_lost())
    }

    /// 2 for wrong usage, 1 for everything else.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Options(_) | Self::Sun(_) => 2,
            _ => 1,
        }
    }
}
