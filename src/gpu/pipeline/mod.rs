//! Graphics and compute pipelines. Their layouts are derived from the interfaces of the shader stages.

pub(in crate::gpu) mod cache;
#[cfg(feature = "hot-reload")]
pub(in crate::gpu) mod hot_reload;
pub(in crate::gpu) mod kept;
pub(in crate::gpu) mod layout;
#[cfg(test)]
mod limits_tests;
pub(in crate::gpu) mod route;
pub(in crate::gpu) mod shader;
mod state;
#[cfg(test)]
mod uniform_branches_tests;

use std::sync::Arc;
use std::time::Instant;

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, Result};
use crate::gpu::pipeline::shader::{Binding, Constants, Field, Modules, Shader, Stage};

/// Depth test of a pipeline. Depth is reversed: 1 is nearest, 0 is infinitely far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Depth {
    /// No depth attachment.
    Off,
    /// Passes where a surface was drawn (depth is not 0); no depth writes. For full-screen triangles, whose depth is 0.
    Surface(vk::Format),
    /// Passes where no surface was drawn (depth is 0); no depth writes. For full-screen triangles.
    Background(vk::Format),
    /// Passes nearer (greater) fragments; no depth writes. For surfaces that let light through.
    Test(vk::Format),
    /// Passes nearer (greater) fragments and writes their depth.
    Write(vk::Format),
}

impl Depth {
    /// Format of the attachment.
    fn format(self) -> Option<vk::Format> {
        match self {
            Self::Off => None,
            Self::Surface(format)
            | Self::Background(format)
            | Self::Test(format)
            | Self::Write(format) => Some(format),
        }
    }

    fn is_written(self) -> bool {
        matches!(self, Self::Write(_))
    }
}

/// How fragments are combined with what is in the colour attachments. Half floats and bytes can be combined on every device, other
/// formats if [`Context::can_blend`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Blend {
    /// They replace it.
    #[default]
    Off,
    /// Products of all channels.
    Multiply,
    /// Sums of all channels.
    Add,
    /// Products of red, green and blue, and the largest alpha.
    MultiplyAndMost,
}

/// Description of a [`Pipeline`].
#[derive(Debug, Clone, Copy)]
pub struct PipelineDesc<'a> {
    /// Name shown in messages and captures.
    pub name: &'a str,
    /// A vertex stage with optional geometry and fragment stages, or a single compute stage.
    pub stages: &'a [&'static Shader],
    /// Vertex streams, one tightly packed stream per location.
    pub vertex: &'a [vk::Format],
    /// Formats of the colour attachments.
    pub colors: &'a [vk::Format],
    /// Depth test.
    pub depth: Depth,
    /// What happens to fragments.
    pub blend: Blend,
    /// Values of specialization constants by name, as raw 32-bit words.
    pub constants: &'a [(&'a str, u32)],
}

impl PipelineDesc<'_> {
    /// Whether it draws geometry, whose faces may be culled; full-screen triangles never are.
    fn culls(&self) -> bool {
        !self.vertex.is_empty()
    }
}

/// A binding and the stages that use it.
#[derive(Debug, Clone, Copy)]
pub(in crate::gpu) struct Slot {
    pub(in crate::gpu) binding: Binding,
    stages: vk::ShaderStageFlags,
}

/// A pipeline with its layout and interface. Pipelines of one description share what the driver made (`kept.rs`).
pub struct Pipeline {
    pub(in crate::gpu) made: Arc<Made>,
    name: String,
    /// Keeps the device open, which owns what was made.
    _context: Arc<Context>,
}

/// What the driver makes of a description, and its interface. The context owns the handles.
pub(in crate::gpu) struct Made {
    raw: vk::Pipeline,
    layout: vk::PipelineLayout,
    set_layout: vk::DescriptorSetLayout,
    pub(in crate::gpu) slots: Vec<Slot>,
    pub(in crate::gpu) push: Option<(&'static [Field], vk::ShaderStageFlags)>,
    pub(in crate::gpu) colors: Vec<vk::Format>,
    pub(in crate::gpu) depth: Option<vk::Format>,
    pub(in crate::gpu) streams: usize,
    pub(in crate::gpu) writes_depth: bool,
    /// Whether front face and culling are dynamic: for pipelines that draw geometry.
    pub(in crate::gpu) culls: bool,
    /// Work group size of a compute pipeline.
    pub(in crate::gpu) local_size: Option<[u32; 3]>,
}

/// Size of a push constant block, bytes.
fn block_size(fields: &[Field]) -> u32 {
    fields.iter().map(|f| f.offset + f.size).max().unwrap_or(0)
}

fn merge_slots(stages: &[&'static Shader]) -> Vec<Slot> {
    let mut slots: Vec<Slot> = Vec::new();
    for shader in stages {
        for binding in shader.bindings {
            let flags = shader.stage.flags();
            match slots
                .iter_mut()
                .find(|s| s.binding.binding == binding.binding)
            {
                Some(slot) => {
                    assert_eq!(
                        slot.binding, *binding,
                        "{}: binding declared twice",
                        shader.name
                    );
                    slot.stages |= flags;
                }
                None => slots.push(Slot {
                    binding: *binding,
                    stages: flags,
                }),
            }
        }
    }
    slots.sort_by_key(|s| s.binding.binding);
    slots
}

fn merge_push(stages: &[&'static Shader]) -> Option<(&'static [Field], vk::ShaderStageFlags)> {
    let mut merged: Option<(&'static [Field], vk::ShaderStageFlags)> = None;
    for shader in stages {
        let Some(fields) = shader.push else { continue };
        let flags = merged.map_or(vk::ShaderStageFlags::empty(), |m| m.1) | shader.stage.flags();
        if let Some((first, _)) = merged {
            assert_eq!(
                first, fields,
                "{}: push blocks of the stages differ",
                shader.name
            );
        }
        merged = Some((fields, flags));
    }
    merged
}

/// What fails, for messages.
const COMPILE: &str = "compile a pipeline";

/// Compares a description with the interfaces of its stages.
fn check(desc: &PipelineDesc<'_>) {
    for (name, _) in desc.constants {
        let declared = desc
            .stages
            .iter()
            .any(|s| s.constants.iter().any(|c| c.0 == *name));
        assert!(
            declared,
            "{}: no stage declares the constant {name}",
            desc.name
        );
    }
    for shader in desc.stages.iter().filter(|s| s.stage == Stage::Fragment) {
        let (outputs, targets) = (shader.outputs, desc.colors.len());
        assert_eq!(
            outputs, targets,
            "{}: outputs of {}",
            desc.name, shader.name
        );
    }
}

impl Pipeline {
    /// Creates a pipeline, or takes one of the same description that was made before.
    ///
    /// # Errors
    /// When the driver cannot create it.
    ///
    /// # Panics
    /// When the interfaces of the stages conflict, a constant is not declared by any stage, or the outputs of the fragment
    /// shader do not match the colour attachments. These are bugs in the program.
    pub fn new(context: &Arc<Context>, desc: &PipelineDesc<'_>) -> Result<Self> {
        check(desc);
        context.faults.at(Call::Pipeline).during(COMPILE)?;
        let make = || {
            let start = Instant::now();
            let made = Made::new(context, desc)?;
            context.name(made.raw, desc.name);
            context.startup.pipeline(desc.name, start);
            Ok(made)
        };
        Ok(Self {
            made: context.kept.find_or(context.freeing(), desc, make)?,
            name: desc.name.to_owned(),
            _context: context.clone(),
        })
    }

    /// Whether the other pipeline can be used in the same pass with the same bindings.
    pub(in crate::gpu) fn is_variant_of(&self, other: &Self) -> bool {
        let slots = self.made.slots.iter().map(|s| s.binding);
        slots.eq(other.made.slots.iter().map(|s| s.binding))
            && self.made.push == other.made.push
            && self.made.colors == other.made.colors
            && self.made.depth == other.made.depth
            && self.made.streams == other.made.streams
    }

    /// The name of the pipeline.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(in crate::gpu) fn bind_point(&self) -> vk::PipelineBindPoint {
        match self.made.local_size {
            Some(_) => vk::PipelineBindPoint::COMPUTE,
            None => vk::PipelineBindPoint::GRAPHICS,
        }
    }

    pub(in crate::gpu) fn raw(&self) -> vk::Pipeline {
        self.made.raw
    }

    pub(in crate::gpu) fn layout(&self) -> vk::PipelineLayout {
        self.made.layout
    }

    pub(in crate::gpu) fn set_layout(&self) -> vk::DescriptorSetLayout {
        self.made.set_layout
    }
}

impl Made {
    /// Makes a pipeline of a description.
    fn new(context: &Arc<Context>, desc: &PipelineDesc<'_>) -> Result<Self> {
        let mut made = Self {
            raw: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            slots: merge_slots(desc.stages),
            push: merge_push(desc.stages),
            colors: desc.colors.to_vec(),
            depth: desc.depth.format(),
            streams: desc.vertex.len(),
            writes_depth: desc.depth.is_written(),
            culls: desc.culls(),
            local_size: desc.stages.iter().find_map(|s| s.local_size),
        };
        match made.fill(context, desc) {
            Ok(()) => Ok(made),
            Err(error) => {
                made.destroy(context.raw());
                Err(error)
            }
        }
    }

    fn fill(&mut self, context: &Arc<Context>, desc: &PipelineDesc<'_>) -> Result<()> {
        self.set_layout = self.create_set_layout(context)?;
        self.layout = self.create_layout(context)?;
        let modules = Modules::new(context, desc.stages)?;
        self.raw = self.create(context, desc, &modules)?;
        Ok(())
    }

    /// Destroys the handles, which nothing may use any more.
    fn destroy(&self, device: &ash::Device) {
        // SAFETY: the caller promises it; null handles are ignored.
        unsafe {
            device.destroy_pipeline(self.raw, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }

    fn create_set_layout(&self, context: &Context) -> Result<vk::DescriptorSetLayout> {
        let bindings: Vec<_> = self
            .slots
            .iter()
            .map(|slot| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(slot.binding.binding)
                    .descriptor_type(slot.binding.kind.descriptor())
                    .descriptor_count(1)
                    .stage_flags(slot.stages)
            })
            .collect();
        let flags = if context.extensions.push_descriptor.is_some() {
            vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR
        } else {
            vk::DescriptorSetLayoutCreateFlags::empty()
        };
        let info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(flags)
            .bindings(&bindings);
        // SAFETY: `bindings` outlives the call.
        unsafe { context.raw().create_descriptor_set_layout(&info, None) }
            .during("create a descriptor set layout")
    }

    fn create_layout(&self, context: &Context) -> Result<vk::PipelineLayout> {
        let ranges: Vec<_> = self
            .push
            .iter()
            .map(|(fields, stages)| {
                vk::PushConstantRange::default()
                    .stage_flags(*stages)
                    .size(block_size(fields))
            })
            .collect();
        let sets = [self.set_layout];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&sets)
            .push_constant_ranges(&ranges);
        // SAFETY: the arrays outlive the call.
        unsafe { context.raw().create_pipeline_layout(&info, None) }
            .during("create a pipeline layout")
    }

    fn create(
        &self,
        context: &Context,
        desc: &PipelineDesc<'_>,
        modules: &Modules,
    ) -> Result<vk::Pipeline> {
        let values = [desc.constants, &context.constants()].concat();
        let constants: Vec<Constants> = desc
            .stages
            .iter()
            .map(|s| Constants::new(s, &values))
            .collect();
        let specializations: Vec<_> = constants.iter().map(Constants::info).collect();
        let stages: Vec<_> = desc
            .stages
            .iter()
            .zip(&modules.raw)
            .zip(&specializations)
            .map(|((shader, module), specialization)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(shader.stage.flags())
                    .module(*module)
                    .name(c"main")
                    .specialization_info(specialization)
            })
            .collect();
        let created = match (stages.as_slice(), self.local_size) {
            ([stage], Some(_)) => state::compute(context, self.layout, *stage),
            _ => state::graphics(context, self.layout, &stages, desc),
        };
        created.during(COMPILE)
    }
}
