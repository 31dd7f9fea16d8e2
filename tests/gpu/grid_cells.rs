//! Cells of sensors over the picture: their colours, and that surfaces before them hide them.

use glam::{Vec2, Vec3};
use skylight::frame::AntiAliasing;
use skylight::gpu::{ContextOptions, Route};
use skylight::passes::picture::grid_cells::{GridCell, GridCells};
use skylight::passes::view::View;

use crate::gpu::{Device, Model, camera, clear_day, matt, settings};

/// A level square at a height, by its middle and half its edge.
fn level([x, y, z]: [f32; 3], half: f32, colour: Vec3) -> GridCell {
    let corner = |dx: f32, dz: f32| Vec3::new(x + half * dx, y, z + half * dz);
    GridCell {
        corners: [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ],
        colour,
    }
}

#[test]
fn cells_have_their_colours_where_nothing_is_before_them() {
    expect_colours(Route::Fragment);
}

#[test]
fn and_so_they_have_where_compute_shaders_copy_the_picture() {
    expect_colours(Route::Compute);
}

fn expect_colours(route: Route) {
    let mut device = Device::with(&ContextOptions {
        route: Some(route),
        ..ContextOptions::default()
    });
    let grey = matt(0.5);
    // A board covers the middle from above.
    let scene = Model::default()
        .ground(20.0, &grey)
        .square([0.0, 2.0, 0.0], 1.0, &grey)
        .build();
    let camera = camera([0.0, 10.0, 0.01], [0.0, 0.0, 0.0]);
    let mut set = settings(64, 64);
    set.aa = AntiAliasing::Off;
    let day = clear_day(180.0, 50.0);
    let frame = device.frame(&scene, set, &day, &camera);
    let before = device.read(frame.display());
    let mut pass = GridCells::new(&device.context.clone());
    let view = View {
        camera,
        size: set.size,
        jitter: Vec2::ZERO,
        sharpen: 0.0,
        window: None,
    };
    let red = Vec3::new(1.0, 0.0, 0.0);
    let draw = |device: &mut Device, pass: &mut GridCells, cells: Vec<GridCell>| {
        device.run(|rec| {
            let below = (frame.display(), frame.depth());
            pass.record(rec, below, &view, cells).expect("a picture");
        });
        device.read(pass.image().expect("a picture"))
    };
    let after = draw(
        &mut device,
        &mut pass,
        vec![level([0.0, 1.0, 0.0], 2.0, red)],
    );
    // Pixels of a point at a height.
    let at = |[x, y, z]: [f32; 3]| {
        let clip = view.clip_from_world() * Vec3::new(x, y, z).extend(1.0);
        let place = (Vec2::new(clip.x, clip.y) / clip.w * 0.5 + 0.5) * 64.0;
        place.y as usize * 64 + place.x as usize
    };
    let shown = after[at([1.8, 1.0, 0.0])];
    assert_eq!(shown[..3], [1.0, 0.0, 0.0], "a cell beside the board");
    for hidden in [at([0.0, 2.0, 0.0]), at([5.0, 0.0, 0.0])] {
        assert_eq!(
            after[hidden][..3],
            before[hidden][..3],
            "under the board, and beside the cell"
        );
    }
    // Without cells it is the picture below.
    let none = draw(&mut device, &mut pass, Vec::new());
    assert!(none.iter().zip(&before).all(|(a, b)| a[..3] == b[..3]));
}
