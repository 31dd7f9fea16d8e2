//! The structure of the crate: imports, `unsafe`, the table of the lecture, and the links of the texts.

#[path = "../common/texts.rs"]
mod texts;

mod lecture;
mod links;
mod rooms;
