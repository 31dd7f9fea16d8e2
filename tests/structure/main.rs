//! The structure of the crate: imports, `unsafe`, and the table of the lecture.

mod lecture;
mod rooms;
