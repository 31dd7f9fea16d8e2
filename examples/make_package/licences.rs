//! The crates that the program is linked from, and their licences.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::Result;

/// How the files of a licence begin, in capitals.
const NAMES: [&str; 5] = ["LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"];

/// Licences that the program may be given away with; each crate must offer one of them.
const ALLOWED: [&str; 16] = [
    "MIT",
    "MIT-0",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Zlib",
    "0BSD",
    "BSL-1.0",
    "CC0-1.0",
    "Unicode-3.0",
    "Unlicense",
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "LicenseRef-UFL-1.0",
    // Of a crate below `dirs`: its source, unchanged, is where the text below says.
    "MPL-2.0",
];

/// The text of all licences, and the number of crates.
pub fn collected(target: &str) -> Result<(String, usize)> {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--format-version",
            "1",
            "--locked",
            "--filter-platform",
            target,
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let metadata: Value = serde_json::from_slice(&output.stdout)?;
    let linked = linked(&metadata)?;
    let mut text =
        "skylight is linked from these crates, whose sources are at https://crates.io/crates/NAME, unchanged. The texts of their licences follow, each \
         once.\n\n"
            .to_owned();
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let packages = list(&metadata["packages"])?.iter();
    let mut packages: Vec<&Value> = packages
        .filter(|p| linked.contains(&p["id"].to_string()))
        .collect();
    packages.sort_by_key(|p| (p["name"].to_string(), p["version"].to_string()));
    for package in &packages {
        let name = format!("{} {}", word(package, "name")?, word(package, "version")?);
        let licence = word(package, "license").unwrap_or("see its text");
        if !is_allowed(licence) {
            return Err(format!("{name}: the licence {licence} is not one of those known").into());
        }
        writeln!(text, "{name}: {licence}")?;
        for file in files(Path::new(word(package, "manifest_path")?))? {
            let licence = String::from_utf8_lossy(&fs::read(file)?).trim().to_owned();
            texts.entry(licence).or_default().push(name.clone());
        }
    }
    for (licence, crates) in texts {
        write!(text, "\n{:=<100}\n{}\n\n{licence}\n", "", crates.join(", "))?;
    }
    Ok((text, packages.len()))
}

/// Identifiers of the packages that the program is linked from: its dependencies and theirs, without those of builds and tests.
fn linked(metadata: &Value) -> Result<BTreeSet<String>> {
    let nodes = list(&metadata["resolve"]["nodes"])?;
    let nodes: BTreeMap<String, &Value> = nodes.iter().map(|n| (n["id"].to_string(), n)).collect();
    let root = metadata["resolve"]["root"].to_string();
    let (mut found, mut open) = (BTreeSet::new(), vec![root.clone()]);
    while let Some(id) = open.pop() {
        for dependency in list(&nodes[&id]["deps"])? {
            let kinds = list(&dependency["dep_kinds"])?;
            let id = dependency["pkg"].to_string();
            if kinds.iter().any(|kind| kind["kind"].is_null()) && found.insert(id.clone()) {
                open.push(id);
            }
        }
    }
    Ok(found)
}

/// Whether all parts of one of the alternatives are known: an expression of SPDX, `A OR B`, `A AND (B OR C)`, exceptions after WITH; an old `A/B`
/// counts as OR.
fn is_allowed(licence: &str) -> bool {
    let licence = licence.trim();
    let parts = |word| split(licence, word);
    if let [_, _, ..] = parts(" OR ").as_slice() {
        return parts(" OR ").into_iter().any(is_allowed);
    }
    if let [_, _, ..] = parts(" AND ").as_slice() {
        return parts(" AND ").into_iter().all(is_allowed);
    }
    if let Some(inner) = licence.strip_prefix('(').and_then(|l| l.strip_suffix(')')) {
        return is_allowed(inner);
    }
    let mut names = licence.split('/');
    names.any(|name| ALLOWED.contains(&name.split(" WITH ").next().unwrap_or_default().trim()))
}

/// The parts between a word outside of parentheses.
fn split<'l>(text: &'l str, word: &str) -> Vec<&'l str> {
    let (mut parts, mut start, mut depth) = (Vec::new(), 0, 0);
    for (at, character) in text.char_indices() {
        depth += i32::from(character == '(') - i32::from(character == ')');
        if depth == 0 && at >= start && text[at..].starts_with(word) {
            parts.push(&text[start..at]);
            start = at + word.len();
        }
    }
    parts.push(&text[start..]);
    parts
}

/// The files of a licence beside a manifest.
fn files(manifest: &Path) -> Result<Vec<PathBuf>> {
    let folder = manifest.parent().ok_or("a manifest has a folder")?;
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_uppercase();
        if path.is_file() && NAMES.iter().any(|begin| name.starts_with(begin)) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn list(value: &Value) -> Result<&Vec<Value>> {
    value
        .as_array()
        .ok_or_else(|| "cargo metadata has another form".into())
}

fn word<'v>(value: &'v Value, key: &str) -> Result<&'v str> {
    value[key]
        .as_str()
        .ok_or_else(|| format!("cargo metadata: no {key}").into())
}
