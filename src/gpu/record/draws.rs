//! Draws of a pass.

use arrayvec::ArrayVec;
use ash::vk;

use crate::gpu::memory::buffer::Buffer;
use crate::gpu::memory::image::{Image, Sampler};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::pipeline::layout::GpuStruct;
use crate::gpu::record::access::ImageAccess;
use crate::gpu::record::pass::Pass;
use crate::gpu::record::work::{texel_bytes, texels};

/// Winding of triangles in framebuffer coordinates (y down).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Winding {
    /// Counter-clockwise.
    #[default]
    CounterClockwise,
    /// Clockwise.
    Clockwise,
}

/// Front face and back-face culling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Faces {
    /// Winding of front faces.
    pub front: Winding,
    /// Whether back faces are culled.
    pub fronts_only: bool,
}

impl Faces {
    pub(in crate::gpu) fn state(self) -> (vk::CullModeFlags, vk::FrontFace) {
        let cull = if self.fronts_only {
            vk::CullModeFlags::BACK
        } else {
            vk::CullModeFlags::NONE
        };
        let front = match self.front {
            Winding::CounterClockwise => vk::FrontFace::COUNTER_CLOCKWISE,
            Winding::Clockwise => vk::FrontFace::CLOCKWISE,
        };
        (cull, front)
    }
}

/// Draws of a pass.
pub struct Draws<'p, 'r> {
    pub(in crate::gpu) pass: &'p mut Pass<'r>,
}

impl<'r> Draws<'_, 'r> {
    /// Binds a texture for the following draws. The barrier it needs was recorded with its upload.
    ///
    /// # Panics
    /// When the last access of the image is not [`ImageAccess::Sampled`].
    pub fn texture(&mut self, name: &str, image: &Image, sampler: Sampler) {
        assert_eq!(
            image.last_access(),
            ImageAccess::Sampled,
            "{} was not uploaded",
            image.name()
        );
        self.pass.buffer_bytes += texels(image) * texel_bytes(image.format());
        self.pass.bind_image(name, image, sampler);
    }

    /// Switches to a pipeline with the same bindings, attachments and vertex streams.
    ///
    /// # Panics
    /// When these differ.
    pub fn pipeline(&mut self, pipeline: &'r Pipeline) {
        assert!(
            pipeline.is_variant_of(self.pass.pipeline),
            "pass {}",
            self.pass.name
        );
        self.pass.pipeline = pipeline;
        self.pass.changed = true;
        let (raw, command) = (self.pass.recorder.context.raw(), self.pass.recorder.command);
        // SAFETY: the command buffer is inside the rendering of this pass.
        unsafe {
            raw.cmd_bind_pipeline(command, vk::PipelineBindPoint::GRAPHICS, pipeline.raw());
        }
    }

    /// Replaces the push constants for the following draws.
    pub fn push<T: GpuStruct>(&mut self, value: &T) {
        self.pass.set_push(value);
    }

    /// Binds the vertex streams, one per location, and the 32-bit index buffer.
    pub fn geometry(&mut self, streams: &[&Buffer], indices: &Buffer) {
        assert_eq!(
            streams.len(),
            self.pass.pipeline.made.streams,
            "pass {}",
            self.pass.name
        );
        let buffers: ArrayVec<vk::Buffer, 8> = streams.iter().map(|b| b.raw()).collect();
        let offsets: ArrayVec<u64, 8> = streams.iter().map(|_| 0).collect();
        self.pass.buffer_bytes += streams.iter().map(|s| s.size()).sum::<u64>();
        let (raw, command) = (self.pass.recorder.context.raw(), self.pass.recorder.command);
        // SAFETY: the buffers are alive and were created for this use.
        unsafe {
            raw.cmd_bind_vertex_buffers(command, 0, &buffers, &offsets);
            raw.cmd_bind_index_buffer(command, indices.raw(), 0, vk::IndexType::UINT32);
        }
    }

    /// Sets the viewport (first texel, size) and the scissor rectangle `part` (first texel, size) of the following draws.
    pub fn window(&mut self, origin: [u32; 2], size: [u32; 2], part: ([u32; 2], [u32; 2])) {
        let viewport = vk::Viewport {
            x: origin[0] as f32,
            y: origin[1] as f32,
            width: size[0] as f32,
            height: size[1] as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let scissor = vk::Rect2D {
            offset: vk::Offset2D {
                x: part.0[0].cast_signed(),
                y: part.0[1].cast_signed(),
            },
            extent: vk::Extent2D {
                width: part.1[0],
                height: part.1[1],
            },
        };
        let (raw, command) = (self.pass.recorder.context.raw(), self.pass.recorder.command);
        // SAFETY: the command buffer is inside the rendering of this pass; both states are dynamic in every pipeline.
        unsafe {
            raw.cmd_set_viewport(command, 0, &[viewport]);
            raw.cmd_set_scissor(command, 0, &[scissor]);
        }
    }

    /// Sets front face and culling for the following draws.
    ///
    /// # Panics
    /// When the pipeline does not draw geometry; only pipelines that do have these dynamic states.
    pub fn faces(&mut self, faces: Faces) {
        assert!(self.pass.pipeline.made.culls, "pass {}", self.pass.name);
        if faces == self.pass.faces {
            return;
        }
        self.pass.faces = faces;
        self.pass.set_faces();
    }

    /// Draws a range of the index buffer.
    pub fn indexed(&mut self, first: u32, count: u32) {
        self.pass.flush();
        self.pass.buffer_bytes += 4 * u64::from(count);
        self.pass.drawn += 1;
        let (raw, command) = (self.pass.recorder.context.raw(), self.pass.recorder.command);
        // SAFETY: the range lies within the bound index buffer (checked when the scene was loaded).
        unsafe { raw.cmd_draw_indexed(command, count, 1, first, 0, 0) };
    }

    /// The command buffer and the target size in pixels, for an external renderer that draws last.
    #[cfg(feature = "window")]
    pub(in crate::gpu) fn foreign(&self) -> (vk::CommandBuffer, [u32; 2]) {
        (self.pass.recorder.command, self.pass.target().size())
    }

    /// Draws three vertices without vertex buffers.
    pub fn triangle(&mut self) {
        self.vertices(3);
    }

    /// Draws `count` vertices, three a triangle, without vertex buffers.
    pub fn vertices(&mut self, count: u32) {
        self.pass.flush();
        self.pass.drawn += 1;
        let (raw, command) = (self.pass.recorder.context.raw(), self.pass.recorder.command);
        // SAFETY: the pipeline has no vertex streams, so every vertex index is valid.
        unsafe { raw.cmd_draw(command, count, 1, 0, 0) };
    }
}
