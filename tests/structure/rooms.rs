//! Which top-level modules may import which, and where `unsafe` and barriers are allowed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

struct Source {
    path: String,
    text: String,
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every Rust file below a folder; it is a failure if there are none.
fn sources(folder: &str) -> Vec<Source> {
    let mut found = Vec::new();
    collect(&root().join(folder), &mut found);
    assert!(!found.is_empty(), "no sources in {folder}");
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

fn collect(folder: &Path, found: &mut Vec<Source>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for entry in entries {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).expect("text");
            let name = path.strip_prefix(root()).expect("below the root");
            found.push(Source {
                path: name.display().to_string(),
                text,
            });
        }
    }
}

/// Lines of code with their line numbers, without comments.
fn code(source: &Source) -> impl Iterator<Item = (usize, &str)> {
    source
        .text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.split("//").next().unwrap_or_default()))
}

/// Prints the result and fails if anything was found.
fn none(what: &str, checked: usize, faults: &[String]) {
    println!("{what}: {checked} checked, {} faults", faults.len());
    assert!(checked > 0, "{what}: nothing was checked");
    assert!(faults.is_empty(), "{what}:\n{}", faults.join("\n"));
}

/// Top-level modules named in a line: the words after `crate::`.
fn rooms_named(line: &str) -> impl Iterator<Item = &str> {
    line.split("crate::").skip(1).map(|rest| {
        let end = rest
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        &rest[..end]
    })
}

/// Lines of the module `room` that name a module outside of `allowed`.
fn imports_beyond(room: &str, allowed: &[&str]) -> (usize, Vec<String>) {
    let files = sources(&format!("src/{room}"));
    let faults = files
        .iter()
        .flat_map(|file| {
            code(file).flat_map(move |(number, line)| {
                rooms_named(line)
                    .filter(move |named| !allowed.contains(named))
                    .map(move |named| format!("{}:{number} names {named}", file.path))
            })
        })
        .collect();
    (files.len(), faults)
}

/// For each top-level module, the modules that it names outside its tests.
fn imports() -> (usize, BTreeMap<String, BTreeSet<String>>) {
    let files = sources("src");
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in &files {
        let path = file.path.trim_start_matches("src/").trim_end_matches(".rs");
        let module = path.split('/').next().unwrap_or_default();
        if path.ends_with("tests") || ["lib", "main"].contains(&module) {
            continue;
        }
        let named = imports.entry(module.to_owned()).or_default();
        // Tests are at the end of a file.
        let lines = code(file).take_while(|(_, line)| *line != "#[cfg(test)]");
        let found = lines.flat_map(|(_, line)| rooms_named(line));
        // The macro of `gpu` is exported at the root of the crate.
        let found = found.map(|name| if name == "gpu_struct" { "gpu" } else { name });
        named.extend(found.filter(|name| *name != module).map(str::to_owned));
    }
    (files.len(), imports)
}

#[test]
fn imports_have_no_cycle() {
    let (files, mut left) = imports();
    assert!(
        left["frame"].contains("passes"),
        "the search finds imports: {left:?}"
    );
    // Repeatedly removes modules that import none of the remaining ones: only cycles remain.
    loop {
        let names: BTreeSet<String> = left.keys().cloned().collect();
        let before = left.len();
        left.retain(|_, named| named.intersection(&names).next().is_some());
        if left.len() == before {
            break;
        }
    }
    let names: BTreeSet<String> = left.keys().cloned().collect();
    let faults: Vec<String> = left
        .iter()
        .map(|(module, named)| {
            let among: Vec<&str> = named.intersection(&names).map(String::as_str).collect();
            format!("{module} imports {}", among.join(", "))
        })
        .collect();
    none("cycles of imports", files, &faults);
}

#[test]
fn gpu_scene_and_daylight_import_nothing_of_ours() {
    for room in ["gpu", "scene", "daylight"] {
        // Macros are exported at the crate's root: `$crate::gpu` refers to the module itself.
        let (files, faults) = imports_beyond(room, &[room]);
        none(room, files, &faults);
    }
}

#[test]
fn passes_import_only_what_lies_below() {
    let below = ["gpu", "gpu_struct", "scene", "daylight", "passes"];
    let (files, faults) = imports_beyond("passes", &below);
    none("passes", files, &faults);
}

#[test]
fn scene_and_daylight_know_no_vulkan() {
    for room in ["scene", "daylight"] {
        let files = sources(&format!("src/{room}"));
        let faults: Vec<String> = files
            .iter()
            .flat_map(|f| code(f).map(move |(n, line)| (f, n, line)))
            .filter(|(_, _, line)| {
                // Match whole words: std::hash:: is not Vulkan.
                let names = |c: char| !c.is_alphanumeric() && c != '_' && c != ':';
                let mut paths = line.split(names);
                paths.any(|path| path.starts_with("ash::") || path.starts_with("vk::"))
            })
            .map(|(f, n, _)| format!("{}:{n}", f.path))
            .collect();
        none(room, files.len(), &faults);
    }
}

#[test]
fn passes_write_no_barriers() {
    let words = ["PipelineStageFlags", "AccessFlags", "ImageLayout", "ash::"];
    let files = sources("src/passes");
    let faults: Vec<String> = files
        .iter()
        .flat_map(|f| code(f).map(move |(n, line)| (f, n, line)))
        .filter(|(_, _, line)| words.iter().any(|word| line.contains(word)))
        .map(|(f, n, line)| format!("{}:{n}: {}", f.path, line.trim()))
        .collect();
    none("barriers in passes", files.len(), &faults);
}

#[test]
fn the_command_line_parser_is_known_to_cli_and_options_alone() {
    let all = sources("src");
    let is_inside = |f: &&Source| {
        let rest = f.path.trim_start_matches("src/");
        ["cli.rs", "cli/", "options.rs", "options/"]
            .iter()
            .any(|place| rest.starts_with(place))
    };
    let (inside, outside): (Vec<&Source>, Vec<&Source>) = all.iter().partition(is_inside);
    let names = |f: &&Source| {
        let lines = code(f).filter(|(_, line)| {
            line.split(|c: char| !c.is_alphanumeric() && c != '_')
                .any(|word| ["clap", "ValueEnum"].contains(&word))
        });
        let places = lines.map(|(n, _)| format!("{}:{n}", f.path));
        places.collect::<Vec<_>>()
    };
    let used: usize = inside.iter().map(|f| names(f).len()).sum();
    assert!(used > 5, "the search finds no clap where there is much");
    let faults: Vec<String> = outside.iter().flat_map(names).collect();
    none(
        "clap outside of src/cli and src/options",
        outside.len(),
        &faults,
    );
}

#[test]
fn unsafe_is_in_the_gpu_room_alone() {
    let all = sources("src");
    let (inside, outside): (Vec<_>, Vec<_>) =
        all.iter().partition(|f| f.path.starts_with("src/gpu/"));
    let has_unsafe = |f: &Source| {
        code(f)
            .filter(|(_, line)| {
                line.split(|c: char| !c.is_alphanumeric() && c != '_')
                    .any(|word| word == "unsafe" || word == "unsafe_code")
            })
            .map(|(n, _)| format!("{}:{n}", f.path))
            .collect::<Vec<_>>()
    };
    let used: usize = inside.iter().map(|f| has_unsafe(f).len()).sum();
    assert!(used > 10, "the search finds no unsafe where there is much");
    let faults: Vec<String> = outside.iter().flat_map(|f| has_unsafe(f)).collect();
    none("unsafe outside of src/gpu", outside.len(), &faults);
}
