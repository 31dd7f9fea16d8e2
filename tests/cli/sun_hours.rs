//! Hours of sun on surfaces, drawn by the device, against those at sensors and the length of the day.

use std::path::Path;
use std::process::{Command, Output};

use glam::{UVec2, Vec2, Vec3};
use skylight::compare::read;
use skylight::passes::view::View;
use skylight::scene::Camera;

/// Ground, and a block of 4 by 4 m and 6 m height on it, in metres.
const MODEL: &str = "v -200 0 -200\nv 200 0 -200\nv 200 0 200\nv -200 0 200\nf 4 3 2 1\n\
v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -2 6 -2\nv 2 6 -2\nv 2 6 2\nv -2 6 2\n\
f 8 7 6 5\nf 9 12 11 10\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";

/// Width and height of the picture, pixels.
const SIZE: [u32; 2] = [48, 36];

/// Height of the camera above the ground, metres, and its field of view, degrees.
const ABOVE: (f32, f32) = (60.0, 40.0);

/// Hours from one sun to the next.
const STEP: f64 = 1.0 / 6.0;

const LIGHT: &str = "--place 50,10 --when 2026-06-21T12:00+01:00";

fn skylight(folder: &Path, words: &str) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(words.split_whitespace())
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{words}: {said}");
    output
}

/// Points of the ground at the centres of the pixels, row by row.
fn points() -> Vec<Vec3> {
    let (height, fov_deg) = ABOVE;
    let view = View {
        camera: Camera {
            eye: Vec3::new(0.0, height, 0.01),
            target: Vec3::ZERO,
            fov_deg,
            near: 0.1,
        },
        size: UVec2::from(SIZE),
        jitter: Vec2::ZERO,
        sharpen: 0.0,
        window: None,
    };
    let centres = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let centre = |(x, y): (u32, u32)| Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
    centres.map(|at| view.point(centre(at), height)).collect()
}

#[test]
fn pictures_have_the_hours_of_the_sensors() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    std::fs::write(folder.path().join("m.obj"), MODEL).expect("written");
    let ([width, height], (above, fov)) = (SIZE, ABOVE);
    let words = format!(
        "render m.obj --show sun-hours --sun-dates 6-21 {LIGHT} --eye 0,{above},0.01 --target 0,0,0 \
         --fov {fov} --size {width}x{height} --quiet -o"
    );
    skylight(folder.path(), &format!("{words} a.exr"));
    let told = skylight(folder.path(), &format!("{words} a.png"));
    let told = String::from_utf8_lossy(&told.stdout).into_owned();
    assert!(told.contains("0 to 17 h"), "{told}");
    let drawn = read(&folder.path().join("a.exr")).expect("a picture");
    let points = points();
    let lines = points.iter().map(|p| format!("{} 0 {}\n", p.x, p.z));
    std::fs::write(folder.path().join("g.csv"), lines.collect::<String>()).expect("written");
    let words =
        format!("daylight m.obj --grid g.csv --metrics sunhours --dates 6-21 {LIGHT} --json");
    let report = skylight(folder.path(), &words).stdout;
    let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
    let sensors = report["sensors"].as_array().expect("sensors").iter();
    let hours = sensors.map(|sensor| sensor["sun_hours_2026-06-21"].as_f64().expect("hours"));
    let hours: Vec<f64> = hours.collect();
    // Where the block does not stand before the ground, and away from its edges.
    let is_clear = |p: &Vec3| p.x.abs().max(p.z.abs()) > 4.5;
    let [width, height] = SIZE.map(|edge| edge as usize);
    let (mut count, mut sum, mut most, mut outside) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for y in 1..height - 1 {
        for x in (1..width - 1).filter(|x| is_clear(&points[y * width + x])) {
            // A pixel is the mean over its area, across which shadows change: it lies among the sensors around.
            let rows = (y - 1..=y + 1).map(|y| &hours[y * width + x - 1..=y * width + x + 1]);
            let around: Vec<f64> = rows.flatten().copied().collect();
            let least = around.iter().copied().fold(f64::INFINITY, f64::min);
            let largest = around.iter().copied().fold(0.0, f64::max);
            let drawn = f64::from(drawn.rgb[y * width + x][0]);
            outside = outside.max(least - drawn).max(drawn - largest);
            (count, sum) = (count + 1.0, sum + (drawn - hours[y * width + x]).abs());
            most = most.max(drawn);
        }
    }
    let mean = sum / count;
    println!(
        "{count} pixels: mean error {mean:.3} h, at most {outside:.3} h beside the sensors around, most {most:.3} h"
    );
    // A step for the ends of the hours of sun, and a quarter for the edges of the shadow maps.
    assert!(
        count > 1000.0 && mean < 0.5 * STEP && outside < 1.25 * STEP,
        "{mean} {outside}"
    );
    // Open ground has the sun all day: 2/15 acos(-tan φ tan δ), with the declination of the solstice.
    let [latitude, declination] = [50.0_f64, 23.44].map(f64::to_radians);
    let day = 2.0 / 15.0 * (-latitude.tan() * declination.tan()).acos().to_degrees();
    println!("the day has {day:.3} h");
    assert!((most - day).abs() < STEP, "{most} {day}");
}

#[test]
fn what_hours_of_sun_cannot_have_is_one_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (words, what) in [
        ("--sun 180,40", "needs a place"),
        ("--noise 0.01", "leave out --noise"),
        ("--layers -o a.exr", "leave out --layers"),
        ("--sun-step 7", "a whole number"),
        ("--sun-dates 2-30", "2026-3-21, or year"),
        ("--place 80,0 --sun-dates 12-21", "not up on 12-21"),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
            .current_dir(folder.path())
            .args(["render", "--show", "sun-hours"])
            .args(words.split(' '))
            .output()
            .expect("it runs");
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words}: {line}");
        assert!(line.contains(what) && line.lines().count() == 1, "{line}");
    }
}
