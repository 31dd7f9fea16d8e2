//! Other devices, pretended by a Vulkan layer between the validation layer and the driver; the layer is built with the C compiler.
#![allow(dead_code)]

use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use crate::common::shared;

/// Where systems keep layers.
const SYSTEM: &str = "/usr/local/share/vulkan/explicit_layer.d:/usr/share/vulkan/explicit_layer.d:/etc/vulkan/explicit_layer.d";

/// Name of the layer in manifests.
const NAME: &str = "VK_LAYER_FAKE_device";

/// Writes the manifest of a built layer beside it. The layer is one of the program's environment, not one that it asks for.
pub fn write_manifest(library: &Path) {
    let text = format!(
        r#"{{"file_format_version": "1.2.0", "layer": {{"name": "{NAME}", "type": "GLOBAL", "library_path": "{}",
        "api_version": "1.3.0", "implementation_version": "1", "description": "pretences"}}}}"#,
        library.display()
    );
    let manifest = library.with_file_name("VkLayer_pretence.json");
    fs::write(manifest, text).expect("written");
}

/// The environment of a program with the layer in this folder, between the validation layer and the driver.
pub fn layer_in(folder: &Path) -> [(&'static str, OsString); 2] {
    let layers = format!("VK_LAYER_KHRONOS_validation:{NAME}");
    // Older loaders order layers by the folders, the application's side first; newer ones by the list.
    let mut folders = std::env::var_os("VK_LAYER_PATH").unwrap_or_else(|| SYSTEM.into());
    folders.push(":");
    folders.push(folder);
    [
        ("VK_LAYER_PATH", folders),
        ("VK_INSTANCE_LAYERS", layers.into()),
    ]
}

/// The built layer.
pub struct Layer {
    folder: tempfile::TempDir,
}

impl Layer {
    /// Builds it once; `None` if there are no sources, see [`shared`].
    pub fn get() -> Option<&'static Self> {
        static LAYER: OnceLock<Option<Layer>> = OnceLock::new();
        LAYER.get_or_init(Self::built).as_ref()
    }

    fn built() -> Option<Self> {
        let source = shared()?.join("gpu/fake_device/fake.c");
        let folder = tempfile::tempdir().expect("a folder");
        let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/common/pretended.c");
        let library = folder.path().join("libpretence.so");
        let output = Command::new("cc")
            .args(["-shared", "-fPIC", "-O1", "-w"])
            .arg(format!("-DPRETENCE=\"{}\"", source.display()))
            .arg("-o")
            .arg(&library)
            .arg(own)
            .output()
            .expect("a C compiler: run scripts/setup");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "the layer does not compile; run scripts/setup: {said}"
        );
        write_manifest(&library);
        Some(Self { folder })
    }

    /// The environment of a program that sees the device of these words, see `shared/gpu/fake_device` and `pretended.c`.
    pub fn variables(&self, words: &str) -> [(&'static str, OsString); 3] {
        let [path, layers] = layer_in(self.folder.path());
        [path, layers, ("FAKE", words.into())]
    }
}
