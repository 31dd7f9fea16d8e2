//! The scenes that are built into the program.

use std::path::Path;

use crate::scene::files::Files;
use crate::scene::{LoadOptions, Loaded, Progress, SceneError, load_from};

/// Their files; `examples/make_colonnade.rs` and `examples/make_island` make the models.
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

/// By which names they are asked for; the first is shown when none is.
pub const BUNDLED: [&str; 2] = ["colonnade", "island"];

/// The scene that is shown when none is asked for: a small colonnade with steps, a pool and a low sun. It needs no file on the disk.
///
/// # Errors
/// None with the files of the project; a test loads it.
pub fn bundled(options: &LoadOptions) -> Result<Loaded, SceneError> {
    load_bundled(BUNDLED[0], options, &|_, _| ())
}

/// The bundled scene that a path asks for: one of [`BUNDLED`], where nothing on the disk is called so.
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
    fn the_bundled_scene_is_sound() {
        let loaded = bundled(&LoadOptions::default()).expect("the bundled scene loads");
        assert_eq!(loaded.scene.warnings, Vec::<String>::new());
        assert!(
            (1_000..60_000).contains(&loaded.scene.triangles()),
            "{}",
            loaded.scene.triangles()
        );
        assert!(
            loaded.scene.materials.iter().any(|m| m.specular[0] > 0.0),
            "something glossy mirrors the sky"
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
        // This folder is there.
        assert_eq!(bundled_name(Path::new("src")), None);
    }
}
