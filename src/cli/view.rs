//! The arguments of the window.

use std::path::PathBuf;

use clap::Args;

use super::HourArgs;

/// What the window opens on.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct ViewArgs {
    /// Scene file (.toml), model (.obj, .gltf, .glb), or bundled scene (island, the default; colonnade).
    pub scene: Option<PathBuf>,
    /// Start with the options and the camera that this scene was last closed with.
    #[arg(long)]
    pub resume: bool,
    /// The year of a weather file, and an hour of it to begin with.
    #[command(flatten)]
    pub at: HourArgs,
    /// Sensors whose values are shown: lines of x y z, or x y z and a normal, as of skylight daylight.
    #[arg(long, value_name = "FILE", conflicts_with = "plane")]
    pub grid: Option<PathBuf>,
    /// Makes the sensors instead: this height above the floor of every room, metres.
    #[arg(long, value_name = "M", value_parser = crate::options::plane_height)]
    pub plane: Option<f64>,
    /// Largest distance from one made sensor to the next, metres.
    #[arg(long, value_name = "M", requires = "plane", default_value_t = 0.5, value_parser = crate::options::spacing)]
    pub spacing: f64,
}
