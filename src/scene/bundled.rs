//! Scenes compiled into the program.

use std::path::Path;

use crate::scene::files::Files;
use crate::scene::load::load_from;
use crate::scene::{LoadOptions, Loaded, Progress, SceneError};

/// Embedded files by name. `examples/make_colonnade.rs` and `examples/make_island` generate the models.
static FILES: &[(&str, &[u8])] = &[
    (
        "colonnade.toml",
        include_bytes!("../../assets/colonnade.toml"),
    ),
    (
        "colonnade.obj",
        include_bytes!("../../assets/colonnade.obj"),
    ),
    (
        "colonnade.mtl",
        include_bytes!("../../assets/colonnade.mtl"),
    ),
    ("island.toml", include_bytes!("../../assets/island.toml")),
    ("island.glb", include_bytes!("../../assets/island.glb")),
];

/// Names of the bundled scenes; the first is the default.
pub const BUNDLED: [&str; 2] = ["colonnade", "island"];

/// The default scene: a small colonnade with steps, a pool and a low sun.
///
/// # Errors
/// When a limit in `options` is too low.
pub fn bundled(options: &LoadOptions) -> Result<Loaded, SceneError> {
    load_bundled(BUNDLED[0], options, &|_, _| ())
}

/// The bundled scene with this name, unless a file or folder of that name exists.
pub fn bundled_name(path: &Path) -> Option<&'static str> {
    let name = BUNDLED.into_iter().find(|name| path == Path::new(name))?;
    (!path.exists()).then_some(name)
}

pub(super) fn load_bundled(
    name: &str,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let file = Path::new(name).with_extension("toml");
    load_from(&mut Files::embedded(FILES), &file, options, progress)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_scene_is_valid() {
        let loaded = bundled(&LoadOptions::default()).expect("the bundled scene loads");
        assert_eq!(loaded.scene.warnings, Vec::<String>::new());
        assert!(
            (1_000..60_000).contains(&loaded.scene.triangles()),
            "{}",
            loaded.scene.triangles()
        );
        assert!(
            loaded.scene.materials.iter().any(|m| m.specular[0] > 0.0),
            "one material is glossy"
        );
        let camera = loaded.options.last().expect("a table");
        assert_eq!(camera.name, "camera");
        assert!(camera.options.iter().any(|(key, _)| key == "eye"));
        for (name, most) in [("colonnade", 3_000_000), ("island", 5_500_000)] {
            let files = FILES.iter().filter(|(file, _)| file.starts_with(name));
            let bytes: usize = files.map(|(_, bytes)| bytes.len()).sum();
            assert!(bytes < most, "{name}: {bytes} bytes");
        }
    }

    #[test]
    fn every_bundled_scene_loads_by_its_name() {
        for name in BUNDLED {
            assert_eq!(bundled_name(Path::new(name)), Some(name));
            let options = LoadOptions::default();
            let loaded = load_bundled(name, &options, &|_, _| ()).expect(name);
            assert_eq!(loaded.scene.warnings, Vec::<String>::new());
            assert_eq!(loaded.cameras.len(), 3, "{name}");
        }
        assert_eq!(bundled_name(Path::new("colonnade.toml")), None);
        // A folder of this name exists.
        assert_eq!(bundled_name(Path::new("src")), None);
    }
}
