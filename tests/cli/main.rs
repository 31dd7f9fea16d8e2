//! End-to-end tests of the program: options, files, exit codes.

mod bake;
mod bake_ktx2;
mod bench;
mod compare;
mod daylight;
mod false_colour;
mod mitsuba_bake;
mod moment;
mod options;
mod sky;
mod tiles;
mod weather;
