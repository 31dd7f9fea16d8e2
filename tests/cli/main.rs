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
mod honeybee;
mod manual;
mod mitsuba_bake;
mod moment;
mod options;
mod peers;
mod series;
mod shards;
mod sky;
#[cfg(unix)]
mod slurm;
mod streams;
mod sun_hours;
mod tiles;
mod town;
mod validate;
mod vary;
mod weather;
