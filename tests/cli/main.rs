//! End-to-end tests of the program: options, files, exit codes.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/pretended.rs"]
mod pretended;
#[path = "../common/texts.rs"]
mod texts;

mod bake;
mod bake_ktx2;
mod bench;
mod compare;
mod daylight;
mod daylight_facade;
mod daylight_pictures;
mod daylight_year;
mod devices;
mod false_colour;
mod gpu_check;
mod habits;
mod manual;
mod mitsuba_bake;
mod moment;
mod options;
mod peers;
mod series;
mod shards;
mod sky;
mod streams;
mod tiles;
mod town;
mod validate;
mod weather;
