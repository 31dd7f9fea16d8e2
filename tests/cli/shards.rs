//! Sensors that several machines measure: merged, the result is that of a single run, byte for byte; what is missing is named. The same by
//! the job files of `scripts/jobs`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub const PROGRAM: &str = env!("CARGO_BIN_EXE_skylight");

pub fn jobs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/jobs")
}

fn run(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).args(words);
    command.output().expect("it starts")
}

pub fn succeed(folder: &Path, line: &str) -> Vec<u8> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let output = run(folder, &words);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{line}: {errors}");
    output.stdout
}

fn fail(folder: &Path, line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let output = run(folder, &words);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success(), "{line}");
    assert_eq!(text.lines().count(), 1, "{line}: {text}");
    text
}

/// The head of a weather file of one day in June.
const WEATHER: &str =
    "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 6/20, 6/20\n";

/// A folder with a grid of so many sensors, near and far from the columns, and some weather.
pub fn scratch(sensors: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let line = |at: usize| format!("{},1,{}\n", at % 40, at / 40);
    let grid: String = (0..sensors).map(line).collect();
    fs::write(folder.path().join("grid.csv"), grid).expect("written");
    let hours = (0..24).map(|at| {
        let diffuse = if (9..15).contains(&at) { 150 } else { 0 };
        let direct = if at % 2 == 0 { 3 * diffuse } else { 0 };
        format!(
            "2001,6,20,{},0,?,15,9,70,101300,0,0,300,9999,{direct},{diffuse},0,0,0,0,0,0,0,0,20\n",
            at + 1
        )
    });
    let text = WEATHER.to_owned() + &hours.collect::<String>();
    fs::write(folder.path().join("a.epw"), text).expect("written");
    folder
}

/// Runs all shards of a job.
fn shards(folder: &Path, line: &str, of: usize) -> Vec<String> {
    let one = |number: usize| {
        succeed(folder, &format!("{line} --shard {number}/{of}"));
        format!("daylight_{number}-of-{of}.shard")
    };
    (1..=of).map(one).collect()
}

pub const MOMENT: &str = "daylight colonnade --grid grid.csv --sky hosek --max-paths 2048 --error 0.05 --no-warnings --quiet";

#[test]
fn twelve_merged_shards_are_the_single_run() {
    let folder = scratch(31);
    let folder = folder.path();
    for form in ["", "--json", "--csv"] {
        let line = format!("{MOMENT} {form}");
        let single = succeed(folder, &line);
        let mut parts = shards(folder, &line, 12);
        parts.reverse();
        let merged = succeed(folder, &format!("merge {}", parts.join(" ")));
        assert!(merged == single, "{form} differs");
        succeed(folder, &format!("merge {} -o merged", parts.join(" ")));
        assert!(
            fs::read(folder.join("merged")).expect("a file") == single,
            "{form} differs"
        );
    }
}

#[test]
fn blocks_of_a_year_are_those_of_the_single_run() {
    // A block and a bit: one of three shards is empty.
    let folder = scratch(256 + 5);
    let folder = folder.path();
    let line = "daylight colonnade --grid grid.csv --weather a.epw --metrics da,udi,sda,ase,en17037,illuminance,sunhours --dates 6-20 --error 9 --max-paths 1024 --bounces 0 --no-warnings --quiet --json";
    let single = succeed(folder, line);
    let parts = shards(folder, line, 3);
    let merged = succeed(folder, &format!("merge {}", parts.join(" ")));
    assert!(merged == single);
    let result: serde_json::Value = serde_json::from_slice(&single).expect("JSON");
    let sensors = result["sensors"].as_array().expect("sensors");
    assert_eq!(sensors.len(), 261);
    assert!(
        sensors
            .iter()
            .all(|s| s["da300"].is_number() && s["mean_lux"].is_number())
    );
    assert!(result["en17037"]["method_1"].is_object() && result["sda"].is_object());
}

#[test]
fn matrices_of_shards_are_that_of_the_single_run() {
    // Two blocks: the third shard has no sensors.
    let folder = scratch(256 + 5);
    let folder = folder.path();
    let line = "daylight colonnade --grid grid.csv --weather a.epw --metrics illuminance --error 9 --max-paths 1024 --bounces 0 --no-warnings --quiet --csv --ill year.ill";
    let single = succeed(folder, line);
    let matrix = fs::read(folder.join("year.ill")).expect("a matrix");
    let parts = shards(folder, line, 3).join(" ");
    let merge = format!("merge {parts} --ill merged.ill");
    assert!(succeed(folder, &merge) == single);
    assert!(fs::read(folder.join("merged.ill")).expect("a matrix") == matrix);
    let own = folder.join("year_2-of-3.ill");
    let text = fs::read_to_string(&own).expect("a matrix");
    fs::write(&own, text.replacen("6 20 ", "6 21 ", 1)).expect("changed");
    let error = fail(folder, &merge);
    assert!(
        error.contains("year_2-of-3.ill is damaged: run again with --shard 2/3"),
        "{error}"
    );
    fs::remove_file(&own).expect("removed");
    assert!(fail(folder, &merge).contains("year_2-of-3.ill is missing"));
    succeed(folder, &format!("{line} --shard 2/3"));
    assert!(succeed(folder, &merge) == single);
    fs::write(folder.join("grid.csv"), "0,1,0\n").expect("a grid");
    let merge = "merge daylight_1-of-1.shard --ill merged.ill";
    shards(folder, &line.replace(" --ill year.ill", ""), 1);
    assert!(fail(folder, merge).contains("measured without --ill"));
    shards(folder, MOMENT, 1);
    assert!(fail(folder, merge).contains("only the shards of a year"));
}

#[test]
fn a_killed_shard_loses_only_itself() {
    let folder = scratch(5);
    let folder = folder.path();
    let single = succeed(folder, MOMENT);
    let parts = shards(folder, MOMENT, 3);
    let merge = format!("merge {}", parts.join(" "));
    let text = fs::read(folder.join(&parts[1])).expect("a part");
    fs::write(folder.join(&parts[1]), &text[..text.len() - 40]).expect("cut");
    let error = fail(folder, &merge);
    assert!(
        error.contains("daylight_2-of-3.shard is damaged")
            && error.contains("run again with --shard 2/3"),
        "{error}"
    );
    // Another seed, and another grid: other jobs.
    succeed(folder, &format!("{MOMENT} --seed 7 --shard 2/3"));
    assert!(fail(folder, &merge).contains("is of another job"));
    let grid = fs::read_to_string(folder.join("grid.csv")).expect("a grid");
    fs::write(folder.join("grid.csv"), grid.replace("2,1,0", "2,1,0.5")).expect("moved");
    succeed(folder, &format!("{MOMENT} --shard 2/3"));
    assert!(fail(folder, &merge).contains("is of another job"));
    fs::write(folder.join("grid.csv"), grid).expect("as it was");
    succeed(folder, &format!("{MOMENT} --shard 2/3"));
    assert!(succeed(folder, &merge) == single);
    let doubled = fail(folder, &format!("{merge} {}", parts[0]));
    assert!(doubled.contains("shard 1/3 is there twice"), "{doubled}");
    assert!(fail(folder, &format!("{MOMENT} --shard 4/3")).contains("for instance 1/12"));
}

#[cfg(unix)]
#[test]
fn the_slurm_script_runs_one_shard_in_each_task() {
    let folder = scratch(7);
    let folder = folder.path();
    let single = succeed(folder, MOMENT);
    let script = jobs().join("skylight.sbatch");
    let bash = |words: &[&str], task: Option<&str>| {
        let mut command = Command::new("bash");
        command.current_dir(folder).env("SKYLIGHT", PROGRAM);
        command.env_remove("SLURM_ARRAY_TASK_ID").args(words);
        task.map(|task| command.env("SLURM_ARRAY_TASK_ID", task));
        command.output().expect("bash")
    };
    let path = script.to_string_lossy().into_owned();
    assert!(bash(&["-n", &path], None).status.success());
    let mut words = vec![path.as_str(), "4"];
    words.extend(MOMENT.split_whitespace());
    assert!(!bash(&words, None).status.success(), "outside of an array");
    for task in ["1", "2", "3", "4"] {
        let output = bash(&words, Some(task));
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    let parts: Vec<String> = (1..=4)
        .map(|n| format!("daylight_{n}-of-4.shard"))
        .collect();
    assert!(succeed(folder, &format!("merge {}", parts.join(" "))) == single);
}

/// Runs the job of Open Job Description with the engine of its specification, `openjd` (PyPI, openjd-cli).
#[cfg(unix)]
#[test]
fn the_open_job_description_makes_the_single_run() {
    let openjd = std::env::var("SKYLIGHT_OPENJD").unwrap_or_else(|_| "openjd".to_owned());
    if Command::new(&openjd).arg("--version").output().is_err() {
        println!("skipped: no openjd here; pip install openjd-cli, or its path in SKYLIGHT_OPENJD");
        return;
    }
    let folder = scratch(9);
    let folder = folder.path();
    let single = succeed(folder, &format!("{MOMENT} --json"));
    let job = jobs().join("openjd.yaml");
    let output = Command::new(&openjd)
        .args([
            "run",
            &job.to_string_lossy(),
            "--step",
            "Merge",
            "--run-dependencies",
        ])
        .args([
            "-p",
            &format!("Folder={}", folder.display()),
            "-p",
            "Shards=3",
        ])
        .args([
            "-p",
            &format!("Command={MOMENT} --json"),
            "-p",
            &format!("Skylight={PROGRAM}"),
        ])
        .args(["-p", "Result=out.json"])
        .output()
        .expect("openjd");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let merged = fs::read(folder.join("out.json"));
    assert!(merged.expect("a result") == single, "{said}");
}
