//! Made sensors against the grids that other programs were given.

use skylight::scene::{LoadOptions, load};
use skylight::sensors::{Planes, make_grid, read_grid};

use crate::common;

/// A room behind glass, with its reveals, its overhang, what stands before it, and ground of 400 m around.
#[test]
fn in_rooms_they_are_the_sensors_of_the_reference() {
    let Some(shared) = common::shared() else {
        return;
    };
    for (model, grid, spacing) in [
        ("office_glass", "office", 0.6),
        ("office_open", "office", 0.6),
        ("openplan_glass", "openplan", 1.0),
        ("openplan_open", "openplan", 1.0),
    ] {
        let folder = shared.join("daylight/models");
        let path = folder.join(format!("{model}.obj"));
        let scene = load(&path, &LoadOptions::default()).expect("a model").scene;
        let path = folder.join(format!("{grid}.pts"));
        let expected = read_grid(&path, scene.origin).expect("a grid");
        let planes = Planes {
            height: 0.8,
            spacing,
            inset: 0.0,
            floors: Vec::new(),
        };
        let made = make_grid(&scene, &planes).expect("sensors");
        assert_eq!(made.len(), expected.len(), "{model}");
        let apart = made.iter().zip(&expected);
        let apart = apart.map(|(a, b)| a.position.distance(b.position));
        let most = apart.fold(0.0, f32::max);
        println!("{model}: {} sensors, at most {most:.5} m apart", made.len());
        assert!(most < 1e-3, "{model}: {most}");
    }
}
