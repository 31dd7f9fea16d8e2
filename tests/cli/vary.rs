//! `--vary`: several values of options in one run; each result is that of the single run, merged shards are the whole.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::daylight_year::two_days;

/// A pane before a white wall, on a floor.
const OBJ: &str = "mtllib m.mtl\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nv -9 4 1\nv 9 4 1\nv 9 0 1\nv -9 0 1\nv -9 4 -1\nv 9 4 -1\nv 9 0 -1\nv -9 0 -1\n\
                   usemtl floor\nf 1 2 3 4\nusemtl pane\nf 8 7 6 5\nusemtl wall\nf 12 11 10 9\n";
const MTL: &str = "newmtl floor\nKd 0.2 0.2 0.2\nnewmtl wall\nKd 0.7 0.7 0.7\nnewmtl pane\nKd 0 0 0\nTf 0.88 0.88 0.88\nd 0.2\nillum 6\n";

pub fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect(name);
    write("m.obj", OBJ);
    write("m.mtl", MTL);
    write("grid.csv", "0,1,0\n2,1,5\n");
    write("a.epw", &two_days());
    folder
}

fn run(folder: &Path, words: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
    command.current_dir(folder).args(words.split_whitespace());
    command.output().expect("it starts")
}

pub fn succeed(folder: &Path, words: &str) -> String {
    let output = run(folder, words);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{words}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

fn json(folder: &Path, words: &str) -> serde_json::Value {
    serde_json::from_str(&succeed(folder, &format!("{words} --json"))).expect("JSON")
}

pub const BASE: &str = "daylight m.obj --grid grid.csv --max-paths 2048 --error 0.05 --quiet";
const MOMENT: &str = "--sky hosek --sun 180,40";
const VARIED: &str = "--vary turbidity=2,4 --vary glass=.6,.8";

#[test]
fn every_variant_is_the_single_run() {
    let folder = scratch();
    let folder = folder.path();
    let study = json(folder, &format!("{BASE} {MOMENT} {VARIED}"));
    let variants = study["variants"].as_array().expect("a list");
    assert_eq!(variants.len(), 4);
    let mut number = 0;
    for turbidity in ["2", "4"] {
        for glass in [".6", ".8"] {
            let variant = &variants[number];
            let single = format!("{BASE} {MOMENT} --turbidity {turbidity} --glass {glass}");
            assert_eq!(variant["result"], json(folder, &single), "{single}");
            assert_eq!(
                variant["name"],
                format!("turbidity={turbidity}, glass={glass}")
            );
            assert_eq!(variant["values"]["glass"], glass);
            number += 1;
        }
    }
    let csv = succeed(folder, &format!("{BASE} {MOMENT} {VARIED} --csv"));
    let lines: Vec<&str> = csv.lines().collect();
    assert!(
        lines[0].starts_with("turbidity,glass,x,y,z,"),
        "{}",
        lines[0]
    );
    assert_eq!(lines.len(), 1 + 4 * 2);
    assert!(lines[3].starts_with("2,.8,0,1,0,"), "{}", lines[3]);
    let table = succeed(folder, &format!("{BASE} {MOMENT} {VARIED}"));
    assert!(
        table.contains("total_lux") && table.contains("\n4          .6"),
        "{table}"
    );
}

#[test]
fn a_year_varies_by_blinds_panes_and_surfaces() {
    let folder = scratch();
    let folder = folder.path();
    let year = "--weather a.epw --metrics da,sda,ase,illuminance";
    let varied = "--vary blinds=none,lm83 --vary reflectance.wall=0.1,0.8";
    let study = json(folder, &format!("{BASE} {year} {varied}"));
    let variants = study["variants"].as_array().expect("a list");
    let single = format!("{BASE} {year} --blinds lm83 --reflectance wall=0.1");
    assert_eq!(variants[2]["result"], json(folder, &single));
    let lux = |variant: usize| variants[variant]["result"]["sensors"][0]["mean_lux"].as_f64();
    assert!(lux(1) > lux(0), "a bright wall lights the sensor before it");
    // Of the variants of no effect it is told.
    let line = format!("{BASE} --weather a.epw --metrics illuminance --vary schedule=8-18,9-17");
    let output = run(folder, &line);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("--vary schedule changes no number here"),
        "{said}"
    );
}

#[test]
fn merged_shards_of_variants_are_the_single_run() {
    let folder = scratch();
    let folder = folder.path();
    for (light, form) in [
        (MOMENT, "--csv"),
        ("--weather a.epw", "--json"),
        (MOMENT, ""),
    ] {
        let varied = if light == MOMENT {
            VARIED
        } else {
            "--vary glass=.6,.7,.8,.5"
        };
        let line = format!("{BASE} {light} {varied} {form}");
        let single = succeed(folder, &line);
        for number in 1..=3 {
            succeed(folder, &format!("{line} --shard {number}/3"));
        }
        let parts = "daylight_1-of-3.shard daylight_3-of-3.shard";
        let merged = succeed(folder, &format!("merge {parts} daylight_2-of-3.shard"));
        assert!(merged == single, "{line}: {merged}");
        let missing = run(folder, &format!("merge {parts}"));
        let missing = String::from_utf8_lossy(&missing.stderr).into_owned();
        assert!(missing.contains("run again with --shard 2/3"), "{missing}");
        // Other values are another job.
        let other = line.replace("glass=.6", "glass=.65");
        succeed(folder, &format!("{other} --shard 2/3"));
        let foreign = run(folder, &format!("merge {parts} daylight_2-of-3.shard"));
        let foreign = String::from_utf8_lossy(&foreign.stderr).into_owned();
        assert!(foreign.contains("is of another job"), "{foreign}");
    }
}

#[test]
fn what_cannot_vary_is_one_line() {
    let folder = scratch();
    for (words, part) in [
        ("--vary glass=.6,.95", "lets 0.01 to 0.918"),
        (
            "--vary glass.roof=.6",
            "--glass: no material \"roof\"; the model has floor, pane, wall",
        ),
        ("--vary glass.wall=.6", "\"wall\" is no pane of glass"),
        ("--vary reflectance.pane=.6", "use --glass"),
        ("--vary size=1x1", "it changes no number at a moment"),
        (
            "--weather a.epw --vary turbidity=3",
            "over the year of a weather file",
        ),
        ("--turbidity 3 --vary turbidity=3,4", "given and varied"),
    ] {
        let output = run(folder.path(), &format!("{BASE} {words}"));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words}: {said}");
        assert!(
            said.contains(part) && said.lines().count() == 1,
            "{words}: {said}"
        );
    }
}
