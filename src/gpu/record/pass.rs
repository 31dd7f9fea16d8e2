//! A pass, built as a chain of methods on the recorder. Each method binds a resource, registers its access and checks it
//! against the pipeline's interface.

use arrayvec::ArrayVec;
use ash::vk;

use crate::gpu::memory::buffer::Buffer;
use crate::gpu::memory::image::{Image, Sampler, is_depth};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::pipeline::layout::{GpuStruct, check_layout};
use crate::gpu::pipeline::shader::{Binding, BindingKind, Field};
use crate::gpu::record::access::{self, BufferAccess, ImageAccess};
use crate::gpu::record::draws::{Draws, Faces};
use crate::gpu::record::recorder::Recorder;
use crate::gpu::record::work::{Traffic, texels};

const MAX_BINDINGS: usize = 24;
const MAX_COLORS: usize = 8;
/// Size of push constants supported by every device, bytes.
const MAX_PUSH: usize = 128;

/// Previous contents of an attachment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// Loaded.
    Keep,
    /// Cleared to a constant.
    Clear([f32; 4]),
    /// Undefined: every pixel is written (`LOAD_OP_DONT_CARE`).
    Discard,
}

#[derive(Clone, Copy)]
enum Resource {
    Image(vk::DescriptorImageInfo),
    Buffer(vk::DescriptorBufferInfo),
}

impl Resource {
    /// Whether both refer to the same resource.
    fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Image(a), Self::Image(b)) => {
                (a.sampler, a.image_view, a.image_layout)
                    == (b.sampler, b.image_view, b.image_layout)
            }
            (Self::Buffer(a), Self::Buffer(b)) => {
                (a.buffer, a.offset, a.range) == (b.buffer, b.offset, b.range)
            }
            _ => false,
        }
    }
}

#[derive(Clone, Copy)]
struct Bound {
    binding: Binding,
    resource: Resource,
}

/// The access of a sampled image.
fn sampled_access(image: &Image) -> ImageAccess {
    if is_depth(image.format()) {
        ImageAccess::SampledDepth
    } else {
        ImageAccess::Sampled
    }
}

/// The sampled images with their accesses.
pub(in crate::gpu) fn sampled_accesses<'r>(
    reads: &[&'r Image],
) -> impl Iterator<Item = (&'r Image, ImageAccess)> {
    reads.iter().map(|image| (*image, sampled_access(image)))
}

/// A pass under construction. Nothing is recorded until `draw`, `draws` or `dispatch`.
///
/// # Panics
/// Every method panics if it contradicts the pipeline's interface. This is a bug in the program, found by the first test that
/// runs the pass.
pub struct Pass<'r> {
    pub(in crate::gpu) recorder: &'r mut Recorder,
    pub(in crate::gpu) pipeline: &'r Pipeline,
    pub(in crate::gpu) name: &'static str,
    bound: ArrayVec<Bound, MAX_BINDINGS>,
    pub(in crate::gpu) changed: bool,
    pub(in crate::gpu) reads: ArrayVec<&'r Image, MAX_BINDINGS>,
    pub(in crate::gpu) stores: ArrayVec<&'r Image, MAX_COLORS>,
    pub(in crate::gpu) buffers: ArrayVec<(&'r Buffer, BufferAccess), MAX_BINDINGS>,
    colors: ArrayVec<(&'r Image, Load), MAX_COLORS>,
    depth: Option<(&'r Image, Load)>,
    /// Push constants, and whether they changed since the last draw.
    push: (ArrayVec<u8, MAX_PUSH>, bool),
    /// Members of the host struct last compared with the pipeline's block.
    checked_push: Option<&'static [Field]>,
    /// Render area; `None` for the whole target.
    area: Option<vk::Rect2D>,
    pub(in crate::gpu) faces: Faces,
    /// Bytes of the buffers and textures read.
    pub(in crate::gpu) buffer_bytes: u64,
    /// Draws so far.
    pub(in crate::gpu) drawn: u64,
}

impl<'r> Pass<'r> {
    pub(in crate::gpu) fn new(
        recorder: &'r mut Recorder,
        name: &'static str,
        pipeline: &'r Pipeline,
    ) -> Self {
        Self {
            recorder,
            pipeline,
            name,
            bound: ArrayVec::new(),
            changed: true,
            reads: ArrayVec::new(),
            stores: ArrayVec::new(),
            buffers: ArrayVec::new(),
            colors: ArrayVec::new(),
            depth: None,
            push: (ArrayVec::new(), false),
            checked_push: None,
            area: None,
            faces: Faces::default(),
            buffer_bytes: 0,
            drawn: 0,
        }
    }

    /// Binds a sampled image.
    pub fn sample(mut self, name: &str, image: &'r Image, sampler: Sampler) -> Self {
        self.bind_image(name, image, sampler);
        self.reads.push(image);
        self
    }

    /// Sets the contents of a uniform block.
    pub fn uniform<T: GpuStruct>(mut self, name: &str, value: &T) -> Self {
        let binding = self.declared(name, BindingKind::UniformBuffer);
        self.check_block(name, T::FIELDS, binding.fields);
        let info = self.recorder.uniform(value);
        self.bind(binding, Resource::Buffer(info));
        self
    }

    /// Binds a storage buffer for reading.
    pub fn storage(self, name: &str, buffer: &'r Buffer) -> Self {
        self.bind_buffer(name, buffer, BufferAccess::StorageRead)
    }

    /// Binds a storage buffer that a compute shader reads and writes.
    pub fn storage_mut(self, name: &str, buffer: &'r Buffer) -> Self {
        self.bind_buffer(name, buffer, BufferAccess::StorageWrite)
    }

    fn bind_buffer(mut self, name: &str, buffer: &'r Buffer, access: BufferAccess) -> Self {
        let binding = self.declared(name, BindingKind::StorageBuffer);
        let info = vk::DescriptorBufferInfo {
            buffer: buffer.raw(),
            offset: 0,
            range: vk::WHOLE_SIZE,
        };
        self.buffer_bytes += buffer.size();
        self.bind(binding, Resource::Buffer(info));
        self.buffers.push((buffer, access));
        self
    }

    /// Sets the push constants.
    pub fn push<T: GpuStruct>(mut self, value: &T) -> Self {
        self.set_push(value);
        self
    }

    /// Adds a colour attachment, in the order of the fragment shader's outputs.
    pub fn color(mut self, image: &'r Image, load: Load) -> Self {
        self.colors.push((image, load));
        self
    }

    /// Sets the depth attachment, tested and written.
    pub fn depth(mut self, image: &'r Image, load: Load) -> Self {
        self.depth = Some((image, load));
        self
    }

    /// Sets a depth attachment that is tested but not written. The pass may also sample it.
    pub fn depth_test(self, image: &'r Image) -> Self {
        self.depth(image, Load::Keep)
    }

    /// Restricts the pass to one pixel of the target; all others are kept.
    pub fn only(self, pixel: [u32; 2]) -> Self {
        self.within(pixel, [1, 1])
    }

    /// Restricts draws and clears to a rectangle of the target (first pixel, size); all other pixels are kept.
    pub fn within(mut self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> Self {
        self.area = Some(vk::Rect2D {
            offset: vk::Offset2D {
                x: x.cast_signed(),
                y: y.cast_signed(),
            },
            extent: vk::Extent2D { width, height },
        });
        self
    }

    /// Draws a full-screen triangle, generated by the vertex shader from the vertex index.
    pub fn draw(self) {
        self.draws(|draws| draws.triangle());
    }

    /// Records draws through a closure.
    pub fn draws(mut self, record: impl FnOnce(&mut Draws<'_, 'r>)) {
        self.check_attachments();
        let depth_access = self.depth_access();
        let uses = sampled_accesses(&self.reads)
            .chain(
                self.colors
                    .iter()
                    .map(|(i, _)| (*i, ImageAccess::ColorAttachment)),
            )
            .chain(self.depth.iter().map(|(i, _)| (*i, depth_access)));
        self.recorder.label(self.name);
        let mark = self.recorder.begin_timing(self.name);
        self.recorder.transition(uses);
        self.order_buffers();
        self.begin_rendering();
        record(&mut Draws { pass: &mut self });
        let is_software = self.recorder.context.summary().is_software();
        // Software drivers attribute what is after the rendering to the next pass; tilers draw at its end.
        if is_software {
            self.recorder.end_timing(&mark);
        }
        // SAFETY: pairs with `begin_rendering`.
        unsafe {
            self.recorder
                .context
                .raw()
                .cmd_end_rendering(self.recorder.command)
        };
        if !is_software {
            self.recorder.end_timing(&mark);
        }
        self.recorder.unlabel();
        let traffic = self.traffic();
        self.recorder.end_work(&mark, self.drawn, || traffic);
        self.recorder.isolate(&mark);
    }

    /// Makes the pass wait for earlier accesses of its buffers.
    pub(in crate::gpu) fn order_buffers(&self) {
        for (buffer, access) in &self.buffers {
            self.recorder.order(buffer, *access);
        }
    }

    fn traffic(&self) -> Traffic {
        let target = self.colors.first().map(|c| c.0).or(self.depth.map(|d| d.0));
        let mut traffic = Traffic::new(target.map_or(0, texels));
        traffic.bytes_read += self.buffer_bytes;
        for image in &self.reads {
            traffic.sample(image);
        }
        for (image, load) in &self.colors {
            traffic.write(image, *load == Load::Keep);
        }
        match self.depth {
            Some((image, load)) if self.pipeline.made.writes_depth => {
                traffic.write(image, load == Load::Keep);
            }
            Some((image, _)) => traffic.test(image),
            None => {}
        }
        traffic
    }

    fn depth_access(&self) -> ImageAccess {
        if self.pipeline.made.writes_depth {
            ImageAccess::DepthAttachment
        } else {
            ImageAccess::SampledDepth
        }
    }

    fn declared(&self, name: &str, kind: BindingKind) -> Binding {
        let found = self
            .pipeline
            .made
            .slots
            .iter()
            .find(|s| s.binding.name == name);
        let Some(slot) = found else {
            panic!(
                "pass {}: {} declares no {name}",
                self.name,
                self.pipeline.name()
            )
        };
        assert_eq!(slot.binding.kind, kind, "pass {}: {name}", self.name);
        slot.binding
    }

    fn bind(&mut self, binding: Binding, resource: Resource) {
        let new = Bound { binding, resource };
        match self
            .bound
            .iter_mut()
            .find(|b| b.binding.binding == binding.binding)
        {
            // Materials without textures share placeholder textures.
            Some(old) if old.resource.is(&resource) => return,
            Some(old) => *old = new,
            None => self.bound.push(new),
        }
        self.changed = true;
    }

    pub(in crate::gpu) fn bind_image(&mut self, name: &str, image: &Image, sampler: Sampler) {
        let info = vk::DescriptorImageInfo {
            sampler: self.recorder.context.sampler_of(image.format(), sampler),
            image_view: image.sampled_view(),
            image_layout: access::layout(sampled_access(image)),
        };
        self.bind_view(name, BindingKind::SampledImage, info);
    }

    pub(in crate::gpu) fn bind_view(
        &mut self,
        name: &str,
        kind: BindingKind,
        info: vk::DescriptorImageInfo,
    ) {
        let binding = self.declared(name, kind);
        self.bind(binding, Resource::Image(info));
    }

    fn check_block(&self, name: &str, host: &[Field], block: &[Field]) {
        if let Err(difference) = check_layout(host, block) {
            panic!("pass {}: {name}: {difference}", self.name);
        }
    }

    pub(in crate::gpu) fn set_push<T: GpuStruct>(&mut self, value: &T) {
        // A pass may push constants for thousands of draws, so the same struct is compared only once.
        let checked = self
            .checked_push
            .is_some_and(|c| std::ptr::eq(c, T::FIELDS));
        if !checked {
            let Some((fields, _)) = self.pipeline.made.push else {
                panic!("pass {}: no push constants declared", self.name)
            };
            self.check_block("push", T::FIELDS, fields);
            self.checked_push = Some(T::FIELDS);
        }
        const { assert!(size_of::<T>() <= MAX_PUSH, "too many push constants") };
        let (bytes, is_new) = &mut self.push;
        bytes.clear();
        bytes.extend(bytemuck::bytes_of(value).iter().copied());
        *is_new = true;
    }

    fn check_attachments(&self) {
        let formats: ArrayVec<vk::Format, MAX_COLORS> =
            self.colors.iter().map(|(i, _)| i.format()).collect();
        assert_eq!(
            formats.as_slice(),
            self.pipeline.made.colors,
            "pass {}: colours",
            self.name
        );
        let depth = self.depth.map(|(i, _)| i.format());
        assert_eq!(depth, self.pipeline.made.depth, "pass {}: depth", self.name);
    }

    fn attachment(image: &Image, load: Load, layout: vk::ImageLayout) -> AttachmentInfo {
        let info = vk::RenderingAttachmentInfo::default()
            .image_view(image.attachment_view())
            .image_layout(layout)
            .store_op(vk::AttachmentStoreOp::STORE);
        match load {
            Load::Keep => info.load_op(vk::AttachmentLoadOp::LOAD),
            Load::Discard => info.load_op(vk::AttachmentLoadOp::DONT_CARE),
            Load::Clear(value) if is_depth(image.format()) => info
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .clear_value(vk::ClearValue {
                    depth_stencil: vk::ClearDepthStencilValue {
                        depth: value[0],
                        stencil: 0,
                    },
                }),
            Load::Clear(value) => {
                info.load_op(vk::AttachmentLoadOp::CLEAR)
                    .clear_value(vk::ClearValue {
                        color: vk::ClearColorValue { float32: value },
                    })
            }
        }
    }

    /// The first attachment; all attachments have the same size.
    pub(in crate::gpu) fn target(&self) -> &'r Image {
        let color = self.colors.first().map(|c| c.0);
        let Some(target) = color.or(self.depth.map(|d| d.0)) else {
            panic!("pass {}: draws to nothing", self.name)
        };
        target
    }

    fn begin_rendering(&self) {
        let colors: ArrayVec<AttachmentInfo, MAX_COLORS> = self
            .colors
            .iter()
            .map(|(i, l)| Self::attachment(i, *l, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL))
            .collect();
        let depth = self.depth.map(|(image, load)| {
            let info = Self::attachment(image, load, access::layout(self.depth_access()));
            let written = self.pipeline.made.writes_depth;
            // A store operation counts as a write, which a read-only layout forbids.
            if written {
                info
            } else {
                info.store_op(vk::AttachmentStoreOp::NONE)
            }
        });
        let target = self.target();
        let [width, height] = target.size();
        let area = self.area.unwrap_or(vk::Rect2D {
            offset: vk::Offset2D::default(),
            extent: vk::Extent2D { width, height },
        });
        let mut info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(target.layers())
            .color_attachments(&colors);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        let viewport = vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let (raw, command) = (self.recorder.context.raw(), self.recorder.command);
        // SAFETY: the command buffer is recording; `transition` brought the attachments to these layouts.
        unsafe {
            raw.cmd_begin_rendering(command, &info);
            raw.cmd_set_viewport(command, 0, &[viewport]);
            raw.cmd_set_scissor(command, 0, &[area]);
            raw.cmd_bind_pipeline(
                command,
                vk::PipelineBindPoint::GRAPHICS,
                self.pipeline.raw(),
            );
        }
        if self.pipeline.made.culls {
            self.set_faces();
        }
    }

    /// Sets front face and culling, which are dynamic in every pipeline that draws geometry.
    pub(in crate::gpu) fn set_faces(&self) {
        let (cull, front) = self.faces.state();
        let (raw, command) = (self.recorder.context.raw(), self.recorder.command);
        // SAFETY: the command buffer is inside the rendering of this pass; both states are dynamic in its pipelines.
        unsafe {
            raw.cmd_set_cull_mode(command, cull);
            raw.cmd_set_front_face(command, front);
        }
    }

    /// Records pending bindings and push constants before a draw.
    pub(in crate::gpu) fn flush(&mut self) {
        assert_eq!(
            self.bound.len(),
            self.pipeline.made.slots.len(),
            "pass {}: a declared binding was not bound",
            self.name
        );
        if self.changed && !self.bound.is_empty() {
            self.flush_descriptors();
        }
        self.changed = false;
        if let Some((_, stages)) = self.pipeline.made.push {
            assert!(!self.push.0.is_empty(), "pass {}: push", self.name);
            if std::mem::take(&mut self.push.1) {
                self.flush_push(stages);
            }
        }
    }

    fn flush_push(&self, stages: vk::ShaderStageFlags) {
        let (raw, command) = (self.recorder.context.raw(), self.recorder.command);
        let layout = self.pipeline.layout();
        // SAFETY: the layout declares the block for these stages; its size was checked when it was set.
        unsafe { raw.cmd_push_constants(command, layout, stages, 0, &self.push.0) };
    }

    fn flush_descriptors(&mut self) {
        let bound = self.bound.clone();
        let pushed = self.recorder.context.extensions.push_descriptor.is_some();
        let set = if pushed {
            vk::DescriptorSet::null()
        } else {
            // Without a descriptor set the draw is skipped; `finish` reports the error.
            let Some(set) = self.recorder.descriptor_set(self.pipeline) else {
                return;
            };
            set
        };
        let writes: ArrayVec<vk::WriteDescriptorSet<'_>, MAX_BINDINGS> = bound
            .iter()
            .map(|b| {
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(b.binding.binding)
                    .descriptor_type(b.binding.kind.descriptor());
                match &b.resource {
                    Resource::Image(info) => write.image_info(std::slice::from_ref(info)),
                    Resource::Buffer(info) => write.buffer_info(std::slice::from_ref(info)),
                }
            })
            .collect();
        let (context, command) = (&self.recorder.context, self.recorder.command);
        let point = self.pipeline.bind_point();
        let layout = self.pipeline.layout();
        // SAFETY: the infos outlive the calls; `transition` brought the images to the sampled layout.
        unsafe {
            match &context.extensions.push_descriptor {
                Some(push) => push.cmd_push_descriptor_set(command, point, layout, 0, &writes),
                None => {
                    context.raw().update_descriptor_sets(&writes, &[]);
                    let raw = context.raw();
                    raw.cmd_bind_descriptor_sets(command, point, layout, 0, &[set], &[]);
                }
            }
        }
    }
}

type AttachmentInfo = vk::RenderingAttachmentInfo<'static>;
