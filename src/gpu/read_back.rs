//! Any image back to the CPU.

use ash::vk;

use super::access::{self, Use};
use super::buffer::{Buffer, BufferKind};
use super::error::Result;
use super::image::Image;
use super::recorder::Recorder;

/// Texels of one image (mip level 0): layer after layer, row after row.
#[derive(Debug, Clone)]
pub struct Pixels {
    /// Width and height, texels.
    pub size: [u32; 2],
    /// Number of layers.
    pub layers: u32,
    /// Channels of the format.
    pub channels: usize,
    /// The bytes as the format packs them.
    pub bytes: Vec<u8>,
    format: vk::Format,
}

/// Channels and bytes per channel.
fn shape(format: vk::Format) -> (usize, usize) {
    match format {
        vk::Format::R8_UNORM => (1, 1),
        vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => (4, 1),
        vk::Format::R16_SFLOAT | vk::Format::R16_UINT => (1, 2),
        vk::Format::R16G16_SNORM | vk::Format::R16G16_SFLOAT => (2, 2),
        vk::Format::R16G16B16A16_SFLOAT => (4, 2),
        vk::Format::R32_SFLOAT | vk::Format::D32_SFLOAT => (1, 4),
        vk::Format::R32G32B32A32_SFLOAT => (4, 4),
        other => unreachable!("no image of this program has the format {other:?}"),
    }
}

/// Copies an image to the CPU. The recorder must not be recording; this begins, submits and waits.
///
/// # Errors
/// When memory is out or the device is lost.
pub fn read_back(recorder: &mut Recorder, image: &Image) -> Result<Pixels> {
    let (channels, width) = shape(image.format());
    let [columns, rows] = image.size();
    let texels = columns as usize * rows as usize * image.layers() as usize;
    let bytes = texels * channels * width;
    let name = format!("read-back of {}", image.name());
    let target = Buffer::new(&recorder.context, &name, BufferKind::ReadBack, bytes as u64)?;
    recorder.begin()?;
    recorder.transition([(image, Use::CopySource)].into_iter());
    let region = [vk::BufferImageCopy::default()
        .image_subresource(vk::ImageSubresourceLayers {
            aspect_mask: image.aspect(),
            mip_level: 0,
            base_array_layer: 0,
            layer_count: image.layers(),
        })
        .image_extent(vk::Extent3D {
            width: columns,
            height: rows,
            depth: 1,
        })];
    // SAFETY: the buffer holds all layers; the image was brought to the copy layout; `finish` waits.
    unsafe {
        recorder.context.raw().cmd_copy_image_to_buffer(
            recorder.command,
            image.raw(),
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            target.raw(),
            &region,
        );
    }
    show_to_host(recorder);
    recorder.finish()?;
    Ok(Pixels {
        size: image.size(),
        layers: image.layers(),
        channels,
        bytes: target.bytes()[..bytes].to_vec(),
        format: image.format(),
    })
}

fn show_to_host(recorder: &Recorder) {
    let Some(b) = access::barrier(Use::CopyTarget, Use::HostRead) else {
        return;
    };
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(b.src_stage)
        .src_access_mask(b.src_access)
        .dst_stage_mask(b.dst_stage)
        .dst_access_mask(b.dst_access)];
    let info = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: the command buffer is recording.
    unsafe {
        recorder
            .context
            .raw()
            .cmd_pipeline_barrier2(recorder.command, &info)
    };
}

impl Pixels {
    /// All channels as floats, in the order of `bytes`. Integers come as their value, normalised formats in
    /// 0..1 or −1..1 (sRGB stays encoded).
    pub fn floats(&self) -> Vec<f32> {
        let halves = |bytes: &[u8]| u16::from_ne_bytes([bytes[0], bytes[1]]);
        match self.format {
            vk::Format::R8_UNORM | vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => {
                self.bytes.iter().map(|b| f32::from(*b) / 255.0).collect()
            }
            vk::Format::R16_UINT => self
                .bytes
                .chunks_exact(2)
                .map(|b| f32::from(halves(b)))
                .collect(),
            vk::Format::R16G16_SNORM => self
                .bytes
                .chunks_exact(2)
                .map(|b| (f32::from(halves(b).cast_signed()) / 32767.0).max(-1.0))
                .collect(),
            vk::Format::R16_SFLOAT
            | vk::Format::R16G16_SFLOAT
            | vk::Format::R16G16B16A16_SFLOAT => self
                .bytes
                .chunks_exact(2)
                .map(|b| half_to_f32(halves(b)))
                .collect(),
            _ => self
                .bytes
                .chunks_exact(4)
                .map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
                .collect(),
        }
    }

    /// Texels as `[f32; 4]`; missing channels are 0, a missing fourth is 1.
    pub fn rgba(&self) -> Vec<[f32; 4]> {
        self.floats()
            .chunks_exact(self.channels)
            .map(|c| {
                let mut texel = [0.0, 0.0, 0.0, 1.0];
                texel[..c.len()].copy_from_slice(c);
                texel
            })
            .collect()
    }
}

fn half_to_f32(bits: u16) -> f32 {
    exr::prelude::f16::from_bits(bits).to_f32()
}
