//! The path-traced views of `shared/truth`, and OpenEXR files.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

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

    /// A channel that must be there.
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

/// One view: a scene, its camera, and where its sun stands.
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
    /// Loads a view of the folder `shared`.
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

    /// A file of the view: `ao_1m`, `aov`, ..
    pub fn exr(&self, what: &str) -> Exr {
        Exr::read(&self.folder.join(format!("{}_{what}.exr", self.name)))
    }

    /// Whether each pixel and those up to `distance` around it show geometry.
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

fn load_scene(scenes: &Path, models: &Value) -> Scene {
    let scenes = scenes.canonicalize().expect("shared/scenes");
    let mesh = |model: &Value| {
        let file = scenes.join(model["file"].as_str().expect("a file name"));
        format!("[[mesh]]\nfile = '{}'\n", file.display())
    };
    let text: String = models.as_array().expect("objs").iter().map(mesh).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("view.toml");
    std::fs::write(&path, text).expect("written");
    scene::load(&path, &LoadOptions::default())
        .unwrap_or_else(|e| panic!("{e}"))
        .scene
}
