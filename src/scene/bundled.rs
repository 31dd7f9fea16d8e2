//! The scene that is built into the program.

use std::path::Path;

use super::files::Files;
use super::{LoadOptions, Loaded, Progress, SceneError, load_from};

/// The files of the bundled scene; `examples/make_colonnade.rs` makes the model.
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
];

/// The bundled scene: a small colonnade with steps, a pool and a low sun. It needs no file on the disk.
///
/// # Errors
/// None with the files of the project; a test loads it.
pub fn bundled(options: &LoadOptions) -> Result<Loaded, SceneError> {
    load_bundled(options, &|_, _| ())
}

pub(super) fn load_bundled(
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    load_from(
        &mut Files::embedded(FILES),
        Path::new("colonnade.toml"),
        options,
        progress,
    )
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
        assert!(loaded.options.iter().any(|(key, _)| key == "eye"));
        let bytes: usize = FILES.iter().map(|(_, bytes)| bytes.len()).sum();
        assert!(bytes < 3_000_000, "{bytes} bytes");
    }
}
