//! A year at sensors with known answers: open ground, a plane that reflects, a façade; the same numbers on any number of cores; honest
//! standard errors.

use glam::Vec3;

use super::tests::squares;
use super::{
    ALL_BOUNCES, Accuracy, Sensor, Shard, TracedScene, Year, YearLight, YearRun, measure_year,
    sky_components, suns_seen,
};
use crate::daylight::metrics::{Measures, Schedule};
use crate::daylight::weather::Weather;
use crate::scene::Scene;

/// Three days in March, hour by hour, with sun and clouds.
fn weather() -> Weather {
    let mut text =
        "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 3/19, 3/21\n"
            .to_owned();
    for at in 0..72 {
        let (day, hour) = (19 + at / 24, at % 24);
        let is_day = (7..18).contains(&hour);
        let (direct, diffuse) = match (is_day, at % 3) {
            (false, _) => (0, 0),
            (true, 0) => (0, 140),
            (true, 1) => (350, 120),
            (true, _) => (700, 80),
        };
        text += &format!(
            "2001,3,{day},{},0,?,15,9,70,101300,0,0,300,9999,{direct},{diffuse},0,0,0,0,0,0,0,0,20\n",
            hour + 1
        );
    }
    Weather::parse(&text, false).expect("a file")
}

struct Setting {
    light: YearLight,
    measures: Measures,
}

impl Setting {
    fn new() -> Self {
        let weather = weather();
        let light = YearLight::new(&weather, 0.0);
        let thresholds = vec![300.0, 12_000.0, 25_000.0];
        let measures = Measures::new(&weather, &light.hours, Schedule::default(), thresholds);
        Self {
            measures: measures.expect("hours"),
            light,
        }
    }

    fn year(&self, scene: &Scene, sensors: &[Sensor], paths: u32, seed: u32) -> Year {
        let names = self.measures.names().len() + 1;
        let run = YearRun {
            scene: &TracedScene::new(scene),
            light: &self.light,
            measures: &self.measures,
            accuracy: Accuracy {
                relative_error: 0.0,
                max_paths: paths,
                seed,
                bounces: ALL_BOUNCES,
            },
            wanted: vec![true; names],
            keeps_hours: true,
            shard: Shard::ALL,
            progress: &|_, _| (),
            is_stopped: &|| false,
        };
        measure_year(sensors, &run)
    }

    fn value(&self, year: &Year, sensor: usize, name: &str) -> [f64; 2] {
        let mut names = self.measures.names();
        names.push("df".to_owned());
        let at = names.iter().position(|own| own == name).expect(name);
        let sensor = &year.sensors[sensor];
        [sensor.values[at], sensor.errors[at]]
    }
}

fn sensor(position: Vec3, normal: Vec3) -> Sensor {
    Sensor { position, normal }
}

#[test]
fn open_ground_has_the_light_of_the_file() {
    let setting = Setting::new();
    let up = sensor(Vec3::Y, Vec3::Y);
    let year = setting.year(&Scene::default(), &[up], 4096, 0);
    let global = setting.light.hours.iter().map(|hour| hour.global_lux());
    let lux = &year.sensors[0].lux;
    for (found, expected) in lux.iter().zip(global) {
        let off = f64::from(*found) / expected - 1.0;
        assert!(off.abs() < 0.01, "{found} {expected}");
    }
    let [factor, error] = setting.value(&year, 0, "df");
    assert!(
        (factor - 100.0).abs() < 0.2 && error < 0.1,
        "{factor} {error}"
    );
    // An hour at the threshold may fall on either side.
    let weather = weather();
    let is_counted = |record: usize| (8.0..18.0).contains(&weather.records[record].hour);
    let hours = setting
        .light
        .hours
        .iter()
        .filter(|hour| is_counted(hour.record));
    let expected = hours.filter(|hour| hour.global_lux() >= 25_000.0).count() as f64;
    let [autonomy, _] = setting.value(&year, 0, "da25000");
    assert!(
        (0.3 * autonomy - expected).abs() <= 1.0,
        "{autonomy} {expected}"
    );
    assert!((5.0..28.0).contains(&expected), "{expected}");
    assert_eq!(setting.value(&year, 0, "da300"), [100.0, 0.0]);
}

#[test]
fn a_plane_reflects_sun_and_sky_of_every_hour() {
    let setting = Setting::new();
    let size = 2e4;
    let corner = Vec3::new(-0.5 * size, 0.0, -0.5 * size);
    let scene = squares(&[[corner, size * Vec3::Z, size * Vec3::X]]);
    let year = setting.year(&scene, &[sensor(Vec3::Y, -Vec3::Y)], 2048, 3);
    for (hour, found) in setting.light.hours.iter().zip(&year.sensors[0].lux) {
        let expected = 0.5 * hour.global_lux();
        let off = f64::from(*found) / expected - 1.0;
        // The suns are interpolated over eight days.
        assert!(off.abs() < 0.02, "{found} {expected}");
    }
    assert_eq!(year.sensors[0].exposed_hours, 0.0);
}

#[test]
fn a_free_facade_has_the_sky_component_of_the_formula() {
    // Moon & Spencer's sky on a vertical plane.
    let expected = 100.0 * (3.0 / 7.0) * (0.5 + 4.0 / (3.0 * std::f64::consts::PI));
    assert!((expected - 39.6177).abs() < 1e-3, "{expected}");
    let facade = sensor(Vec3::Y, Vec3::Z);
    let empty = Scene::default();
    let scene = TracedScene::new(&empty);
    let [component, error] = sky_components(&[(0, facade)], &scene, 0)[0];
    assert!((component - expected).abs() < 0.05, "{component}");
    assert!(error <= 0.02, "{error}");
    // An endless wall as high as it is far, 45° above the sensor: the sky above 45° is left in front.
    let wall = squares(&[[Vec3::new(-1e4, 0.0, 10.0), 2e4 * Vec3::X, 11.0 * Vec3::Y]]);
    let scene = TracedScene::new(&wall);
    let [component, _] = sky_components(&[(0, facade)], &scene, 0)[0];
    // The wedge of sky up to the angle t from the façade's plane: (1 − cos t)/2 of its uniform part, sin² t of the rest.
    let wedge = |t: f64| (1.0 - t.cos()) / 2.0 * 3.0 / 7.0 * 100.0;
    let steep = 100.0 * 3.0 / 7.0 * (4.0 / (3.0 * std::f64::consts::PI)) * (t45().sin().powi(2));
    let expected = wedge(t45()) + steep;
    assert!(
        (component - expected).abs() < 0.05,
        "{component} {expected}"
    );
    let suns = [Vec3::new(0.0, 0.6, 0.8), Vec3::new(0.0, 0.8, 0.6), -Vec3::Z];
    assert_eq!(suns_seen(&[(0, facade)], &scene, &suns), [1]);
}

/// 45°.
fn t45() -> f64 {
    std::f64::consts::FRAC_PI_4
}

/// A room of 4 x 3 x 4 m without its front, reflectance 0.5, and nine sensors.
fn niche() -> (Scene, Vec<Sensor>) {
    let [x, y, z] = [4.0 * Vec3::X, 3.0 * Vec3::Y, 4.0 * Vec3::Z];
    let scene = squares(&[
        [Vec3::ZERO, x, z],
        [y, x, z],
        [Vec3::ZERO, y, z],
        [x, y, z],
        [Vec3::ZERO, x, y],
    ]);
    let at = |i: i32| Vec3::new((i % 3 + 1) as f32, 0.8, (i / 3 + 1) as f32);
    (scene, (0..9).map(|i| sensor(at(i), Vec3::Y)).collect())
}

#[test]
fn numbers_do_not_depend_on_the_cores() {
    let (setting, (scene, sensors)) = (Setting::new(), niche());
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads");
        pool.install(|| setting.year(&scene, &sensors, 2048, 7))
    };
    let one = with(1);
    assert_eq!(one, with(3));
    assert!(one != setting.year(&scene, &sensors, 2048, 8));
}

#[test]
fn the_stated_error_is_the_spread_over_seeds() {
    const SEEDS: u32 = 20;
    let (setting, (scene, sensors)) = (Setting::new(), niche());
    let years: Vec<Year> = (0..SEEDS)
        .map(|seed| setting.year(&scene, &sensors, 2048, 100 + seed))
        .collect();
    for name in ["df", "mean_lux", "cda12000"] {
        let (mut spread, mut stated) = (0.0, 0.0);
        for sensor in 0..sensors.len() {
            let found: Vec<[f64; 2]> = years
                .iter()
                .map(|year| setting.value(year, sensor, name))
                .collect();
            let mean = found.iter().map(|f| f[0]).sum::<f64>() / f64::from(SEEDS);
            let squares: f64 = found.iter().map(|f| (f[0] - mean).powi(2)).sum();
            spread += squares / f64::from(SEEDS - 1);
            stated += found.iter().map(|f| f[1] * f[1]).sum::<f64>() / f64::from(SEEDS);
        }
        let ratio = (spread / stated).sqrt();
        println!("{name}: spread over stated error {ratio:.3}");
        assert!((0.8..1.25).contains(&ratio), "{name}: {ratio}");
    }
}
