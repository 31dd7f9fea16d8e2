//! Culling changes no visible pixel: pictures with and without it, and the number of triangles drawn for a narrow view.

use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, settings, showing};
use glam::{UVec2, Vec3};
use skylight::daylight::sky::Daylight;
use skylight::frame::{Frame, FrameSettings};
use skylight::gpu::{Recorder, Timing};
use skylight::passes::light::lighting::Show;
use skylight::scene::{Bounds, Camera, Cluster, Layout, LoadOptions, Scene, bundled, load};

/// The scene with one cluster per part, unbounded and two-sided, so that nothing can be culled.
fn unculled(scene: &Scene) -> Scene {
    let far = 1e7;
    let cluster = |part: &skylight::scene::Part| Cluster {
        first: part.first_index,
        count: part.index_count,
        bounds: Bounds {
            min: Vec3::splat(-far),
            max: Vec3::splat(far),
        },
        solid: None,
        // Selects the pipeline that derives the facing from derivatives, so that the lean one is compared with it as well.
        normals_match_winding: false,
    };
    let layout = Layout {
        clusters: scene.parts.iter().map(cluster).collect(),
        of_part: (0..scene.parts.len()).map(|i| i..i + 1).collect(),
    };
    Scene {
        layout: Some(layout),
        ..scene.clone()
    }
}

/// A 400 m wide terrain of hills with 49 blocks, about `triangles` triangles: large enough for cascades.
fn hills(triangles: usize) -> Scene {
    let mut ground = skylight::scene::hills(triangles);
    let mut model = Model::default();
    for i in 0..49u32 {
        let [x, z] = [i % 7, i / 7].map(|i| 60.0 * i as f32 - 180.0);
        let distance = |p: &&[f32; 3]| (p[0] - x).hypot(p[2] - z);
        let nearest = ground
            .positions
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let [_, y, _] = nearest.expect("a vertex");
        model = model.cube([x, y + 2.0, z], 3.0, &matt(0.5));
    }
    let mut scene = model.build();
    let vertices = scene.positions.len() as u32;
    let mut part = ground.parts[0];
    part.first_index = scene.indices.len() as u32;
    part.material = scene.materials.len() as u32;
    scene.parts.push(part);
    scene.materials.push(matt(0.5));
    scene
        .indices
        .extend(ground.indices.iter().map(|i| vertices + i));
    scene.positions.append(&mut ground.positions);
    scene.normals.append(&mut ground.normals);
    scene.texcoords.append(&mut ground.texcoords);
    scene.bounds = scene.bounds.union(ground.bounds);
    scene.arrange();
    scene
}

/// Closed bodies, open sheets, alpha-tested surfaces and thin walls.
const SHARED: [&str; 8] = [
    "colonnade/colonnade.obj",
    "courtyard/scene.obj",
    "house/house.obj",
    "medieval_building/Medieval_building.obj",
    "stanford_bunny/stanford-bunny.obj",
    "teapot/teapot.obj",
    "gltf_small/AlphaBlendModeTest.glb",
    "gltf_small/CesiumMilkTruck.glb",
];

fn draw(device: &mut Device, scene: &Scene, day: &Daylight, camera: &Camera) -> [Picture; 4] {
    let shown = [Show::Depth, Show::Normal, Show::Visibility, Show::Beauty];
    let settings = showing(shown[0], settings(320, 180));
    let mut frame = device.frame(scene, settings, day, camera);
    shown.map(|show| {
        frame.show(show).expect("shown");
        device.draw(&mut frame, day, camera);
        device.picture_of(&frame)
    })
}

/// Number of pixels that differ by more than rounding.
fn differing(a: &Picture, b: &Picture) -> usize {
    let pairs = a.pixels().zip(b.pixels());
    let differs = |x: f64, y: f64| (x - y).abs() > 1e-3 * (x.abs() + y.abs()) + 1e-6;
    pairs
        .filter(|((_, a), (_, b))| (0..3).any(|k| differs(a[k], b[k])))
        .count()
}

/// The scene with every cluster two-sided: only frustum culling of views and shadow maps remains.
fn two_sided(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let layout = scene.layout.as_mut().expect("an arranged scene");
    layout.clusters.iter_mut().for_each(|c| c.solid = None);
    scene
}

/// Draws with and without culling. Frustum culling may change nothing. Back-face culling of solids changes some pixels: on
/// silhouettes, and where the depth bias of the shadow map pushes a steep front face behind the back face.
fn compare(device: &mut Device, name: &str, scene: &Scene, day: &Daylight, camera: &Camera) {
    let culled = draw(device, scene, day, camera);
    let sheets = draw(device, &two_sided(scene), day, camera);
    let whole = draw(device, &unculled(scene), day, camera);
    let seen = whole[0].pixels().filter(|(_, d)| d.x > 0.0).count();
    let faults = |drawn: &[Picture; 4]| [0, 1, 2, 3].map(|i| differing(&drawn[i], &whole[i]));
    let (beside, behind) = (faults(&sheets), faults(&culled));
    println!(
        "{name}: of {seen} pixels with surfaces, depth, normal, V and picture differ in {beside:?} without what is beside, \
         in {behind:?} without back faces too"
    );
    assert!(seen > 1000, "{name}: {seen} pixels with surfaces");
    assert_eq!(beside, [0; 4], "{name}");
    let bounds = [seen / 5000, seen / 5000, seen / 500, seen / 500];
    let within = behind.iter().zip(bounds).all(|(n, most)| *n <= most);
    assert!(within, "{name}: {behind:?}");
}

fn views(scene: &Scene) -> Vec<Camera> {
    let aspect = 16.0 / 9.0;
    let around = [Vec3::new(-0.9, 0.5, -0.2), Vec3::new(0.2, 0.1, -0.9)];
    let whole = around.map(|d| Camera::framing_from(&scene.bounds, d.normalize(), 45.0, aspect));
    // From closer, within the model's surroundings: much of it lies beside and behind the camera.
    let within = whole.map(|c| Camera {
        eye: c.eye.lerp(c.target, 0.7),
        ..c
    });
    whole.into_iter().chain(within).collect()
}

fn compare_all(device: &mut Device, name: &str, scene: &Scene) {
    for (i, camera) in views(scene).iter().enumerate() {
        let day = clear_day(70.0 + 90.0 * i as f64, [12.0, 40.0][i % 2]);
        compare(device, &format!("{name}, view {i}"), scene, &day, camera);
    }
}

#[test]
fn nothing_is_missed_of_the_bundled_scene_and_of_one_with_cascades() {
    let mut device = Device::new();
    let loaded = bundled(&LoadOptions::default()).expect("the bundled scene");
    compare_all(&mut device, "bundled", &loaded.scene);
    let hills = hills(30_000);
    compare_all(&mut device, "hills", &hills);
    // At eye level under a low sun, where the cascades differ most.
    for (azimuth, elevation) in [(100.0, 6.0), (250.0, 20.0)] {
        let day = clear_day(azimuth, elevation);
        let camera = camera([12.0, 10.0, 25.0], [-40.0, 4.0, -30.0]);
        compare(&mut device, "hills at eye level", &hills, &day, &camera);
    }
}

#[test]
fn nothing_is_missed_of_the_shared_scenes() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let mut device = Device::new();
    for model in SHARED {
        let path = shared.join("scenes").join(model);
        let scene = load(&path, &LoadOptions::default()).expect(model).scene;
        compare_all(&mut device, model, &scene);
    }
}

#[test]
fn maps_that_stay_miss_nothing_of_what_comes_into_view() {
    let mut device = Device::new();
    let scene = hills(100_000);
    let day = clear_day(100.0, 12.0);
    let from = |step: f32| {
        let (walk, (sin, cos)) = (0.2 * step, (0.06 * step).sin_cos());
        let eye = Vec3::new(12.0 - walk, 10.0, 25.0 + walk);
        camera(
            eye.to_array(),
            (eye - Vec3::new(50.0 * cos, 6.0, 50.0 * sin)).to_array(),
        )
    };
    let settings = showing(Show::Visibility, settings(320, 180));
    let mut walking = device.frame(&scene, settings, &day, &from(0.0));
    let mut shaded = 0;
    // Long and short steps alternate: maps are redrawn after the long ones and reused after the short ones.
    for step in (0..48).map(|i| (i / 2) as f32 + 0.05 * (i % 2) as f32) {
        let camera = from(step);
        device.draw(&mut walking, &day, &camera);
        let stayed = device.picture_of(&walking);
        let mut anew = device.frame(&scene, settings, &day, &camera);
        device.draw(&mut anew, &day, &camera);
        let anew = device.picture_of(&anew);
        shaded += anew.pixels().filter(|(_, v)| v.x < 0.5).count();
        let missed = differing(&stayed, &anew);
        assert!(missed == 0, "step {step}: {missed} pixels");
    }
    assert!(shaded > 48 * 1000, "{shaded} pixels in shadow");
}

/// Triangles submitted to the passes of this name in one frame.
fn triangles(device: &Device, scene: &Scene, day: &Daylight, camera: &Camera, name: &str) -> f64 {
    let mut recorder = Recorder::new(&device.context, Timing::Work).expect("a recorder");
    let settings = FrameSettings {
        size: UVec2::new(320, 180),
        ..settings(320, 180)
    };
    recorder.begin().expect("begun");
    let mut frame = Frame::new(&mut recorder, scene, settings).expect("a frame");
    recorder.finish().expect("finished");
    recorder.begin().expect("begun");
    frame.record(&mut recorder, day, camera, 0);
    recorder.finish().expect("finished");
    let passes = recorder.work().iter().filter(|pass| pass.name == name);
    let vertices = passes.map(|p| p.statistics.expect("a device that counts").vertices);
    vertices.sum::<u64>() as f64 / 3.0
}

/// Fraction of the triangles whose centroids are in view.
fn share_seen(scene: &Scene, camera: &Camera) -> f64 {
    let clip = camera.clip_from_view(16.0 / 9.0) * camera.view_from_world();
    let seen = scene.indices.chunks_exact(3).filter(|t| {
        let p: Vec3 = t
            .iter()
            .map(|i| Vec3::from(scene.positions[*i as usize]))
            .sum();
        let p = clip * (p / 3.0).extend(1.0);
        p.x.abs() <= p.w && p.y.abs() <= p.w
    });
    seen.count() as f64 / scene.triangles() as f64
}

#[test]
fn a_view_of_a_twentieth_draws_few_triangles() {
    let device = Device::new();
    let scene = hills(400_000);
    let all = scene.triangles() as f64;
    let whole = Camera::framing(&scene.bounds, 45.0, 16.0 / 9.0);
    assert!(share_seen(&scene, &whole) > 0.999);
    let lens = (1..450).map(|tenth| 0.1 * tenth as f32);
    let narrow = lens
        .map(|fov_deg| Camera { fov_deg, ..whole })
        .take_while(|camera| share_seen(&scene, camera) <= 0.05)
        .last()
        .expect("a narrow view");
    for (azimuth, elevation) in [(200.0, 40.0), (250.0, 25.0)] {
        let day = clear_day(azimuth, elevation);
        let of = |camera, name| triangles(&device, &scene, &day, camera, name) / all;
        let [gbuffer, shadow] = ["G-buffer", "shadow map"].map(|name| of(&narrow, name));
        let [gbuffer_all, shadow_all] = ["G-buffer", "shadow map"].map(|name| of(&whole, name));
        let share = (gbuffer + shadow) / (gbuffer_all + shadow_all);
        println!(
            "sun {elevation}: seeing {:.1} % of {all} triangles draws {:.1} % of them in the G-buffer (whole view {:.0} %) and \
             {:.1} % in the shadow map (whole view {:.0} %): {:.1} % of the whole view's",
            100.0 * share_seen(&scene, &narrow),
            100.0 * gbuffer,
            100.0 * gbuffer_all,
            100.0 * shadow,
            100.0 * shadow_all,
            100.0 * share
        );
        assert!(gbuffer < 0.08 && share < 0.2, "{gbuffer} {shadow} {share}");
    }
}
