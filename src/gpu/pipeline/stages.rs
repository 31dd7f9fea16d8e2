//! The stages of a pipeline while it is made: modules and specialization constants.

use std::sync::Arc;

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::error::{During, Result};
use crate::gpu::pipeline::shader::Shader;

/// Shader modules, alive while pipelines are made from them.
pub(in crate::gpu) struct Modules {
    context: Arc<Context>,
    pub(in crate::gpu) raw: Vec<vk::ShaderModule>,
}

impl Modules {
    pub(in crate::gpu) fn new(context: &Arc<Context>, stages: &[&'static Shader]) -> Result<Self> {
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
pub(in crate::gpu) struct Constants {
    entries: Vec<vk::SpecializationMapEntry>,
    data: Vec<u8>,
}

impl Constants {
    pub(in crate::gpu) fn new(shader: &Shader, values: &[(&str, u32)]) -> Self {
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

    pub(in crate::gpu) fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default()
            .map_entries(&self.entries)
            .data(&self.data)
    }
}
