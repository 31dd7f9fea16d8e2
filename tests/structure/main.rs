//! The structure of the crate: imports, `unsafe`, the map of the lecture.

mod lecture;
mod rooms;
