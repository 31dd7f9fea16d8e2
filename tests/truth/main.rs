//! Renders against path-traced references.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/truth.rs"]
mod truth;

mod annual;
mod bounces;
mod converged;
mod moments;
mod preview;
mod sensors;
