//! Links of the texts: the file is there, the heading is there, every page is in the book, and no picture is unused.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::texts::{Text, root, texts};

/// Names of headings as GitHub and mdBook make them: lower case, without punctuation, blanks as hyphens, a number behind repeated ones.
fn anchors(text: &Text) -> BTreeSet<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let prose = text.prose();
    let headings = prose.iter().filter_map(|(_, line)| {
        let rest = line.trim_start_matches('#');
        (rest.len() < line.len()).then(|| rest.strip_prefix(' '))?
    });
    let anchor = |heading: &str| {
        let kept = heading.trim().to_lowercase();
        let kept = kept
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c })
            .collect::<String>()
    };
    let mut names = BTreeSet::new();
    for name in headings.map(anchor) {
        let times = seen.entry(name.clone()).or_default();
        names.insert(match *times {
            0 => name,
            n => format!("{name}-{n}"),
        });
        *times += 1;
    }
    names
}

/// Targets of the links and pictures of a line, in Markdown and in HTML.
fn targets(line: &str) -> Vec<String> {
    // Code is no link.
    let outside: String = line.split('`').step_by(2).collect::<Vec<_>>().join("");
    let after = |start: &str, end: char| {
        let parts: Vec<String> = outside
            .split(start)
            .skip(1)
            .filter_map(|rest| rest.split_once(end))
            .map(|(target, _)| target.to_owned())
            .collect();
        parts
    };
    [
        after("](", ')'),
        after("src=\"", '"'),
        after("href=\"", '"'),
    ]
    .concat()
}

/// The file that a link leads to, and its anchor; `None` for other sites.
fn resolved(text: &Text, target: &str) -> Option<(PathBuf, Option<String>)> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = match target.split_once('#') {
        Some((file, anchor)) => (file, Some(anchor.to_owned())),
        None => (target, None),
    };
    let path = match file {
        "" => root().join(&text.name),
        file => text.folder().join(file),
    };
    Some((path, anchor))
}

fn canonical(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}

#[test]
fn links_and_their_anchors_are_there() {
    let texts = texts();
    let of_path: BTreeMap<PathBuf, &Text> = texts
        .iter()
        .filter_map(|text| Some((canonical(&root().join(&text.name))?, text)))
        .collect();
    let (mut links, mut with_anchor, mut faults) = (0, 0, Vec::new());
    for text in &texts {
        for (line, target) in text
            .prose()
            .into_iter()
            .flat_map(|(at, line)| targets(line).into_iter().map(move |t| (at, t)))
        {
            let Some((path, anchor)) = resolved(text, &target) else {
                continue;
            };
            links += 1;
            let place = format!("{}:{line}: {target}", text.name);
            let Some(path) = canonical(&path) else {
                faults.push(format!("{place}: no such file"));
                continue;
            };
            let Some(anchor) = anchor else { continue };
            with_anchor += 1;
            let known = of_path.get(&path).map(|text| anchors(text));
            if !known.is_some_and(|known| known.contains(&anchor)) {
                faults.push(format!("{place}: no such heading"));
            }
        }
    }
    println!("{links} links, {with_anchor} with an anchor");
    assert!(links > 60 && with_anchor > 10, "{links}, {with_anchor}");
    assert!(faults.is_empty(), "dead links:\n{}", faults.join("\n"));
}

#[test]
fn every_page_is_in_the_book_once() {
    let texts = texts();
    let summary = texts.iter().find(|text| text.name == "docs/SUMMARY.md");
    let summary = summary.expect("docs/SUMMARY.md");
    let mut listed: Vec<String> = summary
        .prose()
        .iter()
        .flat_map(|(_, line)| targets(line))
        .map(|target| format!("docs/{target}"))
        .collect();
    listed.sort();
    let pages = texts.iter().map(|text| text.name.clone());
    let pages: Vec<String> = pages
        .filter(|name| name.starts_with("docs/") && name != "docs/SUMMARY.md")
        .collect();
    assert_eq!(listed, pages, "docs/SUMMARY.md against docs/*.md");
}

#[test]
fn pictures_are_small_and_shown() {
    let shown: BTreeSet<PathBuf> = texts()
        .iter()
        .flat_map(|text| {
            let lines = text.prose();
            let all = lines.iter().flat_map(|(_, line)| targets(line));
            let found: Vec<_> = all
                .filter_map(|target| resolved(text, &target))
                .filter_map(|(path, _)| canonical(&path))
                .collect();
            found
        })
        .collect();
    let folder = root().join("docs/pictures");
    let files = std::fs::read_dir(&folder).expect("docs/pictures");
    let mut seen = 0;
    for entry in files {
        let path = entry.expect("an entry").path();
        let name = path.display();
        let bytes = path.metadata().expect("a file").len();
        assert!(
            bytes < 200_000,
            "{name}: {bytes} bytes; 200 000 are the most"
        );
        assert!(
            shown.contains(&canonical(&path).expect("there")),
            "{name} is shown nowhere"
        );
        seen += 1;
    }
    assert!(seen > 10, "{seen} pictures");
}

#[test]
fn the_readme_fits_on_two_screens() {
    let texts = texts();
    let readme = texts.iter().find(|text| text.name == "README.md");
    let lines = readme.expect("README.md").body.lines().count();
    assert!(lines <= 150, "{lines} lines; move details into the book");
}
