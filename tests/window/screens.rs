//! Screens of several pixels a point, a window of one pixel, and a keyboard that goes elsewhere.

use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use crate::running::{DIRECT, Running, difference, shared_machine};
use crate::x::{Display, keysym};
use skylight::compare::Picture;

/// A view whose picture at rest does not depend on what was drawn before.
fn view(size: &'static str) -> Vec<&'static str> {
    [
        &["--quiet", "--size", size, "--samples", "2", "--validate"][..],
        &DIRECT,
    ]
    .concat()
}

/// The first and the last column in which two pictures differ.
fn columns_that_differ(a: &Picture, b: &Picture) -> [usize; 2] {
    let [width, _] = a.size;
    let differ = |x: &usize| {
        let mut pixels = a.rgb.iter().zip(&b.rgb).skip(*x).step_by(width);
        pixels.any(|(a, b)| a != b)
    };
    let first = (0..width).find(differ).expect("a column");
    let last = (0..width).rev().find(differ).expect("a column");
    [first, last]
}

fn drag(display: &Display) {
    display.point(500, 130);
    display.press(1);
    for step in 1..=10 {
        display.point(500 + 6 * step, 130 + step);
    }
    display.release(1);
}

/// A place on the picture that the read-out covers.
const ON_READ_OUT: [u32; 2] = [900, 230];

#[test]
fn a_screen_of_more_pixels_has_the_same_picture_and_a_larger_panel() {
    let _machine = shared_machine();
    let [plain, half_more, double] = ["1", "1.5", "2"].map(|scale| {
        let variables = [("WINIT_X11_SCALE_FACTOR", Path::new(scale))];
        let running = Running::bare_with(&view("960x270"), &variables);
        let shown = running.daylit();
        let dragged = running.after(drag);
        running.display.point(1590, 1190);
        let panel = running.after(|d| d.key(keysym::TAB, false));
        let [first, last] = columns_that_differ(&dragged, &panel);
        // The read-out tells of the pixel under the pointer, comes to rest, and goes with it.
        let [x, y] = ON_READ_OUT;
        let read = running.after(|d| d.point(x, y));
        let covers = columns_that_differ(&panel, &read);
        println!("{scale}: the panel takes columns {first} to {last}, the read-out {covers:?}");
        assert!(covers[0] < x as usize && covers[1] > x as usize, "{scale}");
        assert!(running.after(|d| d.point(1590, 1190)) == panel, "{scale}");
        running.close_well();
        (shown, dragged, last - first)
    });
    for (scale, other) in [(1.5, &half_more), (2.0, &double)] {
        let flips = [
            difference(&plain.0, &other.0),
            difference(&plain.1, &other.1),
        ];
        let wider = other.2 as f64 / plain.2 as f64;
        println!(
            "{scale}: FLIP at the start and after a drag {flips:.5?}, panel {wider:.3} times as wide"
        );
        assert!(flips.iter().all(|flip| *flip < 0.002), "{flips:?}");
        assert!((wider / scale - 1.0).abs() < 0.1, "{wider}");
    }
}

#[test]
fn a_window_of_one_pixel_grows_to_the_same_picture() {
    let _machine = shared_machine();
    let running = Running::bare(&view("480x270"));
    let before = running.daylit();
    for wait in [50, 1500] {
        running.display.resize(running.window, 1, 1);
        sleep(Duration::from_millis(wait));
        running.display.resize(running.window, 480, 270);
        let after = running.daylit();
        let flip = difference(&before, &after);
        println!("{wait} ms at 1x1: FLIP {flip:.5}");
        assert!(flip < 0.002, "{flip}");
        // It stays.
        sleep(Duration::from_secs(3));
        assert!(running.display.picture(running.window, None) == after);
    }
    running.close_well();
}

#[test]
fn a_key_that_is_held_while_the_focus_goes_elsewhere_no_longer_flies() {
    let _machine = shared_machine();
    let running = Running::bare(&view("480x270"));
    let before = running.daylit();
    running.display.hold('w');
    running.display.wait_for_change(running.window, &before);
    running.display.unfocus();
    let stopped = running.picture();
    running.display.let_go('w');
    assert!(difference(&before, &stopped) > 0.005, "W flies");
    running.display.focus(running.window);
    assert!(difference(&stopped, &running.picture()) < 0.002, "it rests");
    let on = running.after(|d| {
        d.hold('s');
        sleep(Duration::from_millis(500));
        d.let_go('s');
    });
    assert!(difference(&stopped, &on) > 0.005, "S flies back");
    running.close_well();
}
