//! The commands of README and docs: each is read by the command line's parser, and run at a small size unless its block says why not.
//!
//! A block `sh` is run line by line in a scratch folder that has the files of `docs/files` and short weather files, one folder for each
//! text, so that later blocks may use what earlier ones made. A block `sh norun: reason` is not run. A block `toml` is drawn as a scene file, or read as a
//! file of defaults.

#[allow(dead_code)]
#[path = "../../examples/make_reference.rs"]
mod reference;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use skylight::cli::{self, CliExit};

use crate::daylight_year::two_days;
use crate::texts::{Block, Text, root, texts};

/// What makes runs small: command, option, how its value is changed. Given values are replaced, missing ones are added.
const SMALL: [(&str, &str, Small); 15] = [
    ("render", "size", Small::To("64x36")),
    ("render", "samples", Small::AtMost(2)),
    ("sequence", "size", Small::To("64x36")),
    ("sequence", "samples", Small::AtMost(2)),
    ("sequence", "step", Small::Step),
    ("study", "size", Small::To("64x36")),
    ("study", "samples", Small::To("2")),
    ("bench", "size", Small::To("64x36")),
    ("bench", "frames", Small::To("2")),
    ("bake", "size", Small::To("32")),
    ("daylight", "error", Small::To("0.5")),
    ("daylight", "max-paths", Small::To("1024")),
    ("daylight", "plane", Small::WithSpacing),
    ("daylight", "facade", Small::WithSpacing),
    ("sky", "irradiance-samples", Small::AtMost(64)),
];

#[derive(Clone, Copy)]
enum Small {
    /// This value, given or not.
    To(&'static str),
    /// A given number is lowered to this one.
    AtMost(u32),
    /// Steps of minutes become nine hours, those of days half a year.
    Step,
    /// Two metres between the sensors.
    WithSpacing,
}

/// Defaults of who runs the commands, which they may override: the quickest light.
const QUICK: &str = "bounces = 0\nambient = \"ssao\"\nirradiance-samples = 16\nshadow-size = 512\n";

/// The words of shell for one program of a pipe.
type Words = Vec<String>;

/// A line's programs: what stands between pipes, as written.
fn programs(line: &str) -> Vec<&str> {
    line.split(" | ").collect()
}

/// The part of a program's text that is no redirection.
fn words(program: &str) -> Words {
    let before = program.split(" > ").next().unwrap_or_default();
    shlex::split(before).unwrap_or_else(|| panic!("{program}: quotes"))
}

/// Lines of a block as a shell reads them: joined where they end in a backslash, without comments and empty ones.
fn lines(block: &Block) -> Vec<String> {
    let joined = block.lines.join("\n").replace("\\\n", " ");
    let lines = joined.lines().map(str::trim);
    lines
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .map(|line| line.split(" # ").next().unwrap_or(line).trim().to_owned())
        .collect()
}

/// The programs `skylight` of a line, without their redirections.
fn skylights(line: &str) -> Vec<Words> {
    let all = programs(line).into_iter().map(words);
    all.filter(|words| words.first().is_some_and(|word| word == "skylight"))
        .collect()
}

/// The line with what makes it small, and without programs of a pipe that are not installed.
fn small(line: &str) -> String {
    let there = |program: &&str| {
        let name = words(program).into_iter().next().unwrap_or_default();
        name == "skylight"
            || name.contains('=')
            || name.starts_with("scripts/")
            || is_installed(&name)
    };
    let parts = programs(line).into_iter().filter(there).map(smaller);
    parts.collect::<Vec<_>>().join(" | ")
}

fn is_installed(program: &str) -> bool {
    let found = Command::new("sh")
        .args(["-c", &format!("command -v {program}")])
        .stdout(Stdio::null())
        .status();
    found.is_ok_and(|status| status.success())
}

fn smaller(program: &str) -> String {
    let Some(rest) = program.trim().strip_prefix("skylight ") else {
        return program.to_owned();
    };
    let (command, rest) = rest.split_once(' ').unwrap_or((rest, ""));
    let mut rest = format!(" {rest}");
    let mut added = String::new();
    for (_, option, how) in SMALL.iter().filter(|(of, _, _)| *of == command) {
        let given = value(&rest, option);
        let mut set = |new: String| match &given {
            Some(old) => {
                for joint in [' ', '='] {
                    let [old, new] = [old, &new].map(|v| format!(" --{option}{joint}{v}"));
                    rest = rest.replace(&old, &new);
                }
            }
            None => added += &format!(" --{option} {new}"),
        };
        match (how, &given) {
            (Small::To(new), _) => set((*new).to_owned()),
            (Small::AtMost(most), Some(old)) => {
                let old: u32 = old.parse().expect("a number");
                set(old.min(*most).to_string());
            }
            (Small::Step, Some(old)) => {
                let unit = if old.ends_with('d') { "180d" } else { "9h" };
                set(unit.to_owned());
            }
            (Small::WithSpacing, _) if rest.contains(&format!(" --{option}")) => {
                added += if rest.contains(" --spacing") {
                    ""
                } else {
                    " --spacing 2"
                };
            }
            _ => {}
        }
    }
    format!("skylight {command}{added}{rest}")
}

/// Value of an option in the text of a program.
fn value(text: &str, option: &str) -> Option<String> {
    let at = [' ', '='].map(|joint| text.split_once(&format!(" --{option}{joint}")));
    let (_, rest) = at.into_iter().flatten().next()?;
    Some(rest.split(' ').next().unwrap_or_default().to_owned())
}

/// A folder with the files that the texts' commands name.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let files = fs::read_dir(root().join("docs/files")).expect("docs/files");
    for file in files {
        let file = file.expect("an entry");
        fs::copy(file.path(), folder.path().join(file.file_name())).expect("copied");
    }
    // A file of the name of bundled weather goes before it: two days for a year.
    fs::write(folder.path().join("chicago"), two_days()).expect("written");
    fs::write(folder.path().join("quick.toml"), QUICK).expect("written");
    let program = Path::new(env!("CARGO_BIN_EXE_skylight"));
    fs::create_dir(folder.path().join("bin")).expect("a folder");
    std::os::unix::fs::symlink(program, folder.path().join("bin/skylight")).expect("a link");
    folder
}

fn run(line: &str, folder: &Path) -> Output {
    let others = std::env::var("PATH").unwrap_or_default();
    Command::new("bash")
        .args(["-c", &format!("set -o pipefail; {line}")])
        .current_dir(folder)
        .env("PATH", format!("{}/bin:{others}", folder.display()))
        .env("SKYLIGHT_CONFIG", "quick.toml")
        .stdin(Stdio::null())
        .output()
        .expect("a shell")
}

/// What came of the blocks of a text.
#[derive(Default)]
struct Count {
    run: usize,
    not_run: Vec<String>,
    without: usize,
    faults: Vec<String>,
}

fn run_text(text: &Text, count: &mut Count) {
    let folder = folder();
    for block in text.blocks() {
        let place = format!("{}:{}", text.name, block.line);
        if let Some(reason) = block.info.strip_prefix("sh norun: ") {
            count.not_run.push(format!("{place}: {reason}"));
        }
        if block.info == "toml" {
            fs::write(folder.path().join("block.toml"), block.lines.join("\n")).expect("written");
        }
        let lines = match block.info.as_str() {
            "sh" => lines(&block),
            "toml" if block.lines.iter().any(|line| line == "[[mesh]]") => {
                vec!["skylight render block.toml -o block.png".to_owned()]
            }
            "toml" => vec!["SKYLIGHT_CONFIG=block.toml skylight --print-config".to_owned()],
            _ => continue,
        };
        for line in lines {
            if line.contains(".mp4") && !is_installed("ffmpeg") {
                count.without += 1;
                continue;
            }
            let line = small(&line);
            let output = run(&line, folder.path());
            count.run += 1;
            if !output.status.success() {
                let said = String::from_utf8_lossy(&output.stderr);
                count.faults.push(format!("{place}: {line}\n  {said}"));
            }
        }
    }
}

#[test]
fn commands_of_the_texts_end_well() {
    let mut count = Count::default();
    for text in texts() {
        run_text(&text, &mut count);
    }
    let Count {
        run,
        not_run,
        without,
        faults,
    } = count;
    println!("{run} commands run, {without} skipped without ffmpeg; blocks that are not run:");
    println!("{}", not_run.join("\n"));
    assert!(run > 30, "{run} commands");
    assert!(
        faults.is_empty(),
        "commands that fail:\n{}",
        faults.join("\n")
    );
}

/// Words of `skylight` that the parser refuses.
fn refused(words: &Words) -> Option<String> {
    match cli::parse(words.iter().map(Into::into)) {
        Ok(_) | Err(CliExit::Help(_)) => None,
        Err(CliExit::Usage(what)) => Some(what),
    }
}

#[test]
fn commands_of_the_texts_are_understood_as_written() {
    let (mut seen, mut faults) = (0, Vec::new());
    for text in texts() {
        let blocks = text
            .blocks()
            .into_iter()
            .filter(|block| block.info.starts_with("sh"));
        let of_blocks = blocks.flat_map(|block| {
            let lines = lines(&block).into_iter();
            lines
                .map(move |line| (block.line, line))
                .collect::<Vec<_>>()
        });
        // Code within prose, unless something is left out of it.
        let prose = text.prose().into_iter().flat_map(|(at, line)| {
            let code = line.split('`').skip(1).step_by(2);
            let code = code.filter(|code| code.starts_with("skylight ") && !is_pattern(code));
            code.map(|code| (at, code.to_owned())).collect::<Vec<_>>()
        });
        for (at, line) in of_blocks.chain(prose) {
            for words in skylights(&line) {
                seen += 1;
                let fault = refused(&words);
                faults.extend(fault.map(|what| format!("{}:{at}: {line}: {what}", text.name)));
            }
        }
    }
    println!("{seen} commands");
    assert!(seen > 60, "{seen} commands");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Whether code stands for a kind of command, and not for one: something in capitals or brackets, dots, or no more than a name.
fn is_pattern(code: &str) -> bool {
    let is_name = |word: &str| {
        let letters = || word.chars().filter(|c| c.is_alphabetic());
        letters().count() > 0 && letters().all(char::is_uppercase)
    };
    let mut words = code.split_whitespace().skip(2);
    code.contains("..")
        || code.contains('[')
        || code.contains('|')
        || words.any(is_name)
        || is_bare(code)
}

fn is_bare(code: &str) -> bool {
    code.split_whitespace().count() < 3
}

#[test]
fn every_block_says_what_it_is() {
    const KINDS: [&str; 6] = ["sh", "text", "toml", "json", "rust", "glsl"];
    let mut faults = Vec::new();
    for text in texts() {
        for block in text.blocks() {
            let is_known = KINDS.contains(&block.info.as_str());
            let reason = block.info.strip_prefix("sh norun: ");
            if !is_known && reason.is_none_or(str::is_empty) {
                faults.push(format!("{}:{}: ```{}", text.name, block.line, block.info));
            }
        }
    }
    assert!(
        faults.is_empty(),
        "blocks are {} or 'sh norun: reason':\n{}",
        KINDS.join(", "),
        faults.join("\n")
    );
}

#[test]
fn the_command_reference_is_that_of_the_program() {
    let written = fs::read_to_string(root().join("docs/commands.md")).expect("the page");
    assert!(
        written == reference::reference(),
        "docs/commands.md is old; run: cargo run --example make_reference"
    );
}

#[test]
fn runs_are_made_small() {
    for (line, expected) in [
        (
            "skylight render house.obj --size 1920x1080 --samples 64 -o a.png",
            "skylight render house.obj --size 64x36 --samples 2 -o a.png",
        ),
        (
            "skylight render -o - | no-such-program -",
            "skylight render --size 64x36 -o -",
        ),
        (
            "skylight bake --map sky -o sky.exr",
            "skylight bake --size 32 --map sky -o sky.exr",
        ),
    ] {
        assert_eq!(small(line), expected);
    }
    let year = small("skylight daylight a.obj --plane 0.8");
    assert!(
        year.contains("--spacing 2") && year.contains("--error 0.5"),
        "{year}"
    );
}
