//! Helpers shared by the test programs.
#![allow(dead_code)]

use std::path::PathBuf;

/// The folder `shared` beside the checkout, with the reference data.
///
/// Without it a message says that the test is skipped; with `SKYLIGHT_SHARED=require` in the environment it panics instead.
pub fn shared() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared");
    if folder.is_dir() {
        return Some(folder);
    }
    let required = std::env::var("SKYLIGHT_SHARED").is_ok_and(|value| value == "require");
    assert!(
        !required,
        "SKYLIGHT_SHARED=require, but ../shared is not beside the checkout"
    );
    println!("skipped: ../shared is not beside the checkout");
    None
}

/// Whether tests run in their long form: SKYLIGHT_SOAK=1 in the environment.
pub fn is_soaking() -> bool {
    std::env::var("SKYLIGHT_SOAK").is_ok_and(|value| value == "1")
}

/// A CSV file of `shared`: lines that begin with '#' are comments, the first other line names the columns.
pub struct Table {
    name: String,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads `name` of `shared/reference`, as [`Table::at`] does.
    pub fn read(name: &str) -> Option<Self> {
        Self::at(&format!("reference/{name}"))
    }

    /// Reads the file `name` within `shared`; `None` if the folder is absent. A missing file or an empty table is a failure.
    pub fn at(name: &str) -> Option<Self> {
        let path = shared()?.join(name);
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut lines = text
            .lines()
            .filter(|line| !line.starts_with('#') && !line.is_empty());
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let columns = cells(
            lines
                .next()
                .unwrap_or_else(|| panic!("{name} has no header")),
        );
        let rows: Vec<_> = lines.map(cells).collect();
        assert!(!rows.is_empty(), "{name} has no rows");
        assert!(
            rows.iter().all(|row| row.len() == columns.len()),
            "{name} is ragged"
        );
        Some(Self {
            name: name.to_owned(),
            columns,
            rows,
        })
    }

    /// The rows, in order.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        (0..self.rows.len()).map(move |index| Row { table: self, index })
    }
}

/// One row of a [`Table`].
#[derive(Clone, Copy)]
pub struct Row<'a> {
    table: &'a Table,
    /// Number of the row, from 0.
    pub index: usize,
}

impl<'a> Row<'a> {
    /// Text in the column `name`.
    pub fn text(self, name: &str) -> &'a str {
        let column = self.table.columns.iter().position(|c| c == name);
        let column = column.unwrap_or_else(|| panic!("{} has no column {name}", self.table.name));
        &self.table.rows[self.index][column]
    }

    /// Number in the column `name`.
    pub fn get(self, name: &str) -> f64 {
        let text = self.text(name);
        text.parse().unwrap_or_else(|e| {
            panic!("{} row {}: {name} {text}: {e}", self.table.name, self.index)
        })
    }

    /// Numbers in three columns, as a vector.
    pub fn get3(self, names: [&str; 3]) -> glam::DVec3 {
        glam::DVec3::from_array(names.map(|name| self.get(name)))
    }
}

/// The largest of many errors. Fails above its tolerance, and if no error was recorded.
pub struct Worst {
    what: &'static str,
    tolerance: f64,
    error: f64,
    at: String,
    count: usize,
}

impl Worst {
    /// The largest error of `what` may not exceed `tolerance`.
    pub fn new(what: &'static str, tolerance: f64) -> Self {
        Self {
            what,
            tolerance,
            error: 0.0,
            at: String::new(),
            count: 0,
        }
    }

    /// Records an error; NaN counts as the largest.
    pub fn see(&mut self, error: f64, at: impl std::fmt::Display) {
        self.count += 1;
        let error = if error.is_nan() {
            f64::INFINITY
        } else {
            error.abs()
        };
        if error > self.error {
            (self.error, self.at) = (error, at.to_string());
        }
    }

    /// Prints the count and the largest error; fails if it is above the tolerance or nothing was recorded.
    pub fn finish(self) {
        let Self {
            what,
            tolerance,
            error,
            at,
            count,
        } = self;
        println!(
            "{what}: {count} checked, largest error {error:.2e} (allowed {tolerance:.1e}) at {at}"
        );
        assert!(count > 0, "{what}: nothing was checked");
        assert!(
            error <= tolerance,
            "{what}: {error:e} exceeds {tolerance:e} at {at}"
        );
    }
}

/// The value that a share of the `values` does not exceed; sorts them.
pub fn at_share(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}
