//! A window of one pixel, and a keyboard that goes elsewhere.

use std::thread::sleep;
use std::time::Duration;

use crate::running::{DIRECT, Running, difference, shared_machine};

/// A view whose picture at rest does not depend on what was drawn before.
fn view(size: &'static str) -> Vec<&'static str> {
    [
        &["--size", size, "--samples", "2", "--validate"][..],
        &DIRECT,
    ]
    .concat()
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
