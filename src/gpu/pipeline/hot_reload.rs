//! Hot reload of shaders during development.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use shaderc::Compiler;

use crate::gpu::device::context::Context;
use crate::gpu::error::{GpuError, Result};
use crate::gpu::pipeline::shader::{Shader, compiled};
use crate::gpu::shader_build::{compile, declarations};

/// Environment variable for the shader source folder. Default: the checkout of the build.
const FOLDER: &str = "SKYLIGHT_SHADERS";

/// Reloaded stages by name.
#[derive(Default)]
pub(in crate::gpu) struct Reloaded(Mutex<HashMap<&'static str, Arc<[u32]>>>);

impl Reloaded {
    /// The reloaded SPIR-V words of a stage, if any.
    pub(in crate::gpu) fn words(&self, shader: &Shader) -> Option<Arc<[u32]>> {
        self.stages().get(shader.name).cloned()
    }

    fn stages(&self) -> std::sync::MutexGuard<'_, HashMap<&'static str, Arc<[u32]>>> {
        // The map is replaced as a whole, so it stays valid after a panic.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Context {
    /// Recompiles every stage from source, for pipelines created from now on. Returns the number of changed stages.
    ///
    /// # Errors
    /// The compiler's messages, or the stages whose interface differs from the one at build time. Nothing is changed in that
    /// case.
    pub fn reload_shaders(&self) -> Result<usize> {
        let checkout = || Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders_glsl");
        let folder = std::env::var_os(FOLDER).map_or_else(checkout, PathBuf::from);
        let compiler = Compiler::new().map_err(|e| GpuError::Shaders(e.to_string()))?;
        let mut stages = HashMap::new();
        let mut faults = Vec::new();
        for shader in compiled::ALL {
            match reload(&compiler, &folder, shader) {
                Ok(words) => {
                    stages.insert(shader.name, Arc::from(words));
                }
                Err(fault) => faults.push(fault.trim_end().to_owned()),
            }
        }
        if !faults.is_empty() {
            return Err(GpuError::Shaders(faults.join("\n")));
        }
        let mut old = self.reloaded.stages();
        let changed = compiled::ALL
            .iter()
            .filter(|s| old.get(s.name).map_or(s.words, |w| w) != &*stages[s.name]);
        let changed = changed.count();
        *old = stages;
        self.kept.forget();
        Ok(changed)
    }
}

fn reload(
    compiler: &Compiler,
    folder: &Path,
    shader: &Shader,
) -> std::result::Result<Vec<u32>, String> {
    let named = compile(compiler, folder, shader.name, true)?;
    if declarations(shader.name, &named)? != shader.declared {
        return Err(format!(
            "{} declares other inputs than the program was built with; build it again",
            folder.join(shader.name).display()
        ));
    }
    if cfg!(debug_assertions) {
        return Ok(named);
    }
    compile(compiler, folder, shader.name, false)
}
