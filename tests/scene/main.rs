//! Models and scene files: what is read, what is refused, what hostile files do.

#[path = "../common/mod.rs"]
mod common;

mod files;
mod fuzz;
mod hostile;
mod invariants;
mod models;
mod tobj_oracle;
