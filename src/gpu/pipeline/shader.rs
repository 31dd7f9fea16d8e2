//! A compiled stage and what it declares.

use ash::vk;

/// A stage of the pipeline.
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

/// Kind of a descriptor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindingKind {
    /// `sampler2D`, `samplerCube` and the like.
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

/// A member of a block, bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name in the source.
    pub name: &'static str,
    /// Offset in bytes.
    pub offset: u32,
    /// Size in bytes.
    pub size: u32,
}

/// A declared descriptor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Binding {
    /// Name of the variable.
    pub name: &'static str,
    /// Its number.
    pub binding: u32,
    /// Its kind.
    pub kind: BindingKind,
    /// Members, of a uniform block.
    pub fields: &'static [Field],
}

/// A compiled stage: the words and its declarations, read from the SPIR-V by build.rs.
#[derive(Debug)]
pub struct Shader {
    /// Path below `shaders_glsl/`, and the macros of a variant: `gbuffer.frag+ALBEDO`.
    pub name: &'static str,
    /// Stage.
    pub stage: Stage,
    /// Descriptors.
    pub bindings: &'static [Binding],
    /// Members of the push constant block.
    pub push: Option<&'static [Field]>,
    /// Specialization constants: name and id.
    pub constants: &'static [(&'static str, u32)],
    /// Outputs that have a location: of a fragment shader the colour attachments that it writes.
    pub outputs: usize,
    /// Invocations of a work group in x, y and z, of a compute shader.
    pub local_size: Option<[u32; 3]>,
    /// SPIR-V.
    pub words: &'static [u32],
    /// The declarations as build.rs wrote them, to compare those of a reloaded stage with.
    #[cfg(feature = "hot-reload")]
    pub declared: &'static str,
}

impl Shader {
    /// Members of the uniform block of this name, or of the push constants (`push`).
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

/// `a == b`, at compile time.
pub(in crate::gpu) const fn text_equals(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// The stages compiled from `shaders_glsl/` by build.rs.
#[allow(missing_docs)]
pub mod compiled {
    use super::{Binding, BindingKind, Field, Shader, Stage};

    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}
