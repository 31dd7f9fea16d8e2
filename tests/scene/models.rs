//! Models by other authors, drawn by a whole frame under the validation layer.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::UVec2;
use skylight::daylight::{Conditions, Daylight};
use skylight::frame::{Frame, FrameSettings};
use skylight::gpu::{Context, ContextOptions, Recorder, Timing, read_back};
use skylight::passes::bounces::cells::Bounces;
use skylight::passes::light::lighting::{Ambient, Precision, Show};
use skylight::scene::{Camera, LoadOptions, Scene, load};

use crate::support::files_below;

const SIZE: UVec2 = UVec2::new(160, 90);

/// Models that must be drawn, besides all of Kenney's.
const MODELS: [&str; 13] = [
    "house/house.obj",
    "colonnade/colonnade.obj",
    "medieval_building/Medieval_building.obj",
    "stanford_bunny/stanford-bunny.obj",
    "spot/spot_triangulated.obj",
    "gltf_small/2CylinderEngine-glTF-Binary/2CylinderEngine.glb",
    "gltf_small/AlphaBlendModeTest.glb",
    "gltf_small/BoxInterleaved.glb",
    "gltf_small/BoxTextured-glTF/BoxTextured.gltf",
    "gltf_small/BoxTextured-glTF-Embedded/BoxTextured.gltf",
    "gltf_small/CesiumMilkTruck.glb",
    "gltf_small/Duck.glb",
    "gltf_small/no_indices_3storybuilding.glb",
];
const KENNEY: &str = "kenney_suburb/OBJ format";
const KENNEY_COUNT: usize = 49;

fn settings() -> FrameSettings {
    // Direct light: the passes of the bounces would be compiled again for every model.
    let mut set = FrameSettings {
        size: SIZE,
        shadow_resolution: 1024,
        bounces: Bounces::UpTo(0),
        ..FrameSettings::default()
    };
    set.lighting.ambient = Ambient::Ssao;
    set.irradiance.samples = 64;
    set.irradiance.samples_per_pass = 64;
    set.lighting.precision = Precision::Float;
    set
}

/// Radiance (kcd/m²), albedo and depth of a scene, seen from its default camera.
fn pictures(context: &Arc<Context>, scene: &Scene) -> [Vec<[f32; 4]>; 3] {
    let aspect = SIZE.x as f32 / SIZE.y as f32;
    let camera = Camera::from_parts(None, None, None, &scene.bounds.into(), aspect);
    let daylight = Daylight::new(&Conditions::default());
    let mut recorder = Recorder::new(context, Timing::Off).expect("a recorder");
    recorder.begin().expect("recording");
    let mut frame = Frame::new(&mut recorder, scene, settings()).expect("a frame");
    recorder.finish().expect("uploaded");
    [Show::Beauty, Show::Albedo, Show::Depth].map(|show| {
        frame.show(show).expect("shown");
        recorder.begin().expect("recording");
        frame.record(&mut recorder, &daylight, &camera, 0);
        recorder.finish().expect("drawn");
        let pixels = read_back(&mut recorder, frame.radiance()).expect("read");
        pixels.rgba()
    })
}

fn kenney(scenes: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(scenes.join(KENNEY)).expect("Kenney's folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut models: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "obj"))
        .collect();
    models.sort();
    assert!(
        models.len() >= KENNEY_COUNT,
        "only {} models are here",
        models.len()
    );
    models
}

/// A description of what is wrong with a model's pictures; `None` if they are plausible.
fn wrong(scene: &Scene, [beauty, albedo, depth]: &[Vec<[f32; 4]>; 3]) -> Option<String> {
    let seen: Vec<usize> = (0..depth.len()).filter(|i| depth[*i][0] > 0.0).collect();
    let share = seen.len() as f64 / depth.len() as f64;
    // The default view frames the model: it covers part of the picture (little for paths and lamps), never all of it.
    if !(0.01..0.999).contains(&share) {
        return Some(format!("covers {share:.3} of the picture"));
    }
    if beauty.iter().flatten().any(|v| !v.is_finite() || *v < 0.0) {
        return Some("has pixels that are negative or not finite".to_owned());
    }
    let dark = seen.iter().filter(|i| beauty[**i][..3] == [0.0; 3]).count();
    if dark * 20 > seen.len() {
        return Some(format!("{dark} of {} pixels are black", seen.len()));
    }
    let quantised = |i: &usize| albedo[*i].map(|v| (v * 64.0) as u32);
    let colours: HashSet<[u32; 4]> = seen.iter().map(quantised).collect();
    // All texture coordinates may point to one colour of a palette.
    let spread = scene.texcoords.iter().any(|t| *t != scene.texcoords[0]);
    let textured = spread && scene.materials.iter().any(|m| m.diffuse_texture.is_some());
    println!("{:5.1} % | {} albedos", 100.0 * share, colours.len());
    (textured && colours.len() < 3).then(|| format!("has {} albedos", colours.len()))
}

fn context() -> Arc<Context> {
    Context::new(&ContextOptions {
        device: std::env::var("SKYLIGHT_TEST_DEVICE").ok(),
        validate: true,
        ..ContextOptions::default()
    })
    .expect("a device and the validation layer")
}

/// Draws a model. Returns a row of the table and whether the model is drawn, or what is wrong.
fn row(context: &Arc<Context>, path: &Path) -> Result<(String, bool), String> {
    let scene = match load(path, &LoadOptions::default()) {
        Ok(loaded) => loaded.scene,
        Err(error) => {
            let line = error.to_string();
            let name = path.file_name().expect("a name").to_string_lossy();
            let is_right = line.lines().count() == 1 && line.contains(&*name);
            let said = line.replace(&path.display().to_string(), &name);
            return if is_right {
                Ok((format!("refused | {said}"), false))
            } else {
                Err(format!("refused with {line:?}"))
            };
        }
    };
    let [beauty, _, depth] = pictures(context, &scene);
    let seen = depth.iter().filter(|texel| texel[0] > 0.0).count();
    // Panes of glass have no depth.
    let is_glass = scene.materials.iter().all(|m| m.glass.is_some());
    if (seen == 0 && !is_glass) || beauty.iter().flatten().any(|v| !v.is_finite() || *v < 0.0) {
        return Err(format!(
            "{seen} pixels covered, or pixels that are negative or not finite"
        ));
    }
    if !context.validation_messages().is_empty() {
        return Err(format!("{:?}", context.validation_messages()));
    }
    let warnings = scene.warnings.len();
    let said = scene
        .warnings
        .first()
        .map_or(String::new(), |w| format!(": {w}"));
    Ok((
        format!(
            "{} triangles | {warnings} warnings{said}",
            scene.triangles()
        ),
        true,
    ))
}

#[test]
fn every_file_is_drawn_or_fails_with_one_line() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let scenes = shared.join("scenes");
    let paths = files_below(&scenes, &["obj", "gltf", "glb", "toml"]);
    let context = context();
    let (mut folders, mut failures) = (BTreeMap::new(), Vec::new());
    for path in &paths {
        let inside = path.strip_prefix(&scenes).expect("below");
        match row(&context, path) {
            Ok((row, drawn)) => {
                println!("| {} | {row} |", inside.display());
                let folder = inside.components().next().expect("a folder").as_os_str();
                let counts: &mut [usize; 2] = folders.entry(folder.to_owned()).or_default();
                counts[usize::from(!drawn)] += 1;
            }
            Err(what) => failures.push(format!("{}: {what}", inside.display())),
        }
    }
    println!("| folder | drawn | refused |");
    for (folder, [drawn, refused]) in &folders {
        println!("| {} | {drawn} | {refused} |", folder.display());
    }
    let drawn: usize = folders.values().map(|counts| counts[0]).sum();
    assert!(
        failures.is_empty() && drawn >= 130,
        "{drawn} drawn: {failures:#?}"
    );
}

#[test]
fn every_real_model_is_drawn() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let scenes = shared.join("scenes");
    let context = context();
    let named = MODELS.iter().map(|name| scenes.join(name));
    let mut failures = Vec::new();
    for path in named.chain(kenney(&scenes)) {
        let name = path.strip_prefix(&scenes).expect("below").display();
        let scene = load(&path, &LoadOptions::default()).expect("a model").scene;
        print!("{name} | {} triangles | ", scene.triangles());
        let harmless = |w: &String| w.contains("triangles without area");
        assert!(scene.warnings.iter().all(harmless), "{:?}", scene.warnings);
        if let Some(what) = wrong(&scene, &pictures(&context, &scene)) {
            failures.push(format!("{name} {what}"));
        }
        assert_eq!(
            context.validation_messages(),
            Vec::<String>::new(),
            "{name}"
        );
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
