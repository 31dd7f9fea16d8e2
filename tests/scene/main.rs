//! Models and scene files: importers, errors, hostile files, limits, and `tobj` as an oracle.

#[path = "../common/mod.rs"]
mod common;

mod breaks;
mod cases;
mod emission;
mod files;
mod fuzz;
mod hostile;
mod microfacets;
mod models;
mod support;
mod tobj_oracle;
