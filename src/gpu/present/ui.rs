//! The user interface, tessellated by `egui`, drawn on top of the image.

use std::sync::Arc;

use ash::vk;
use egui_ash_renderer::allocator::GpuAllocator;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer, RendererError};

use crate::gpu::device::context::Context;
use crate::gpu::error::{During, GpuError, Result};
use crate::gpu::memory::image::Image;
use crate::gpu::present::presenter::FRAMES;
use crate::gpu::record::access::ImageAccess;
use crate::gpu::record::draws::Draws;
use crate::gpu::record::recorder::Recorder;
use crate::gpu::record::work::{Traffic, texels};

/// A tessellated user interface.
pub struct UiFrame {
    /// Clipped triangle meshes.
    pub primitives: Vec<egui::ClippedPrimitive>,
    /// Pixels per point.
    pub pixels_per_point: f32,
}

/// Renderer of user interfaces.
pub struct Overlay {
    // Dropped before the context, whose allocator it uses.
    renderer: Renderer<GpuAllocator>,
    command_pool: vk::CommandPool,
    /// Textures that frames in flight may still use, oldest first.
    retired: Vec<(usize, egui::TextureId)>,
    context: Arc<Context>,
}

fn fault(error: RendererError) -> GpuError {
    match error {
        RendererError::Vulkan(result) => GpuError::Vulkan {
            what: "draw the user interface",
            result,
        },
        other => GpuError::Memory {
            what: "the user interface".into(),
            reason: other.to_string(),
        },
    }
}

impl Overlay {
    /// Creates a renderer for targets of a `format` that encodes by the sRGB curve ([`Encoding::ByFormat`](super::output::Encoding::ByFormat)).
    ///
    /// # Errors
    /// When the driver cannot create its resources.
    pub fn new(context: &Arc<Context>, format: vk::Format) -> Result<Self> {
        let mode = RenderMode::DynamicRendering(DynamicRendering {
            color_attachment_format: format,
            depth_attachment_format: None,
            stencil_attachment_format: None,
        });
        let options = Options {
            in_flight_frames: FRAMES,
            srgb_framebuffer: true,
            ..Options::default()
        };
        let renderer = Renderer::with_gpu_allocator(
            context.shared_allocator(),
            context.raw().clone(),
            mode,
            options,
        )
        .map_err(fault)?;
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(context.queue_family);
        // SAFETY: the info has no pointers.
        let command_pool = unsafe { context.raw().create_command_pool(&info, None) }
            .during("create a command pool")?;
        Ok(Self {
            renderer,
            command_pool,
            retired: Vec::new(),
            context: context.clone(),
        })
    }

    /// Uploads changed textures. Must be called before recording the frame that uses them.
    ///
    /// # Errors
    /// When memory is exhausted.
    pub fn update(&mut self, mut textures: egui::TexturesDelta) -> Result<()> {
        self.free_retired()?;
        if !textures.set.is_empty() {
            // Copies are submitted immediately, and frames in flight may still use the texture being changed.
            self.context.wait_idle()?;
        }
        for (id, deltas) in textures.set.drain() {
            for delta in &deltas {
                let queue = self.context.queue();
                self.renderer
                    .set_texture(*queue, self.command_pool, id, delta)
                    .map_err(fault)?;
            }
        }
        self.retired
            .extend(textures.free.drain().map(|id| (FRAMES, id)));
        Ok(())
    }

    fn free_retired(&mut self) -> Result<()> {
        for (frames, _) in &mut self.retired {
            *frames = frames.saturating_sub(1);
        }
        let done = self.retired.iter().take_while(|r| r.0 == 0).count();
        for (_, id) in self.retired.drain(..done) {
            self.renderer.free_texture(id).map_err(fault)?;
        }
        Ok(())
    }

    /// Draws the interface. This must be the last draw of the pass.
    ///
    /// # Errors
    /// When memory is exhausted.
    pub fn draw(&mut self, draws: &mut Draws<'_, '_>, frame: &UiFrame) -> Result<()> {
        let (command, size) = draws.foreign();
        self.record(command, size, frame)
    }

    /// Draws the interface alone to `target`, transparent elsewhere, with premultiplied alpha.
    ///
    /// # Errors
    /// When memory is exhausted.
    pub fn draw_alone(
        &mut self,
        recorder: &mut Recorder,
        frame: &UiFrame,
        target: &Image,
    ) -> Result<()> {
        const NAME: &str = "user interface";
        recorder.label(NAME);
        let mark = recorder.begin_timing(NAME);
        recorder.transition([(target, ImageAccess::ColorAttachment)].into_iter());
        let colors = [vk::RenderingAttachmentInfo::default()
            .image_view(target.attachment_view())
            .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)];
        let [width, height] = target.size();
        let info = vk::RenderingInfo::default()
            .render_area(vk::Rect2D {
                offset: vk::Offset2D::default(),
                extent: vk::Extent2D { width, height },
            })
            .layer_count(1)
            .color_attachments(&colors);
        // SAFETY: the command buffer is recording; `transition` brought the target to this layout.
        unsafe {
            self.context
                .raw()
                .cmd_begin_rendering(recorder.command, &info)
        };
        let drawn = self.record(recorder.command, target.size(), frame);
        recorder.end_timing(&mark);
        // SAFETY: pairs with `cmd_begin_rendering`.
        unsafe { self.context.raw().cmd_end_rendering(recorder.command) };
        recorder.unlabel();
        let mut traffic = Traffic::new(texels(target));
        traffic.write(target, false);
        recorder.end_work(&mark, 1, || traffic);
        recorder.isolate(&mark);
        drawn
    }

    fn record(
        &mut self,
        command: vk::CommandBuffer,
        [width, height]: [u32; 2],
        frame: &UiFrame,
    ) -> Result<()> {
        let extent = vk::Extent2D { width, height };
        self.renderer
            .cmd_draw(command, extent, frame.pixels_per_point, &frame.primitives)
            .map_err(fault)
    }
}

impl Drop for Overlay {
    fn drop(&mut self) {
        self.context.settle();
        if let Some(raw) = self.context.freeing() {
            // SAFETY: the device is idle, so nothing of the pool or the renderer is in use.
            unsafe { raw.destroy_command_pool(self.command_pool, None) };
        }
    }
}
