//! Panes of glass in pictures: the light of sun and sky through them, the view through them, what they mirror; against the formulas.

use skylight::daylight::colour::luminance;
use skylight::frame::FrameSettings;
use skylight::passes::bounces::cells::Bounces;
use skylight::passes::dome::route::DomeBy;
use skylight::passes::light::lighting::Show;
use skylight::scene::{Material, Scene};
use skylight::validate::surfaces::{TINT, below, roofed, seen_through, sun_through};

use crate::bounces::{converged, mean, single, with_bounces};
use crate::gpu::{
    Device, Model, camera, clear_day, constant_sky, glass, hemispherical_transmittance, matt,
    showing,
};

/// Single and converged pictures; the sky's visibility and the sun's by maps and by rays.
fn ways() -> [(&'static str, FrameSettings); 3] {
    let converged = |by: DomeBy| {
        let mut set = with_bounces(Bounces::UpTo(0), converged(24, 16, 64));
        set.sampling.dome.by = by;
        set
    };
    [
        ("single", single(24, 16)),
        ("converged by maps", converged(DomeBy::Maps)),
        ("converged by rays", converged(DomeBy::Rays)),
    ]
}

#[test]
fn the_sun_passes_a_pane_by_its_angle_and_colour() {
    let mut device = Device::new();
    for elevation in [70.0, 35.0, 15.0] {
        for (name, set) in ways() {
            let [ratio, expected] = sun_through(&mut device, set, elevation).expect("drawn");
            let error = (ratio / expected - 1.0).abs().max_element();
            println!("{name}, {elevation} degrees: {ratio:.4} of {expected:.4}");
            // Texels of the map of panes are half floats.
            assert!(error < 2e-3, "{name}, {elevation}: {ratio} {expected}");
        }
    }
}

#[test]
fn a_uniform_sky_passes_a_pane_from_cells_and_from_shadow_maps() {
    let mut device = Device::new();
    let day = constant_sky(1000.0);
    let scene = roofed(Some(&glass([0.7; 3])));
    let expected = 0.5 * hemispherical_transmittance(0.7);
    for (name, set) in ways() {
        let set = showing(Show::Sky, set);
        let found = mean(&device.picture(&scene, set, &day, &below()));
        println!("{name}: {found:.4} of {expected:.4} kcd/m2");
        // Rays pass by chance, and so do texels of the maps.
        let bound = if name == "single" { 0.05 } else { 0.01 };
        assert!((found / expected - 1.0).abs() < bound, "{name}: {found}");
    }
}

/// The pane's triangles lie between those of two bodies in the index buffer, and must not be drawn with them.
#[test]
fn a_pane_between_two_bodies_is_no_wall() {
    let mut device = Device::new();
    let day = constant_sky(1000.0);
    let scene = |pane: Option<&Material>| {
        let model =
            Model::default()
                .ground(3.0, &matt(0.5))
                .cube([1.2, 0.05, 0.0], 0.05, &matt(0.5));
        let model = match pane {
            Some(pane) => model.square([0.0, 2.0, 0.0], 400.0, pane),
            None => model,
        };
        model.cube([-1.2, 0.05, 0.0], 0.05, &matt(0.5)).build()
    };
    let expected = hemispherical_transmittance(0.8);
    for (name, set) in ways() {
        let set = showing(Show::Sky, set);
        let mut lit = |scene: &Scene| mean(&device.picture(scene, set, &day, &below()));
        let ratio = lit(&scene(Some(&glass([0.8; 3])))) / lit(&scene(None));
        println!("{name}: {ratio:.4} of {expected:.4}");
        let bound = if name == "single" { 0.05 } else { 0.01 };
        assert!((ratio / expected - 1.0).abs() < bound, "{name}: {ratio}");
    }
}

/// Up through the pane: the sky dimmed by angle, and below it what the pane mirrors of a black floor: nothing.
#[test]
fn the_view_through_a_pane_is_dimmed_and_mirrors_what_is_there() {
    let mut device = Device::new();
    for degrees in [0.0f64, 50.0] {
        for (name, set) in ways() {
            let both = seen_through(&mut device, set, degrees).expect("drawn");
            let [[up, through], [down, mirrored]] = both;
            println!("{name}, {degrees}: {up:.4} of {through:.4}, {down:.4} of {mirrored:.4}");
            for (found, expected) in [(up, through), (down, mirrored)] {
                let error = (found / expected - 1.0).abs().max_element();
                assert!(error < 3e-3, "{name}, {degrees}: {found} {expected}");
            }
        }
    }
}

#[test]
fn the_layers_of_a_picture_with_panes_sum_to_it() {
    let mut device = Device::new();
    let day = clear_day(160.0, 40.0);
    let scene = Model::default()
        .ground(3.0, &matt(0.5))
        .quad(
            [-1.0, 0.0, 1.0],
            [2.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            &glass(TINT),
        )
        .cube([0.0, 0.5, -1.0], 0.5, &matt(0.7))
        .build();
    let view = camera([1.0, 1.0, 4.0], [0.0, 0.5, 0.0]);
    let whole = mean(&device.picture(&scene, single(48, 32), &day, &view));
    let layers = Show::ADDENDS.map(|show| {
        let picture = device.picture(&scene, showing(show, single(48, 32)), &day, &view);
        picture.pixels().map(|(_, v)| luminance(v)).sum::<f64>() / (48.0 * 32.0)
    });
    let sum: f64 = layers.iter().sum();
    println!("{whole:.4} {layers:.4?}");
    assert!((sum / whole - 1.0).abs() < 5e-3, "{sum} {whole}");
    assert!(layers[5] > 0.0, "the pane mirrors nothing");
}
