//! The window on a virtual display.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/pretended.rs"]
mod pretended;
#[path = "../common/running.rs"]
mod running;
#[path = "../common/x.rs"]
mod x;

mod desk;
mod devices;
mod faults;
mod hdr;
#[cfg(feature = "hot-reload")]
mod hot_reload;
mod life;
mod pace;
mod rest;
mod screens;
mod surfaces;
