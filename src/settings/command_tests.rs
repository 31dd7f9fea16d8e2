use std::ffi::OsString;

use chrono::{DateTime, FixedOffset};
use clap::ValueEnum;

use super::super::{
    AoResolution, Direction, ExposureMode, Filter, Fresnel, Optional, Penumbra, Phong, Place,
    Preset, Quantity, Range, Reflections, Show, Size, SkyModel, SolarTime, SunPositionMethod,
    Switch, ToneCurve, Visibility, When,
};
use super::*;
use crate::cli::{Command, parse};
use crate::daylight::irradiance::IrradianceMethod;
use crate::daylight::sampling::rnd;
use crate::scene::{Bounds, NamedCamera, NamedMoment, Scene};

fn pairs(list: &[(&str, &str)]) -> Vec<(String, String)> {
    list.iter()
        .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
        .collect()
}

fn loaded(options: &[(&str, &str)]) -> Loaded {
    Loaded {
        path: "s.toml".into(),
        scene: Scene::default(),
        options: pairs(options),
        cameras: vec![NamedCamera {
            name: "the \"old\" porch's".into(),
            options: pairs(&[("eye", "-1,1,1"), ("fov", "33")]),
        }],
        moments: vec![NamedMoment {
            name: "dusk".into(),
            options: pairs(&[("sun", "290,3"), ("turbidity", "4"), ("ev100", "9")]),
        }],
    }
}

/// What `line` gives when a shell and the program read it.
fn read(line: &str, loaded: &Loaded) -> (Option<String>, Settings) {
    let words = shlex::split(line).expect("quoted as a shell does");
    match parse(words.iter().map(OsString::from)) {
        Ok(Command::Render { scene, options, .. }) => (
            scene.map(|path| path.display().to_string()),
            Settings::resolve(*options, loaded).expect(line),
        ),
        other => panic!("{line}: {other:?}"),
    }
}

struct Random(u32);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        // Numbers with all their digits, and round ones.
        let value =
            low + (high - low) * (rnd(&mut self.0) + rnd(&mut self.0) / 16_777_216.0).min(1.0);
        if self.often() {
            value
        } else {
            value.trunc().max(low)
        }
    }

    fn below(&mut self, count: usize) -> usize {
        (rnd(&mut self.0) * count as f64) as usize
    }

    fn often(&mut self) -> bool {
        rnd(&mut self.0) < 0.5
    }

    fn maybe<T>(&mut self, make: impl FnOnce(&mut Self) -> T) -> Option<T> {
        self.often().then(|| make(self))
    }

    fn one<T: ValueEnum + Clone>(&mut self) -> Option<T> {
        self.maybe(|r| T::value_variants()[r.below(T::value_variants().len())].clone())
    }

    fn number(&mut self, low: f64, high: f64) -> Option<f64> {
        self.maybe(|r| r.within(low, high))
    }

    fn count(&mut self, low: u32, high: u32) -> Option<u32> {
        self.maybe(|r| r.within(low.into(), high.into()) as u32)
    }

    fn point(&mut self) -> Option<[f64; 3]> {
        self.maybe(|r| [(); 3].map(|()| r.within(-90.0, 90.0)))
    }

    fn moment(&mut self) -> DateTime<FixedOffset> {
        let seconds = self.within(-6e10, 3e10) as i64;
        let utc = DateTime::from_timestamp(seconds, 0).expect("within the years");
        let offset = FixedOffset::east_opt(900 * self.within(-48.0, 56.0) as i32);
        utc.with_timezone(&offset.expect("within a day"))
    }

    /// Every field is named: a new option has to be thought of here.
    fn options(&mut self) -> Options {
        let kind = self.below(3);
        let visibility = self.one::<Visibility>();
        let is_dome = visibility == Some(Visibility::Dome);
        Options {
            size: self.maybe(|r| Size {
                width: r.within(1.0, 32_768.0) as u32,
                height: r.within(1.0, 32_768.0) as u32,
            }),
            tile: self.count(64, 16_384),
            samples: self.count(1, 65_536),
            noise: self.maybe(|r| r.within(1e-6, 1.0)),
            visibility,
            filter: self.one::<Filter>(),
            seed: self.count(0, u32::MAX),
            dome_directions: self.count(1, 16),
            dome_size: self.count(64, 4096),
            without: self.one::<Optional>(),
            show: self.one::<Show>(),
            layers: self.often(),
            preset: self.one::<Preset>(),
            place: self
                .maybe(|r| Place {
                    latitude: r.within(-90.0, 90.0),
                    longitude: r.within(-180.0, 180.0),
                })
                .filter(|_| kind != 0),
            when: (kind == 1).then(|| When::Moment(self.moment())),
            sun: (kind == 0).then(|| Direction {
                azimuth_deg: self.within(0.0, 359.9),
                elevation_deg: self.within(-90.0, 90.0),
            }),
            solar: (kind == 2).then(|| SolarTime {
                day: self.within(1.0, 366.0) as u32,
                hours: self.within(0.0, 24.0),
            }),
            sun_position: self.one::<SunPositionMethod>(),
            sky: self.one::<SkyModel>(),
            turbidity: self.number(-100.0, 100.0),
            sky_illuminance: self.number(0.0, 1e6),
            refraction: self.one::<Switch>(),
            ground_albedo: self.number(0.0, 1.0),
            camera: self.maybe(|_| "the \"old\" porch's".to_owned()),
            eye: self.point(),
            target: self.point(),
            fov: self.number(1.0, 170.0),
            ev100: self.number(-20.0, 40.0),
            exposure: None::<ExposureMode>,
            tonemap: self.one::<ToneCurve>(),
            gamma: self.number(0.1, 10.0),
            false_colour: self.one::<Quantity>(),
            false_colour_range: self.maybe(|r| {
                let min = r.within(1.0, 90.0);
                Range {
                    min,
                    max: min * r.within(2.0, 900.0),
                }
            }),
            scale: self.number(0.0, 1e6),
            irradiance: self.one::<IrradianceMethod>(),
            irradiance_samples: self.count(1, 65_536),
            irradiance_error: self.number(0.0, 100.0),
            ao_radius: self.number(0.0, 1000.0),
            ao_resolution: self.one::<AoResolution>(),
            specular: self.number(0.0, 100.0),
            limb_darkening: self.often(),
            shadow_size: self.count(64, 16_384),
            penumbra: self.one::<Penumbra>(),
            smooth: self.number(0.0, 180.0),
            device: self.maybe(|_| "-llvmpipe $HOME 'x'".to_owned()),
            phong: self.one::<Phong>(),
            reflections: self.one::<Reflections>().filter(|_| is_dome),
            fresnel: self.one::<Fresnel>(),
            moment: self.maybe(|_| "dusk".to_owned()),
            allow_outside: self.often(),
            // Of no consequence for the picture, so no part of the command.
            no_cache: self.often(),
            max_triangles: self.count(1, u32::MAX),
            max_texture_edge: self.count(1, 65_536),
            max_texture_mib: self.count(1, u32::MAX),
            max_file_mib: self.count(1, u32::MAX),
            quiet: self.often(),
            validate: self.often(),
        }
    }
}

#[test]
fn a_line_gives_the_settings_it_was_made_of() {
    let scenes = [
        loaded(&[]),
        loaded(&[("place", "10,-20"), ("turbidity", "7"), ("ev100", "14")]),
        loaded(&[
            ("sun", "90,5"),
            ("scale", "0.5"),
            ("eye", "1,2,3"),
            ("sky", "hosek"),
        ]),
    ];
    let mut random = Random(1);
    let (mut equal, mut lost) = (0, 0);
    for round in 0..6000 {
        let options = random.options();
        // The settings of this scene, or those that one came to otherwise while it was shown.
        let shown = &scenes[round % scenes.len()];
        let origin = if random.often() { shown } else { &scenes[0] };
        let Ok(settings) = Settings::resolve(options, origin) else {
            continue;
        };
        match settings.command_line(Some(Path::new("my house.toml")), shown) {
            Ok(line) => {
                let (scene, again) = read(&line, shown);
                assert_eq!(scene.as_deref(), Some("my house.toml"));
                assert_eq!(again, settings, "{line}");
                equal += 1;
            }
            Err(error) => {
                // Only the eye and the camera of the third scene cannot be taken back.
                let text = error.to_string();
                assert!(text.starts_with("the scene sets eye"), "{text}");
                lost += 1;
            }
        }
    }
    println!(
        "{equal} lines gave their settings again; {lost} had a value that cannot be taken back"
    );
    assert!(equal > 4000, "{equal}");
}

#[test]
fn only_what_differs_is_written() {
    let scene = loaded(&[("turbidity", "7")]);
    let line = |words: &[(&str, &str)]| {
        let options = Options::from_pairs(&pairs(words)).expect("good");
        let settings = Settings::resolve(options, &scene).expect("good");
        settings.command_line(None, &scene).expect("a line")
    };
    assert_eq!(
        line(&[
            ("place", "10,20"),
            ("when", "2026-01-01T12:00Z"),
            ("sky", "hosek")
        ]),
        "skylight render --sky hosek --place 10,20 --when 2026-01-01T12:00:00+00:00"
    );
    // The scene's own 7 goes without saying, the default 3 does not.
    assert_eq!(
        line(&[("sun", "90,-5"), ("turbidity", "7")]),
        "skylight render --sun 90,-5"
    );
    assert_eq!(
        line(&[("sun", "90,5"), ("turbidity", "3")]),
        "skylight render --turbidity 3 --sun 90,5"
    );
    assert_eq!(
        line(&[("preset", "lecture"), ("ev100", "14"), ("turbidity", "7")]),
        "skylight render --place 45,0 --solar 200,10 --ev100 14 --preset lecture --fov 55"
    );
}

#[test]
fn a_camera_keeps_its_bits_and_few_digits() {
    let scene = loaded(&[]);
    let camera = Camera {
        eye: glam::Vec3::new(0.1, 1.0 / 3.0, -2e-7),
        target: glam::Vec3::new(-1234.567, 0.0, 5.0),
        fov_deg: 45.3,
        near: 0.01,
    };
    let bare = Settings::resolve(Options::default(), &scene).expect("good");
    let line = bare
        .with_camera(&camera)
        .command_line(None, &scene)
        .expect("a line");
    assert!(line.contains("--eye 0.1,0.33333334,-0.0000002"), "{line}");
    let (_, again) = read(&line, &scene);
    let seen = again.camera(&Bounds::EMPTY);
    assert_eq!(
        (seen.eye, seen.target, seen.fov_deg),
        (camera.eye, camera.target, camera.fov_deg)
    );
}

#[test]
fn odd_paths_come_through() {
    let scene = loaded(&[]);
    let settings = Settings::resolve(Options::default(), &scene).expect("good");
    for (path, read_path) in [
        ("it's a \"house\".toml", "it's a \"house\".toml"),
        ("-o.obj", "./-o.obj"),
        ("$(reboot) `x`;&|\n*.obj", "$(reboot) `x`;&|\n*.obj"),
        ("høj/сад.obj", "høj/сад.obj"),
    ] {
        let line = settings
            .command_line(Some(Path::new(path)), &scene)
            .expect("a line");
        assert_eq!(read(&line, &scene).0.as_deref(), Some(read_path), "{line}");
    }
    let lost = loaded(&[("gamma", "2")]);
    let error = settings
        .command_line(None, &lost)
        .expect_err("gamma")
        .to_string();
    assert!(
        error.contains("gamma") && error.lines().count() == 1,
        "{error}"
    );
}
