//! Shaders, their identifiers, and tests named on the page `skylight::lecture` exist.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// All Rust code under `folder`, concatenated.
fn rust_text(folder: &Path) -> String {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths
        .map(|path| match path.extension() {
            _ if path.is_dir() => rust_text(&path),
            Some(extension) if extension == "rs" => fs::read_to_string(&path).expect("text"),
            _ => String::new(),
        })
        .collect()
}

/// The words between backticks.
fn names(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// The rows of the page's table: slide, formula, Rust, shader, test.
fn rows(page: &str) -> Vec<[&str; 5]> {
    let lines = page.lines().filter_map(|line| line.strip_prefix("//! | "));
    let cells = lines.filter_map(|line| {
        let cells: Vec<&str> = line.trim_end_matches('|').split(" | ").collect();
        <[&str; 5]>::try_from(cells).ok()
    });
    cells.filter(|row| row[0] != "slide").collect()
}

#[test]
fn shaders_and_tests_of_the_page_exist() {
    let page = fs::read_to_string(root().join("src/lecture.rs")).expect("the page");
    let tests = rust_text(&root().join("src")) + &rust_text(&root().join("tests"));
    let rows = rows(&page);
    assert!(rows.len() >= 20, "{} rows", rows.len());
    let (mut shaders, mut named) = (0, 0);
    for [slide, formula, _, shader, test] in rows {
        if let [file, identifiers @ ..] = &names(shader)[..] {
            let path = root().join("shaders_glsl").join(file);
            let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{slide}: {file}: {e}"));
            assert!(!identifiers.is_empty(), "{slide}: {formula}");
            for identifier in identifiers {
                assert!(
                    text.contains(identifier),
                    "{slide}: no {identifier} in {file}"
                );
                shaders += 1;
            }
        }
        for name in names(test) {
            let test = format!("#[test]\nfn {name}(");
            let unit = format!("#[test]\n    fn {name}(");
            let there = tests.contains(&test) || tests.contains(&unit);
            assert!(there, "{slide}: there is no test {name}");
            named += 1;
        }
    }
    println!("{shaders} identifiers of shaders and {named} tests are there");
    assert!(shaders >= 12 && named >= 20);
}
