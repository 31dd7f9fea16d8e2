//! Compiled shader stages: interfaces, modules and specialization constants.

use std::sync::Arc;

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::error::{During, Result};

/// A shader stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Vertex shader.
    Vertex,
    /// Geometry shader.
    Geometry,
    /// Fragment shader.
    Fragment,
    /// Compute shader.
    Compute,
}

impl Stage {
    pub(in crate::gpu) const fn flags(self) -> vk::ShaderStageFlags {
        match self {
            Self::Vertex => vk::ShaderStageFlags::VERTEX,
            Self::Geometry => vk::ShaderStageFlags::GEOMETRY,
            Self::Fragment => vk::ShaderStageFlags::FRAGMENT,
            Self::Compute => vk::ShaderStageFlags::COMPUTE,
        }
    }
}

/// Descriptor type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindingKind {
    /// `sampler2D`, `samplerCube` etc.
    SampledImage,
    /// `image2D`.
    StorageImage,
    /// `uniform` block.
    UniformBuffer,
    /// `buffer` block.
    StorageBuffer,
}

impl BindingKind {
    pub(in crate::gpu) const fn descriptor(self) -> vk::DescriptorType {
        match self {
            Self::SampledImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            Self::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            Self::UniformBuffer => vk::DescriptorType::UNIFORM_BUFFER,
            Self::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        }
    }
}

/// A member of a shader block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name in the source.
    pub name: &'static str,
    /// Offset in bytes.
    pub offset: u32,
    /// Size in bytes.
    pub size: u32,
}

/// A descriptor declared by a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Binding {
    /// Name of the variable in the source.
    pub name: &'static str,
    /// Binding number.
    pub binding: u32,
    /// Descriptor type.
    pub kind: BindingKind,
    /// Members of a uniform block; empty for other types.
    pub fields: &'static [Field],
}

/// A compiled stage and its interface, which build.rs reads from the SPIR-V.
#[derive(Debug)]
pub struct Shader {
    /// Path relative to `shaders_glsl/`, plus the macros of a variant: `gbuffer.frag+ALBEDO`.
    pub name: &'static str,
    /// The shader stage.
    pub stage: Stage,
    /// Declared descriptors.
    pub bindings: &'static [Binding],
    /// Members of the push constant block, if any.
    pub push: Option<&'static [Field]>,
    /// Specialization constants: name and ID.
    pub constants: &'static [(&'static str, u32)],
    /// Number of outputs with a location. For a fragment shader, the colour attachments it writes.
    pub outputs: usize,
    /// Work group size in x, y and z of a compute shader.
    pub local_size: Option<[u32; 3]>,
    /// SPIR-V words.
    pub words: &'static [u32],
    /// The interface as written by build.rs, to compare with a reloaded stage.
    #[cfg(feature = "hot-reload")]
    pub declared: &'static str,
}

impl Shader {
    /// A stage of your own, compiled to SPIR-V, with an empty interface. State what it declares:
    /// `Shader { bindings: .., outputs: 1, ..Shader::new(..) }`; what differs from the code is undefined behaviour of the device.
    pub const fn new(name: &'static str, stage: Stage, words: &'static [u32]) -> Self {
        Self {
            name,
            stage,
            bindings: &[],
            push: None,
            constants: &[],
            outputs: 0,
            local_size: None,
            words,
            #[cfg(feature = "hot-reload")]
            declared: "",
        }
    }

    /// Members of the uniform block with this name, or of the push constants (`push`).
    pub const fn block(&self, name: &str) -> Option<&'static [Field]> {
        if text_equals(name, "push") {
            return self.push;
        }
        let mut i = 0;
        while i < self.bindings.len() {
            if text_equals(self.bindings[i].name, name) {
                return Some(self.bindings[i].fields);
            }
            i += 1;
        }
        None
    }
}

/// `a == b`, usable at compile time.
pub(in crate::gpu) const fn text_equals(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// Shader modules, kept alive while pipelines are created from them.
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
            // SAFETY: the words are SPIR-V from shaderc.
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

/// The stages that build.rs compiles from `shaders_glsl/`.
#[allow(missing_docs)]
pub mod compiled {
    use super::{Binding, BindingKind, Field, Shader, Stage};

    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}
