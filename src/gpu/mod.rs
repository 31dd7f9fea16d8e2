//! Vulkan objects: device, images, buffers, pipelines, command recording. This module is independent of the render passes and
//! imports nothing else from the crate.
//!
//! All `unsafe` code of the program is in this module. Each raw handle is owned by a `Drop` type as soon as it is created, and
//! every resource keeps its [`Context`] alive.
//!
//! - An [`Image`] tracks its last [`ImageAccess`](access::ImageAccess), and [`access::barrier`] maps (last access, next
//!   access) to a barrier, so passes never specify stages or access masks.
//! - A [`Shader`] carries its interface, which build.rs reads from the SPIR-V; [`Recorder::pass`] checks each binding
//!   against it.
//! - A [`Recorder`] records, submits and waits; the name given to `pass` labels and times the pass.
#![allow(unsafe_code)]

mod device;
mod error;
mod memory;
mod pipeline;
#[cfg(feature = "window")]
mod present;
mod record;
#[cfg(feature = "hot-reload")]
mod shader_build;

pub use ash::vk::Format;
pub use device::context::{Context, ContextOptions};
pub use device::memory_heaps::Heap;
pub use device::optional::Optional;
pub use device::select::{DeviceSummary, devices};
pub use device::startup::Step;
#[cfg(feature = "window")]
pub use device::surface::{Surface, WindowHandles};
pub use error::{GpuError, Result};
pub use memory::buffer::{Buffer, BufferKind};
pub use memory::image::{Image, ImageDesc, ImageKind, Outside, Sampler, Written};
pub use memory::read_back::{Pixels, Texel, copy_texel, read_back, read_texels};
pub use memory::upload::{upload_buffer, upload_texture};
pub use pipeline::cache::CacheState;
pub use pipeline::layout::{GpuStruct, assert_layout};
pub use pipeline::route::RouteTimes;
pub use pipeline::shader::{Binding, BindingKind, Field, Shader, Stage, compiled as shaders};
pub use pipeline::{Blend, Depth, Pipeline, PipelineDesc};
#[cfg(feature = "window")]
pub use present::{
    output::{Content, Encoding, Output},
    presenter::{FRAMES, Presenter},
    ui::{Overlay, UiFrame},
};
pub use record::access;
pub use record::draws::{Draws, Faces, Winding};
pub use record::pass::{Load, Pass};
pub use record::recorder::Recorder;
pub use record::screen::Route;
pub use record::timings::{PassTime, Stopwatch, Timing, Timings};
pub use record::work::{PassWork, PipelineStatistics, Traffic};
