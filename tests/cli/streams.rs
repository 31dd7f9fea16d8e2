//! Standard output in place of a file, standard streams, exit codes, files that are the same each time.

use std::process::{Command, Output};

use crate::town;

const RENDER: &str =
    "render town.obj --size 96x48 --sky preetham --bounces 0 --ambient ssao --no-cache";

fn run(folder: &tempfile::TempDir, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder.path())
        .env_remove("CLICOLOR_FORCE")
        .args(line.split_whitespace())
        .output()
        .expect("the program starts")
}

fn place() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    town::write(folder.path());
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A picture on standard output has the bytes of the file, whole or in tiles; nothing else is there, and no file is left.
#[test]
fn a_picture_on_standard_output_is_the_file() {
    let folder = place();
    for (name, file, more) in [
        ("-", "a.png", ""),
        ("exr:-", "a.exr", ""),
        ("-", "b.png", "--tile 64"),
        ("exr:-", "b.exr", "--tile 64"),
    ] {
        let written = run(&folder, &format!("{RENDER} {more} -o {file}"));
        assert!(written.status.success(), "{}", text(&written.stderr));
        assert!(text(&written.stdout).starts_with(&format!("{file}: 96x48")));
        let piped = run(&folder, &format!("{RENDER} {more} -o {name}"));
        assert!(piped.status.success(), "{}", text(&piped.stderr));
        let expected = std::fs::read(folder.path().join(file)).expect("a file");
        assert!(piped.stdout == expected, "{name} {more}: other bytes");
        let told = text(&piped.stderr);
        assert!(told.contains(&format!("{name}: 96x48")), "{told}");
        assert!(!folder.path().join(name).exists());
    }
}

#[test]
fn tables_on_standard_output_are_alone_there() {
    let folder = place();
    let bench = "bench town.obj --size 32x32 --frames 1 --sky preetham --bounces 0 --ambient ssao --no-cache";
    let json = run(&folder, &format!("{bench} --json -"));
    let value: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON alone");
    assert!(value.is_object(), "{value}");
    assert!(text(&json.stderr).contains("sum of the passes"));
    let csv = text(&run(&folder, &format!("{bench} --csv -")).stdout);
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(
        columns.len() > 5 && columns.iter().all(|c| *c >= columns[0]),
        "{csv}"
    );
    assert!(!folder.path().join("-").exists());
}

/// Colours are for terminals, and for those who force them; NO_COLOR is stronger.
#[test]
fn no_text_has_escape_sequences() {
    let folder = place();
    let with = |line: &str, variables: &[(&str, &str)]| {
        let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
            .current_dir(folder.path())
            .env_remove("NO_COLOR")
            .env_remove("CLICOLOR_FORCE")
            .envs(variables.iter().copied())
            .args(line.split_whitespace())
            .output()
            .expect("the program starts");
        [output.stdout, output.stderr].concat()
    };
    let forced = [("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")];
    for line in [
        "--help",
        "render --help",
        "sky --sky preetham --place copenhagen --when 2026-06-21T12:00",
        "render none.obj",
        "paint",
    ] {
        for variables in [&[][..], &forced] {
            let said = with(line, variables);
            let shown = String::from_utf8_lossy(&said);
            assert!(
                !said.is_empty() && !said.contains(&0x1b),
                "{line}: {shown:?}"
            );
        }
    }
    assert!(with("render none.obj", &forced[..1]).contains(&0x1b));
}

#[test]
fn exit_codes_are_those_of_the_help() {
    let folder = place();
    let help = text(&run(&folder, "--help").stdout);
    assert!(help.contains("0 done, 1 failed, 2 wrong usage"), "{help}");
    for (line, code) in [
        ("sky --sky preetham --sun 180,40", 0),
        ("render none.obj -o -", 1),
        ("validate --device nothing-of-this-name", 1),
        ("render -o picture.jpg", 2),
        ("render --layers -o -", 2),
        ("validate --size 3x3", 2),
    ] {
        let output = run(&folder, line);
        assert_eq!(output.status.code(), Some(code), "{line}");
        assert_eq!(output.stdout.is_empty(), code != 0, "{line}");
    }
}

/// Files hold no date and no order by chance.
#[test]
fn the_same_command_writes_the_same_bytes() {
    let folder = place();
    for line in [
        format!("{RENDER} -o NAME.png"),
        format!("{RENDER} --layers -o NAME.exr"),
        format!("{RENDER} --false-colour illuminance -o NAME.png"),
        "bake --map sky --sky preetham --sun 180,40 --size 16 -o NAME.ktx2".to_owned(),
    ] {
        let [first, second] = ["first", "second"].map(|name| {
            let output = run(&folder, &line.replace("NAME", name));
            assert!(output.status.success(), "{}", text(&output.stderr));
            let end = line.rsplit('.').next().expect("an extension");
            let bytes = std::fs::read(folder.path().join(format!("{name}.{end}")));
            bytes.expect("a file")
        });
        assert!(first == second, "{line}");
    }
}
