//! The path-traced views of `shared/truth`, and OpenEXR files.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use exr::prelude::{ReadChannels as _, ReadLayers as _};
use serde_json::Value;
use skylight::scene::{self, Camera, LoadOptions, Scene};

/// An OpenEXR file: its channels by name, and its text attributes.
pub struct Exr {
    pub size: [usize; 2],
    pub channels: BTreeMap<String, Vec<f32>>,
    pub attributes: BTreeMap<String, String>,
}

impl Exr {
    /// Reads the first layer.
    pub fn read(path: &Path) -> Self {
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_file(path)
            .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let layer = image.layer_data;
        let channels = layer
            .channel_data
            .list
            .iter()
            .map(|c| {
                (
                    c.name.to_string(),
                    c.sample_data.values_as_f32().collect::<Vec<f32>>(),
                )
            })
            .collect();
        let text = |value: &exr::meta::attribute::AttributeValue| match value {
            exr::meta::attribute::AttributeValue::Text(text) => text.to_string(),
            other => format!("{other:?}"),
        };
        let attributes = layer
            .attributes
            .other
            .iter()
            .map(|(key, value)| (key.to_string(), text(value)))
            .collect();
        Self {
            size: [layer.size.x(), layer.size.y()],
            channels,
            attributes,
        }
    }

    /// A channel; it must exist.
    pub fn channel(&self, name: &str) -> &[f32] {
        let names = self.channels.keys();
        self.channels
            .get(name)
            .unwrap_or_else(|| panic!("no channel {name} among {names:?}"))
    }

    /// The only channel.
    pub fn single(&self) -> &[f32] {
        assert_eq!(self.channels.len(), 1, "{:?}", self.channels.keys());
        self.channels.values().next().expect("one")
    }
}

/// A view: a scene, its camera and the JSON file that describes it.
pub struct View {
    pub name: &'static str,
    pub scene: Scene,
    pub camera: Camera,
    pub json: Value,
    folder: PathBuf,
}

/// Names of the views.
pub const VIEWS: [&str; 5] = ["house", "house_low", "colonnade", "medieval", "teapot"];

impl View {
    /// Loads a view from the folder `shared`.
    pub fn load(shared: &Path, name: &'static str) -> Self {
        let folder = shared.join("truth");
        let path = folder.join(format!("{name}.json"));
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let json: Value = serde_json::from_str(&text).expect("JSON");
        let point = |key: &str| {
            let list = &json["camera"][key];
            glam::Vec3::from_array([0, 1, 2].map(|i| list[i].as_f64().expect("a number") as f32))
        };
        let camera = Camera {
            eye: point("origin"),
            target: point("target"),
            fov_deg: json["camera"]["vfov"].as_f64().expect("vfov") as f32,
            near: 0.05,
        };
        let scene = load_scene(&shared.join("scenes"), &json["objs"]);
        Self {
            name,
            scene,
            camera,
            json,
            folder,
        }
    }

    /// An .exr file of the view: `ao_1m`, `aov`, ...
    pub fn exr(&self, what: &str) -> Exr {
        Exr::read(&self.folder.join(format!("{}_{what}.exr", self.name)))
    }

    /// Whether a pixel and all its neighbours up to `distance` away show geometry.
    pub fn geometry(&self, distance: usize) -> Vec<bool> {
        let aov = self.exr("aov");
        let depth = aov.channel("depth.T");
        let [width, height] = aov.size;
        let inside = |x: usize, y: usize| {
            let (left, right) = (x.wrapping_sub(distance), x + distance);
            let (top, bottom) = (y.wrapping_sub(distance), y + distance);
            left < width
                && right < width
                && top < height
                && bottom < height
                && (top..=bottom).all(|v| (left..=right).all(|u| depth[v * width + u] > 0.0))
        };
        (0..width * height)
            .map(|i| inside(i % width, i / width))
            .collect()
    }
}

/// The text of a scene file with the view's models.
fn scene_file(scenes: &Path, models: &Value) -> String {
    let scenes = scenes.canonicalize().expect("shared/scenes");
    let mesh = |model: &Value| {
        let file = scenes.join(model["file"].as_str().expect("a file name"));
        format!("[[mesh]]\nfile = '{}'\n", file.display())
    };
    models.as_array().expect("objs").iter().map(mesh).collect()
}

fn load_scene(scenes: &Path, models: &Value) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("view.toml");
    std::fs::write(&path, scene_file(scenes, models)).expect("written");
    scene::load(&path, &LoadOptions::default())
        .unwrap_or_else(|e| panic!("{e}"))
        .scene
}

/// Camera, sun and sky of a view as options of `render`, at the reference's size. Ground light and specular reflection
/// are off: the reference has neither.
fn options(view: &Value) -> Vec<String> {
    let (sun, camera) = (&view["sun"], &view["camera"]);
    let words = |list: &Value| {
        let numbers = list.as_array().expect("a list").iter();
        numbers.map(Value::to_string).collect::<Vec<_>>().join(",")
    };
    vec![
        "--size=640x360".to_owned(),
        "--ground-albedo=0".to_owned(),
        "--specular=0".to_owned(),
        format!("--sun={},{}", sun["azimuth_deg"], sun["elevation_deg"]),
        "--sky=preetham".to_owned(),
        format!("--turbidity={}", view["turbidity"]),
        format!("--eye={}", words(&camera["origin"])),
        format!("--target={}", words(&camera["target"])),
        format!("--fov={}", camera["vfov"]),
    ]
}

/// Renders a view with the real executable; `further` options follow those of the view.
pub fn render(shared: &Path, view: &Value, further: &[&str]) -> Exr {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let (scene, output) = (folder.path().join("s.toml"), folder.path().join("a.exr"));
    let text = scene_file(&shared.join("scenes"), &view["objs"]);
    std::fs::write(&scene, text).expect("a scene file");
    let ended = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .args([Path::new("render"), &scene, Path::new("-o"), &output])
        .arg("--quiet")
        .args(options(view))
        .args(further)
        .output()
        .expect("the program starts");
    let complaint = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert!(ended.status.success(), "{complaint}");
    Exr::read(&output)
}
