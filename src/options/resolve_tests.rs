use super::*;
use crate::options::{SunInput, ToneCurve};
use crate::scene::{NamedCamera, Scene};

fn pairs(list: &[(&str, &str)]) -> Vec<(String, String)> {
    OptionValues::from(list).into_pairs()
}

/// A scene file that sets these options in tables where they may stand, with a camera named porch.
fn scene(file: &[(&str, &str)]) -> Loaded {
    let table = |pair: &(&str, &str)| NamedOptions {
        name: tables(pair.0)[0].to_owned(),
        options: pairs(&[*pair]),
    };
    Loaded {
        path: "s.toml".into(),
        scene: Scene::default(),
        options: file.iter().map(table).collect(),
        cameras: vec![NamedCamera {
            name: "porch".into(),
            options: pairs(&[("eye", "1,1,1")]),
        }],
        moments: Vec::new(),
    }
}

fn resolve(user: &[(&str, &str)], file: &[(&str, &str)]) -> Result<Options, String> {
    Options::resolve(&user.into(), &scene(file)).map_err(|e| e.to_string())
}

fn sun(user: &[(&str, &str)], file: &[(&str, &str)]) -> SunInput {
    resolve(user, file).expect("good options").sun
}

#[test]
fn nothing_given_is_a_summer_afternoon() {
    let when = chrono::DateTime::parse_from_rfc3339("2026-06-21T15:00:00+02:00").expect("a moment");
    assert_eq!(
        sun(&[], &[]),
        SunInput::Place {
            latitude: 55.79,
            longitude: 12.52,
            when
        }
    );
}

#[test]
fn local_times_are_those_of_the_place_that_is_used() {
    let when = |user: &[(&str, &str)], file: &[(&str, &str)]| match sun(user, file) {
        SunInput::Place { when, .. } => when.to_rfc3339(),
        other => panic!("{other:?}"),
    };
    let tokyo = ("place", "tokyo");
    assert_eq!(when(&[tokyo], &[]), "2026-06-21T15:00:00+09:00");
    assert_eq!(when(&[], &[tokyo]), "2026-06-21T15:00:00+09:00");
    let winter = ("when", "2026-12-21T15:00");
    for (user, file) in [([tokyo], [winter]), ([winter], [tokyo])] {
        assert_eq!(when(&user, &file), "2026-12-21T15:00:00+09:00");
    }
    assert_eq!(when(&[winter], &[]), "2026-12-21T15:00:00+01:00");
    let error = resolve(&[("when", "2026-10-25 02:30")], &[("place", "oslo")]);
    let error = error.expect_err("two readings");
    assert!(
        error.starts_with("--when: 2026-10-25 02:30 occurs twice") && error.lines().count() == 1,
        "{error}"
    );
    // Which of the readings matters at the scene's place alone.
    let user = OptionValues::from([("when", "2026-10-25 02:30")].as_slice());
    assert!(user.alone().is_ok());
    assert_eq!(
        when(&[("when", "2026-10-25 02:30")], &[tokyo]),
        "2026-10-25T02:30:00+09:00"
    );
}

#[test]
fn the_users_sun_replaces_the_files() {
    let file = [("place", "10,20"), ("when", "2026-01-01T12:00Z")];
    let direction = SunInput::Direction {
        azimuth_deg: 90.0,
        elevation_deg: 5.0,
    };
    assert_eq!(sun(&[("sun", "90,5")], &file), direction);
    let solar = SunInput::Solar {
        day: 172,
        hours: 15.0,
        latitude: 10.0,
    };
    assert_eq!(sun(&[("solar", "172,15")], &file), solar);
    assert_eq!(sun(&[("sun", "90,5")], &[("solar", "172,15")]), direction);
    let later = sun(
        &[("when", "2026-02-01T12:00Z")],
        &[("sun", "90,5"), ("turbidity", "2")],
    );
    assert!(matches!(
        later,
        SunInput::Place {
            latitude: 55.79,
            ..
        }
    ));
    let moved = sun(&[("place", "-33,151")], &file);
    assert!(
        matches!(moved, SunInput::Place { latitude: -33.0, longitude: 151.0, when } if when.timestamp() == 1_767_268_800)
    );
}

#[test]
fn cameras_and_exposures_are_groups() {
    let file = [
        ("eye", "9,9,9"),
        ("target", "0,1,0"),
        ("fov", "20"),
        ("ev100", "14"),
    ];
    let porch = resolve(&[("camera", "porch")], &file).expect("good");
    assert_eq!(
        (porch.eye, porch.target, porch.fov, porch.camera.as_deref()),
        (Some([1.0; 3]), None, 45.0, Some("porch"))
    );
    let eye = resolve(&[("eye", "-5,2,2")], &file).expect("good");
    assert_eq!(
        (eye.eye, eye.target),
        (Some([-5.0, 2.0, 2.0]), Some([0.0, 1.0, 0.0]))
    );
    let tuned = resolve(&[("camera", "porch"), ("fov", "70")], &file).expect("good");
    assert_eq!((tuned.eye, tuned.fov), (Some([1.0; 3]), 70.0));
    let auto = resolve(&[("exposure", "auto")], &file).expect("good");
    assert_eq!(auto.ev100, None);
}

#[test]
fn defaults_follow_other_options() {
    let of = |user: &[(&str, &str)]| resolve(user, &[]).expect("good");
    assert_eq!(of(&[]).visibility, Visibility::Ssao);
    assert_eq!(of(&[("samples", "16")]).visibility, Visibility::Dome);
    let screen = of(&[("samples", "16"), ("visibility", "ssao")]);
    assert_eq!(screen.visibility, Visibility::Ssao);
    let noise = of(&[("noise", "0.01")]);
    assert_eq!((noise.samples, noise.visibility), (4096, Visibility::Dome));
    assert_eq!(of(&[("noise", "0.01"), ("samples", "9")]).samples, 9);
    let lux = of(&[("false-colour", "illuminance")]);
    assert_eq!(lux.show.to_string(), "irradiance");
}

#[test]
fn tables_hold_their_own_options() {
    let table = |name: &str, options: &[(&str, &str)]| NamedOptions {
        name: name.to_owned(),
        options: pairs(options),
    };
    let error = |tables: Vec<NamedOptions>| {
        let loaded = Loaded {
            options: tables,
            ..scene(&[])
        };
        let resolved = Options::resolve(&OptionValues::default(), &loaded);
        resolved.expect_err("odd tables").to_string()
    };
    for (tables, part) in [
        (
            vec![table("sky", &[("turbidty", "3")])],
            "s.toml: unknown key \"turbidty\" in [sky]; known are sky, turbidity",
        ),
        (
            vec![table("skye", &[])],
            "unknown key \"skye\" in the scene file; known are mesh, place, sun, ",
        ),
        (
            vec![
                table("place", &[("place", "1,2")]),
                table("sun", &[("place", "1,2")]),
            ],
            "\"place\" is given twice; keep the one in [sun]",
        ),
        (
            vec![table("light", &[("samples", "4")])],
            "\"samples\" in [light]",
        ),
    ] {
        let error = error(tables);
        assert!(error.contains(part), "{error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
    let mut loaded = scene(&[]);
    loaded.moments = vec![table("dusk", &[("ao-radius", "4")])];
    let unused = Options::resolve(&OptionValues::default(), &loaded);
    let text = unused.expect_err("a key of [light]").to_string();
    assert!(text.contains("\"ao-radius\" in [[moment]]"), "{text}");
}

#[test]
fn the_preset_is_below_what_is_given() {
    let s = resolve(
        &[("preset", "lecture"), ("sun", "90,5")],
        &[("turbidity", "5")],
    )
    .expect("good");
    assert_eq!(
        (s.turbidity, s.scale, s.tonemap),
        (Some(5.0), Some(0.025), ToneCurve::Linear)
    );
    assert_eq!(
        s.sun,
        SunInput::Direction {
            azimuth_deg: 90.0,
            elevation_deg: 5.0
        }
    );
    let bare = resolve(&[("preset", "lecture")], &[]).expect("good");
    assert_eq!(
        bare.sun,
        SunInput::Solar {
            day: 200,
            hours: 10.0,
            latitude: 45.0
        }
    );
}

#[test]
fn bad_values_are_one_line() {
    for (user, file, part) in [
        (("camera", "attic"), ("fov", "30"), "the scene has porch"),
        (
            ("fov", "30"),
            ("turbidity", "abc"),
            "s.toml: invalid value 'abc' for '--turbidity",
        ),
        (
            ("sky", "preetham"),
            ("turbidity", "1500"),
            "turbidity must be -100 to 100",
        ),
        (("eye", "0,1,0"), ("target", "0,1,0"), "the same point"),
        (
            ("sky", "blue"),
            ("fov", "30"),
            "possible values: atmosphere, preetham",
        ),
    ] {
        let error = resolve(&[user], &[file]).expect_err(part);
        assert!(error.contains(part), "{error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
    let both =
        resolve(&[("sun", "1,2"), ("when", "2026-01-01T12:00Z")], &[]).expect_err("conflict");
    assert!(both.contains("cannot be used with"), "{both}");
}
