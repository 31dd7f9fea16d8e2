//! The stages of a pipeline while it is made: modules and specialization constants.

use std::sync::Arc;

use ash::vk;

use super::context::Context;
use super::error::{During, Result};
use super::shader::Shader;

/// Shader modules, alive while pipelines are made from them.
pub(super) struct Modules {
    context: Arc<Context>,
    pub(super) raw: Vec<vk::ShaderModule>,
}

impl Modules {
    pub(super) fn new(context: &Arc<Context>, stages: &[&'static Shader]) -> Result<Self> {
        let mut modules = Self {
            context: context.clone(),
            raw: Vec::new(),
        };
        for shader in stages {
            #[cfg(feature = "hot-reload")]
            let reloaded = context.reloaded.words(shader);
            #[cfg(feature = "hot-reload")]
            let words = reloaded.as_deref().unwrap_or(shader.words);
            #[cfg(not(feature = "hot-reload"))]
            let words = shader.words;
            let info = vk::ShaderModuleCreateInfo::default().code(words);
            // SAFETY: the words come from shaderc.
            let module = unsafe { context.raw().create_shader_module(&info, None) }
                .during("load a shader")?;
            modules.raw.push(module);
            context.name(module, shader.name);
        }
        Ok(modules)
    }
}

impl Drop for Modules {
    fn drop(&mut self) {
        for module in &self.raw {
            // SAFETY: pipelines keep no reference to modules.
            unsafe { self.context.raw().destroy_shader_module(*module, None) };
        }
    }
}

/// The specialization constants of one stage.
pub(super) struct Constants {
    entries: Vec<vk::SpecializationMapEntry>,
    data: Vec<u8>,
}

impl Constants {
    pub(super) fn new(shader: &Shader, values: &[(&str, u32)]) -> Self {
        let mut this = Self {
            entries: Vec::new(),
            data: Vec::new(),
        };
        for (name, id) in shader.constants {
            let Some((_, bits)) = values.iter().find(|v| v.0 == *name) else {
                continue;
            };
            this.entries.push(vk::SpecializationMapEntry {
                constant_id: *id,
                offset: this.data.len() as u32,
                size: 4,
            });
            this.data.extend_from_slice(&bits.to_ne_bytes());
        }
        this
    }

    pub(super) fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default()
            .map_entries(&self.entries)
            .data(&self.data)
    }
}
