//! The texts of the project: README and docs, their fenced blocks and their prose.
#![allow(dead_code)]

use std::fs;
use std::path::{Path, PathBuf};

/// The root of the checkout.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// A file of Markdown.
pub struct Text {
    /// From the root of the checkout.
    pub name: String,
    pub body: String,
}

/// README and every `.md` below `docs`.
pub fn texts() -> Vec<Text> {
    let mut names = vec!["README.md".to_owned()];
    let docs = fs::read_dir(root().join("docs")).expect("docs");
    let docs = docs.map(|entry| entry.expect("an entry").file_name());
    let docs = docs.map(|name| name.to_string_lossy().into_owned());
    names.extend(
        docs.filter(|name| name.ends_with(".md"))
            .map(|name| format!("docs/{name}")),
    );
    names.sort();
    let read = |name: String| {
        let body = fs::read_to_string(root().join(&name)).expect("text");
        Text { name, body }
    };
    let list: Vec<Text> = names.into_iter().map(read).collect();
    assert!(list.len() > 10, "{} texts", list.len());
    list
}

/// A fenced block.
pub struct Block {
    /// What follows the opening fence: `sh`, `sh norun: reason`, `text` ..
    pub info: String,
    /// Line of the opening fence, from 1.
    pub line: usize,
    pub lines: Vec<String>,
}

impl Text {
    /// The fenced blocks, in order.
    pub fn blocks(&self) -> Vec<Block> {
        let mut blocks: Vec<Block> = Vec::new();
        let mut is_open = false;
        for (at, line) in self.body.lines().enumerate() {
            match (line.strip_prefix("```"), is_open) {
                (Some(info), false) => {
                    blocks.push(Block {
                        info: info.trim().to_owned(),
                        line: at + 1,
                        lines: Vec::new(),
                    });
                    is_open = true;
                }
                (Some(_), true) => is_open = false,
                (None, true) => blocks
                    .last_mut()
                    .expect("an open block")
                    .lines
                    .push(line.to_owned()),
                (None, false) => {}
            }
        }
        assert!(!is_open, "{}: a block has no end", self.name);
        blocks
    }

    /// The lines outside of blocks, with their numbers from 1.
    pub fn prose(&self) -> Vec<(usize, &str)> {
        let mut is_open = false;
        let lines = self.body.lines().enumerate();
        let outside = lines.filter(|(_, line)| {
            let is_fence = line.starts_with("```");
            is_open ^= is_fence;
            !is_open && !is_fence
        });
        outside.map(|(at, line)| (at + 1, line)).collect()
    }

    /// The folder that relative links start from.
    pub fn folder(&self) -> PathBuf {
        let file = root().join(&self.name);
        file.parent().map(Path::to_owned).expect("a folder")
    }
}
