//! Rays through the hierarchy on the device against those on the CPU, hit by hit.

use glam::{DVec2, DVec3};

use crate::common;
use crate::gpu::{Device, Model, matt};
use skylight::daylight::sampling::{rnd, uniform_sphere};
use skylight::passes::bounces::trace::{Query, Trace};
use skylight::passes::bounces::tree::Tree;
use skylight::scene::{Bvh, LoadOptions, Ray, Scene, hills, load};

const RAYS: usize = 100_000;

/// Distance of a ray without a hit.
const FAR: f32 = 1e30;

/// Rays from random points around a scene in random directions.
fn rays(scene: &Scene) -> Vec<Ray> {
    let mut state = 7;
    let (low, extent) = (scene.bounds.min - 1.0, scene.bounds.extent() + 2.0);
    (0..RAYS)
        .map(|_| {
            let mut number = || rnd(&mut state);
            let at = DVec3::new(number(), number(), number()).as_vec3();
            let direction = uniform_sphere(DVec2::new(number(), number())).as_vec3();
            Ray {
                origin: low + at * extent,
                direction,
            }
        })
        .collect()
}

/// The fraction of rays whose nearest hits differ, and of those whose occlusion differs.
fn differences(device: &mut Device, scene: &Scene) -> (f64, f64) {
    let (bvh, rays) = (Bvh::of(scene, |_| true), rays(scene));
    let tree = device.run(|rec| Tree::new(rec, scene).expect("a hierarchy"));
    let mut traced = |query| {
        let trace = device.run(|rec| Trace::new(rec, &tree, &rays, query).expect("rays"));
        device.run(|rec| {
            trace.record(rec, &tree);
        });
        device.read(trace.hits())
    };
    let (closest, any) = (traced(Query::Closest), traced(Query::Any));
    let (mut different, mut hidden) = (0, 0);
    for (i, ray) in rays.iter().enumerate() {
        let expected = bvh.closest(ray, 0.0, FAR, |_| true);
        let [distance, triangle, ..] = closest[i];
        let is_same = match expected {
            Some(hit) => {
                let number = (distance < FAR).then(|| tree.numbers()[triangle as usize]);
                // At a shared edge both triangles are right.
                number == Some(hit.triangle)
                    || (distance - hit.distance).abs() < 1e-4 * (1.0 + hit.distance)
            }
            None => distance >= FAR,
        };
        different += usize::from(!is_same);
        hidden += usize::from((any[i][0] > 0.5) != expected.is_some());
    }
    let share = |n: usize| n as f64 / RAYS as f64;
    (share(different), share(hidden))
}

fn check(device: &mut Device, name: &str, scene: &Scene) {
    let (closest, any) = differences(device, scene);
    println!(
        "{name}: {} triangles, nearest hits differ in {closest:.1e} of the rays, occlusion in {any:.1e}",
        scene.triangles()
    );
    // Rays that graze an edge: the device may fuse multiplications and additions.
    assert!(closest < 1e-4 && any < 1e-4, "{name}");
}

#[test]
fn the_device_meets_the_same_triangles() {
    let mut device = Device::new();
    let grey = matt(0.5);
    let boxes = Model::default()
        .ground(8.0, &grey)
        .cube([0.0, 1.0, 0.0], 1.0, &grey)
        .cube([3.0, 0.5, 1.0], 0.5, &grey);
    check(&mut device, "boxes", &boxes.build());
    let sphere = Model::default().sphere([0.0; 3], 1.0, 40, &grey);
    check(&mut device, "sphere", &sphere.build());
    check(&mut device, "hills", &hills(30_000));
    check(&mut device, "nothing", &Scene::default());
}

#[test]
fn the_device_meets_the_same_triangles_of_real_models() {
    let Some(shared) = common::shared() else {
        return;
    };
    let mut device = Device::new();
    for file in [
        "gi/office/office.obj",
        "scenes/colonnade/colonnade.obj",
        "scenes/house/house.obj",
        "scenes/medieval_building/Medieval_building.obj",
        "scenes/teapot/teapot_on_plane.obj",
        "scenes/courtyard/scene.obj",
    ] {
        let loaded = load(&shared.join(file), &LoadOptions::default()).expect("a model");
        check(&mut device, file, &loaded.scene);
    }
}
