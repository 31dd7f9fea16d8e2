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

pub mod access;
mod buffer;
mod compute;
mod context;
mod draws;
mod error;
mod fault;
mod heap;
#[cfg(feature = "hot-reload")]
mod hot_reload;
mod image;
mod instance;
mod labels;
mod layout;
mod mips;
mod pass;
mod pipeline;
mod pipeline_cache;
mod pipeline_state;
mod presenter;
mod push_words;
mod read_back;
mod recorder;
mod sampler;
mod select;
mod shader;
#[cfg(feature = "hot-reload")]
mod shader_build;
mod stages;
mod startup;
mod surface;
mod swapchain;
mod timings;
mod transitions;
mod ui;
mod upload;
mod validation;
mod work;

pub use access::Use;
pub use ash::vk::Format;
pub use buffer::{Buffer, BufferKind};
pub use context::{Context, ContextOptions};
pub use draws::{Draws, Faces, Winding};
pub use error::{GpuError, Result};
pub use image::{Image, ImageDesc, ImageKind};
pub use layout::{GpuStruct, check_layout};
pub use pass::{Load, Pass};
pub use pipeline::{Depth, Pipeline, PipelineDesc};
pub use pipeline_cache::CacheState;
pub use presenter::Presenter;
pub use read_back::{Pixels, Texel, copy_texel, read_back};
pub use recorder::Recorder;
pub use sampler::Sampler;
pub use select::{DeviceSummary, Optional, devices};
pub use shader::{Binding, BindingKind, Field, Shader, Stage, compiled as shaders};
pub use startup::Step;
pub use surface::{Surface, WindowHandles};
pub use timings::{PassTime, Stopwatch, Timing, Timings};
pub use ui::{Overlay, UiFrame};
pub use upload::{upload_buffer, upload_texture};
pub use work::{PassWork, PipelineStatistics, Traffic};
