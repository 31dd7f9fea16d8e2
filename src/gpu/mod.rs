//! Vulkan nouns: device, images, buffers, pipelines, command recording. Knows no pass by name and imports
//! nothing of the rest of the crate.
//!
//! Everything `unsafe` of the program is in this room. Each raw handle is owned by a `Drop` type from the line
//! that creates it; every resource keeps its [`Context`] alive.
//!
//! The three things to know:
//! - an [`Image`] remembers its last [`Use`]; [`access::barrier`] turns (last use, next use) into a barrier, so
//!   no pass writes a stage or an access mask;
//! - a [`Shader`] carries what it declares (build.rs reads it from the SPIR-V), and [`Recorder::pass`] checks each
//!   bound name against it;
//! - a [`Recorder`] records, submits and waits; the name given to `pass` labels and times it.
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
pub use device::select::{DeviceSummary, Optional, devices};
pub use device::startup::Step;
#[cfg(feature = "window")]
pub use device::surface::{Surface, WindowHandles};
pub use error::{GpuError, Result};
pub use memory::buffer::{Buffer, BufferKind};
pub use memory::image::{Image, ImageDesc, ImageKind};
pub use memory::read_back::{Pixels, Texel, copy_texel, read_back};
pub use memory::sampler::Sampler;
pub use memory::upload::{upload_buffer, upload_texture};
pub use pipeline::cache::CacheState;
pub use pipeline::layout::{GpuStruct, assert_layout};
pub use pipeline::shader::{Binding, BindingKind, Field, Shader, Stage, compiled as shaders};
pub use pipeline::{Depth, Pipeline, PipelineDesc};
#[cfg(feature = "window")]
pub use present::{
    presenter::Presenter,
    ui::{Overlay, UiFrame},
};
pub use record::access;
pub use record::access::Use;
pub use record::draws::{Draws, Faces, Winding};
pub use record::pass::{Load, Pass};
pub use record::recorder::Recorder;
pub use record::timings::{PassTime, Stopwatch, Timing, Timings};
pub use record::work::{PassWork, PipelineStatistics, Traffic};
