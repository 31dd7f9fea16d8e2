//! Every option of the definition survives a round trip through a file, a command line and metadata.

use std::ffi::OsString;
use std::path::Path;

use clap::Arg;

use super::*;
use crate::cli::{self, parse};
use crate::daylight::sampling::rnd;
use crate::scene::{Bounds, Camera, Loaded, Material, NamedOptions, Scene};

/// Texts of which each parser accepts at least one. The first is also the name of a camera and of a moment of [`scene`].
const TEXTS: [&str; 20] = [
    "7",
    "-7.25",
    "0.5",
    "64",
    "30",
    "100",
    "16384",
    "0.012345678901234567",
    "45.5,-12.25",
    "172,15.5",
    "1,2.5,-3",
    "-0.1,0.3333333,7e-9",
    "100,1000",
    "0.9,0.7,2.5,1",
    "640x360",
    "2026-02-01T12:00:00+00:00",
    "1999-12-31T23:59:59.25-05:45",
    "-a 'quoted' $name",
    "2-3,year",
    "a pane=0.25",
];

fn pairs(list: &[(&str, &str)]) -> Vec<(String, String)> {
    OptionValues::from(list).into_pairs()
}

/// A scene file with these tables, a camera and a moment.
pub(crate) fn scene(tables: &[(&str, &[(&str, &str)])]) -> Loaded {
    let named = |name: &str, options: &[(&str, &str)]| NamedOptions {
        name: name.into(),
        options: pairs(options),
    };
    Loaded {
        path: "s.toml".into(),
        scene: Scene {
            materials: vec![Material {
                name: "a pane".into(),
                glass: Some([0.5; 3]),
                ..Material::default()
            }],
            ..Scene::default()
        },
        options: tables.iter().map(|(name, o)| named(name, o)).collect(),
        cameras: vec![named("7", &[("eye", "-1,1,1"), ("fov", "33")])],
        moments: vec![named(
            "7",
            &[("sun", "290,3"), ("turbidity", "4"), ("ev100", "9")],
        )],
    }
}

/// Every option with all the texts that its parser accepts.
fn all_texts() -> Vec<(String, Vec<String>)> {
    let texts = |arg: &Arg| -> Vec<String> {
        let name = arg.get_long().expect("a name");
        if ["camera", "moment"].contains(&name) {
            return vec![TEXTS[0].to_owned()];
        }
        let named = arg.get_possible_values();
        let named = named.iter().map(|value| value.get_name());
        let all = named.chain(TEXTS);
        let takes = |text: &&str| {
            OptionValues::from([(name, *text)].as_slice())
                .check()
                .is_ok()
        };
        all.filter(takes).map(str::to_owned).collect()
    };
    let args = DEFINITION.get_arguments();
    let args = args.map(|arg| (arg.get_long().expect("a name").to_owned(), texts(arg)));
    args.collect()
}

/// For every option: its name, and options in which it differs from what the scene and the defaults give.
pub(crate) fn each_set(scene: &Loaded) -> Vec<(String, Options)> {
    let nothing = Options::resolve(&OptionValues::default(), scene).expect("defaults");
    let mut all = Vec::new();
    for (name, texts) in all_texts() {
        let before = all.len();
        for text in texts {
            let mut user = OptionValues::default();
            if name == "reflections" {
                user.set("visibility", "dome");
            }
            if name == "aerial" {
                user.set("sky", "atmosphere");
            }
            user.set(&name, &text);
            let options = Options::resolve(&user, scene);
            if let Ok(options) = options
                && options != nothing
            {
                all.push((name.clone(), options));
            }
        }
        assert!(
            all.len() > before,
            "{name}: add a text that it takes to TEXTS"
        );
    }
    all
}

/// A scene with a fixed exposure, so that `--exposure auto` is not the default.
pub(crate) fn exposed_scene() -> Loaded {
    scene(&[("exposure", &[("ev100", "11")])])
}

/// The scene and the options that the program reads from `line`, split as a shell does.
fn read(line: &str, loaded: &Loaded) -> (Option<String>, Options) {
    let words = shlex::split(line).expect("quoted as a shell does");
    match parse(words.iter().map(OsString::from)) {
        Ok(cli::Command::Render { scene, options, .. }) => (
            scene.map(|path| path.display().to_string()),
            Options::resolve(&options.first, loaded).expect(line),
        ),
        other => panic!("{line}: {other:?}"),
    }
}

#[test]
fn every_option_comes_back_from_values_and_from_the_command_line() {
    let scene = exposed_scene();
    let all = each_set(&scene);
    println!("{} options, {} values", all_texts().len(), all.len());
    assert!(all_texts().len() > 50);
    for (name, options) in all {
        let again = Options::resolve(&options.values(), &scene).expect(&name);
        assert_eq!(again, options, "{name}");
        let line = options.command_line(None, &scene).expect(&name);
        assert_eq!(read(&line, &scene).1, options, "{name}: {line}");
    }
}

#[test]
fn every_default_is_read_back_as_itself() {
    let nothing = Options::resolve(&OptionValues::default(), &scene(&[])).expect("defaults");
    let again = Options::resolve(&nothing.values(), &scene(&[]));
    assert_eq!(again.expect("the same"), nothing);
    let exposure = scene(&[("exposure", &[("exposure", "auto")])]);
    let resolved = Options::resolve(&OptionValues::default(), &exposure);
    assert_eq!(resolved.expect("defaults"), nothing);
}

struct Random(u32);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        (rnd(&mut self.0) * count as f64) as usize
    }

    /// A random subset of the options, each with one of its texts.
    fn options(&mut self, all: &[(String, Vec<String>)]) -> OptionValues {
        let mut values = OptionValues::default();
        for (name, texts) in all {
            if self.below(5) < 2 {
                values.set(name, &texts[self.below(texts.len())]);
            }
        }
        values
    }
}

#[test]
fn a_line_gives_the_options_it_was_made_of() {
    let scenes = [
        scene(&[]),
        scene(&[
            ("place", &[("place", "10,-20")]),
            ("sky", &[("turbidity", "7")]),
            ("exposure", &[("ev100", "14")]),
        ]),
        scene(&[
            ("sun", &[("sun", "90,5")]),
            ("exposure", &[("scale", "0.5")]),
            ("camera", &[("eye", "1,2,3")]),
        ]),
    ];
    let (all, mut random) = (all_texts(), Random(1));
    let (mut equal, mut lost) = (0, 0);
    for round in 0..6000 {
        let user = random.options(&all);
        // The options are resolved from the shown scene or from the first one.
        let shown = &scenes[round % scenes.len()];
        let origin = &scenes[(round % scenes.len()) * random.below(2)];
        let Ok(options) = Options::resolve(&user, origin) else {
            continue;
        };
        match options.command_line(Some(Path::new("my house.toml")), shown) {
            Ok(line) => {
                let (scene, again) = read(&line, shown);
                assert_eq!(scene.as_deref(), Some("my house.toml"));
                assert_eq!(again, options, "{line}");
                equal += 1;
            }
            Err(error) => {
                // Only the eye of the third scene cannot be unset.
                let text = error.to_string();
                assert!(text.starts_with("the scene sets eye"), "{text}");
                lost += 1;
            }
        }
    }
    println!(
        "{equal} lines gave their options again; {lost} had a value that cannot be taken back"
    );
    assert!(equal > 500, "{equal}");
}

#[test]
fn only_what_differs_is_written() {
    let scene = scene(&[("sky", &[("turbidity", "7")])]);
    let line = |user: &[(&str, &str)]| {
        let options = Options::resolve(&user.into(), &scene).expect("good");
        options.command_line(None, &scene).expect("a line")
    };
    assert_eq!(
        line(&[
            ("place", "10,20"),
            ("when", "2026-01-01T12:00Z"),
            ("sky", "hosek")
        ]),
        "skylight render --place 10,20 --when 2026-01-01T12:00:00+00:00 --sky hosek --fov 45"
    );
    // The scene sets 7, so 7 is omitted; the default 3 must be written.
    assert_eq!(
        line(&[("sun", "90,-5"), ("turbidity", "7")]),
        "skylight render --sun 90,-5 --fov 45"
    );
    assert_eq!(
        line(&[("sun", "90,5"), ("turbidity", "3")]),
        "skylight render --sun 90,5 --turbidity 3 --fov 45"
    );
    assert_eq!(
        line(&[("preset", "lecture"), ("ev100", "14"), ("turbidity", "7")]),
        "skylight render --place 45,0 --solar 200,10 --preset lecture --fov 55 --ev100 14"
    );
}

#[test]
fn a_camera_keeps_its_bits_and_few_digits() {
    let scene = scene(&[]);
    let camera = Camera {
        eye: glam::Vec3::new(0.1, 1.0 / 3.0, -2e-7),
        target: glam::Vec3::new(-1234.567, 0.0, 5.0),
        fov_deg: 45.3,
        near: 0.01,
    };
    let bare = Options::resolve(&OptionValues::default(), &scene).expect("good");
    let line = bare
        .with_camera(&camera, glam::DVec3::ZERO)
        .command_line(None, &scene);
    let line = line.expect("a line");
    assert!(line.contains("--eye 0.1,0.33333334,-0.0000002"), "{line}");
    let seen = read(&line, &scene)
        .1
        .camera(&Bounds::EMPTY.into(), glam::DVec3::ZERO);
    assert_eq!(
        (seen.eye, seen.target, seen.fov_deg),
        (camera.eye, camera.target, camera.fov_deg)
    );
}

#[test]
fn a_camera_keeps_the_coordinates_of_the_file() {
    let scene = scene(&[]);
    let user = OptionValues::from(
        &[
            ("eye", "500001.25,2,-6100003.1"),
            ("target", "500000,1.5,-6100000"),
        ][..],
    );
    let options = Options::resolve(&user, &scene).expect("good");
    let origin = glam::DVec3::new(5e5, 0.0, -6.1e6);
    let camera = options.camera(&Bounds::EMPTY.into(), origin);
    assert_eq!(camera.eye, glam::Vec3::new(1.25, 2.0, -3.1));
    let again = options.with_camera(&camera, origin);
    assert_eq!((again.eye, again.target), (options.eye, options.target));
}

#[test]
fn odd_paths_come_through() {
    let plain = scene(&[]);
    let options = Options::resolve(&OptionValues::default(), &plain).expect("good");
    for (path, read_path) in [
        ("it's a \"house\".toml", "it's a \"house\".toml"),
        ("-o.obj", "./-o.obj"),
        ("$(reboot) `x`;&|\n*.obj", "$(reboot) `x`;&|\n*.obj"),
        ("høj/сад.obj", "høj/сад.obj"),
    ] {
        let line = options.command_line(Some(Path::new(path)), &plain);
        let line = line.expect("a line");
        assert_eq!(read(&line, &plain).0.as_deref(), Some(read_path), "{line}");
    }
    let lost = scene(&[("exposure", &[("gamma", "2")])]);
    let error = options.command_line(None, &lost).expect_err("gamma");
    let error = error.to_string();
    assert!(
        error.contains("gamma") && error.lines().count() == 1,
        "{error}"
    );
}
