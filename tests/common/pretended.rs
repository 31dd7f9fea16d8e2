//! Other devices, pretended by a Vulkan layer between the validation layer and the driver; the layer is built with the C compiler.
#![allow(dead_code)]

use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use crate::common::shared;

/// The layer's manifest. The layer is one of the program's environment, not one that it asks for.
const MANIFEST: &str = r#"{"file_format_version": "1.2.0", "layer": {"name": "VK_LAYER_FAKE_device", "type": "GLOBAL",
"library_path": "./libpretence.so", "api_version": "1.3.0", "implementation_version": "1", "description": "pretended limits"}}"#;

/// Where systems keep layers.
const SYSTEM: &str = "/usr/local/share/vulkan/explicit_layer.d:/usr/share/vulkan/explicit_layer.d:/etc/vulkan/explicit_layer.d";

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
        let output = Command::new("cc")
            .args(["-shared", "-fPIC", "-O1", "-w"])
            .arg(format!("-DPRETENCE=\"{}\"", source.display()))
            .arg("-o")
            .arg(folder.path().join("libpretence.so"))
            .arg(own)
            .output()
            .expect("a C compiler: run scripts/setup");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "the layer does not compile; run scripts/setup: {said}"
        );
        fs::write(folder.path().join("VkLayer_pretence.json"), MANIFEST).expect("written");
        Some(Self { folder })
    }

    /// The environment of a program that sees the device of these words, see `shared/gpu/fake_device` and `pretended.c`.
    pub fn variables(&self, words: &str) -> [(&'static str, OsString); 3] {
        let layers = "VK_LAYER_KHRONOS_validation:VK_LAYER_FAKE_device";
        // Older loaders order layers by the folders, the application's side first; newer ones by the list.
        let mut folders = std::env::var_os("VK_LAYER_PATH").unwrap_or_else(|| SYSTEM.into());
        folders.push(":");
        folders.push(self.folder.path());
        [
            ("VK_LAYER_PATH", folders),
            ("VK_INSTANCE_LAYERS", layers.into()),
            ("FAKE", words.into()),
        ]
    }
}
