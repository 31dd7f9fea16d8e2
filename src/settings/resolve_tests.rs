use super::*;
use crate::scene::{NamedCamera, Scene};

fn pairs(list: &[(&str, &str)]) -> Vec<(String, String)> {
    list.iter()
        .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
        .collect()
}

fn resolve(user: &[(&str, &str)], file: &[(&str, &str)]) -> Result<Settings, String> {
    let porch = NamedCamera {
        name: "porch".into(),
        options: pairs(&[("eye", "1,1,1")]),
    };
    let loaded = Loaded {
        path: "s.toml".into(),
        scene: Scene::default(),
        options: pairs(file),
        cameras: vec![porch],
        moments: Vec::new(),
    };
    let user = Options::from_pairs(&pairs(user)).map_err(|e| e.to_string())?;
    Settings::resolve(user, &loaded).map_err(|e| e.to_string())
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
    let porch = resolve(&[("camera", "porch")], &file).expect("good").camera;
    let name = Some("porch".to_owned());
    assert_eq!(
        porch,
        CameraParts {
            eye: Some([1.0; 3]),
            name,
            ..CameraParts::default()
        }
    );
    let eye = resolve(&[("eye", "-5,2,2")], &file).expect("good").camera;
    assert_eq!(
        (eye.eye, eye.target),
        (Some([-5.0, 2.0, 2.0]), Some([0.0, 1.0, 0.0]))
    );
    let tuned = resolve(&[("camera", "porch"), ("fov", "70")], &file)
        .expect("good")
        .camera;
    assert_eq!((tuned.eye, tuned.fov_deg), (Some([1.0; 3]), Some(70.0)));
    let auto = resolve(&[("exposure", "auto")], &file).expect("good");
    assert_eq!(auto.exposure, Exposure::Auto);
}

#[test]
fn the_preset_is_below_what_is_given() {
    let s = resolve(
        &[("preset", "lecture"), ("sun", "90,5")],
        &[("turbidity", "5")],
    )
    .expect("good");
    assert_eq!(
        (s.turbidity, s.scale, s.tone_curve),
        (5.0, Some(0.025), ToneCurve::Linear)
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
            "possible values: preetham, hosek",
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

#[test]
fn parameters_can_be_given_back() {
    let first = resolve(
        &[
            ("sun", "90,5"),
            ("gamma", "2.2"),
            ("sky-illuminance", "9000"),
            ("refraction", "off"),
        ],
        &[],
    )
    .expect("good");
    let list: Vec<_> = first
        .parameters()
        .into_iter()
        .map(|(k, v)| (k.to_owned(), v))
        .collect();
    let loaded = Loaded {
        path: "s.toml".into(),
        scene: Scene::default(),
        options: Vec::new(),
        cameras: Vec::new(),
        moments: Vec::new(),
    };
    let again =
        Settings::resolve(Options::from_pairs(&list).expect("options"), &loaded).expect("good");
    assert_eq!(first, again);
}
