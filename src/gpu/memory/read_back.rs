//! Read-back of images to the CPU.

use ash::vk;

use crate::gpu::error::Result;
use crate::gpu::memory::buffer::{Buffer, BufferKind};
use crate::gpu::memory::image::Image;
use crate::gpu::record::access::{BufferAccess, ImageAccess};
use crate::gpu::record::recorder::Recorder;

/// Texels of an image (mip level 0), layer by layer and row by row.
#[derive(Debug, Clone)]
pub struct Pixels {
    /// Width and height, texels.
    pub size: [u32; 2],
    /// Number of layers.
    pub layers: u32,
    /// Channels of the format.
    pub channels: usize,
    /// The texels as packed by the format.
    pub bytes: Vec<u8>,
    format: vk::Format,
}

/// Number of channels and bytes per channel.
fn shape(format: vk::Format) -> (usize, usize) {
    match format {
        vk::Format::R8_UNORM => (1, 1),
        vk::Format::R8G8B8A8_UNORM
        | vk::Format::R8G8B8A8_SRGB
        | vk::Format::B8G8R8A8_UNORM
        | vk::Format::B8G8R8A8_SRGB => (4, 1),
        // Four channels in a word of 32 bits.
        vk::Format::A2B10G10R10_UNORM_PACK32 | vk::Format::A2R10G10B10_UNORM_PACK32 => (4, 1),
        vk::Format::R16_SFLOAT | vk::Format::R16_UINT => (1, 2),
        // Packed words: lower half first, then upper half.
        vk::Format::R32_UINT => (2, 2),
        vk::Format::R32G32_UINT => (4, 2),
        vk::Format::R32G32B32A32_UINT => (8, 2),
        vk::Format::R16G16_SNORM | vk::Format::R16G16_SFLOAT => (2, 2),
        vk::Format::R16G16B16A16_SFLOAT => (4, 2),
        vk::Format::R32_SFLOAT | vk::Format::D32_SFLOAT => (1, 4),
        vk::Format::R32G32B32A32_SFLOAT => (4, 4),
        other => unreachable!("no image of this program has the format {other:?}"),
    }
}

/// One texel copied into a slot of a read-back buffer.
#[derive(Debug, Clone, Copy)]
pub struct Texel {
    slot: usize,
    format: vk::Format,
}

impl Texel {
    /// Bytes per slot: the size of the widest format.
    pub const SLOT_BYTES: usize = 16;

    /// The channels, valid after the copy; missing ones as in [`Pixels::rgba`].
    pub fn read(&self, buffer: &Buffer) -> [f32; 4] {
        let (channels, width) = shape(self.format);
        let start = self.slot * Self::SLOT_BYTES;
        let bytes = buffer.bytes().get(start..start + channels * width);
        four(&floats(self.format, bytes.unwrap_or(&[])))
    }
}

/// Records a copy of one texel of a 2D image into a slot of a read-back buffer.
///
/// # Panics
/// When the pixel is outside the image.
pub fn copy_texel(
    recorder: &mut Recorder,
    image: &Image,
    pixel: [u32; 2],
    buffer: &Buffer,
    slot: usize,
) -> Texel {
    let [width, height] = image.size();
    assert!(
        pixel[0] < width && pixel[1] < height,
        "{pixel:?} is outside {}",
        image.name()
    );
    let region = vk::BufferImageCopy::default()
        .buffer_offset((slot * Texel::SLOT_BYTES) as u64)
        .image_offset(vk::Offset3D {
            x: pixel[0].cast_signed(),
            y: pixel[1].cast_signed(),
            z: 0,
        })
        .image_extent(vk::Extent3D {
            width: 1,
            height: 1,
            depth: 1,
        });
    copy(recorder, image, buffer, region);
    let format = image.format();
    Texel { slot, format }
}

/// Records a copy of a region of all layers. The CPU can read it once the work is done.
fn copy(recorder: &Recorder, image: &Image, target: &Buffer, region: vk::BufferImageCopy) {
    recorder.transition([(image, ImageAccess::CopySource)].into_iter());
    recorder.order(target, BufferAccess::CopyTarget);
    let region = [region.image_subresource(vk::ImageSubresourceLayers {
        aspect_mask: image.aspect(),
        mip_level: 0,
        base_array_layer: 0,
        layer_count: image.layers(),
    })];
    // SAFETY: the buffer holds the region; the image is in the copy layout; both live until the work is done.
    unsafe {
        recorder.context.raw().cmd_copy_image_to_buffer(
            recorder.command,
            image.raw(),
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            target.raw(),
            &region,
        );
    }
    recorder.order(target, BufferAccess::HostRead);
}

/// Copies an image to the CPU. Begins, submits and waits, so the recorder must not be recording.
///
/// # Errors
/// When device memory is exhausted or the device is lost.
pub fn read_back(recorder: &mut Recorder, image: &Image) -> Result<Pixels> {
    let target = downloaded(recorder, image)?;
    Ok(Pixels {
        size: image.size(),
        layers: image.layers(),
        channels: shape(image.format()).0,
        bytes: target.bytes()[..bytes_of(image)].to_vec(),
        format: image.format(),
    })
}

/// The texels of an image with these numbers, counted along its rows: their first four channels, as [`Pixels::rgba`] has them. As [`read_back`],
/// without copying the others once more.
///
/// # Errors
/// When device memory is exhausted or the device is lost.
///
/// # Panics
/// When a number is not below that of the image's texels.
pub fn read_texels(
    recorder: &mut Recorder,
    image: &Image,
    numbers: &[usize],
) -> Result<Vec<[f32; 4]>> {
    let target = downloaded(recorder, image)?;
    let (channels, width) = shape(image.format());
    let texels = &target.bytes()[..bytes_of(image)];
    let texel = |number: &usize| &texels[number * channels * width..][..channels * width];
    let gathered: Vec<u8> = numbers.iter().flat_map(texel).copied().collect();
    let floats = floats(image.format(), &gathered);
    Ok(floats.chunks_exact(channels).map(four).collect())
}

/// Bytes of the first mip level of an image.
fn bytes_of(image: &Image) -> usize {
    let (channels, width) = shape(image.format());
    let [columns, rows] = image.size();
    columns as usize * rows as usize * image.layers() as usize * channels * width
}

/// A buffer with all texels of an image.
fn downloaded(recorder: &mut Recorder, image: &Image) -> Result<Buffer> {
    let [columns, rows] = image.size();
    let name = format!("read-back of {}", image.name());
    let bytes = bytes_of(image) as u64;
    let target = Buffer::new(&recorder.context, &name, BufferKind::ReadBack, bytes)?;
    recorder.begin()?;
    let region = vk::BufferImageCopy::default().image_extent(vk::Extent3D {
        width: columns,
        height: rows,
        depth: 1,
    });
    copy(recorder, image, &target, region);
    recorder.finish()?;
    Ok(target)
}

impl Pixels {
    /// All channels as floats, red first: integer formats as their value, normalised formats in 0..1 or −1..1
    /// (sRGB values stay encoded).
    pub fn floats(&self) -> Vec<f32> {
        floats(self.format, &self.bytes)
    }

    /// The first four channels of each texel. Missing channels are 0, a missing alpha is 1.
    pub fn rgba(&self) -> Vec<[f32; 4]> {
        self.floats()
            .chunks_exact(self.channels)
            .map(four)
            .collect()
    }
}

/// The first four channels. Missing channels are 0, a missing alpha is 1.
fn four(channels: &[f32]) -> [f32; 4] {
    let mut texel = [0.0, 0.0, 0.0, 1.0];
    for (to, from) in texel.iter_mut().zip(channels) {
        *to = *from;
    }
    texel
}

fn floats(format: vk::Format, bytes: &[u8]) -> Vec<f32> {
    let halves = |bytes: &[u8]| u16::from_ne_bytes([bytes[0], bytes[1]]);
    let pairs = || bytes.chunks_exact(2).map(halves);
    match format {
        vk::Format::R8_UNORM | vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => {
            bytes.iter().map(|b| f32::from(*b) / 255.0).collect()
        }
        vk::Format::B8G8R8A8_UNORM | vk::Format::B8G8R8A8_SRGB => bytes
            .chunks_exact(4)
            .flat_map(|b| [b[2], b[1], b[0], b[3]])
            .map(|b| f32::from(b) / 255.0)
            .collect(),
        vk::Format::A2B10G10R10_UNORM_PACK32 => words(bytes)
            .flat_map(|w| ten_bits(w, [0, 10, 20]))
            .collect(),
        vk::Format::A2R10G10B10_UNORM_PACK32 => words(bytes)
            .flat_map(|w| ten_bits(w, [20, 10, 0]))
            .collect(),
        vk::Format::R16_UINT
        | vk::Format::R32_UINT
        | vk::Format::R32G32_UINT
        | vk::Format::R32G32B32A32_UINT => pairs().map(f32::from).collect(),
        vk::Format::R16G16_SNORM => pairs()
            .map(|b| (f32::from(b.cast_signed()) / 32767.0).max(-1.0))
            .collect(),
        vk::Format::R16_SFLOAT | vk::Format::R16G16_SFLOAT | vk::Format::R16G16B16A16_SFLOAT => {
            pairs().map(half_to_f32).collect()
        }
        _ => words(bytes).map(f32::from_bits).collect(),
    }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    let words = bytes.chunks_exact(4);
    words.map(|b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
}

/// Red, green and blue of 10 bits each, which begin at these bits of the word, and alpha of 2.
fn ten_bits(word: u32, first: [u32; 3]) -> [f32; 4] {
    let [r, g, b] = first.map(|bit| (word >> bit & 0x3ff) as f32 / 1023.0);
    [r, g, b, (word >> 30) as f32 / 3.0]
}

fn half_to_f32(bits: u16) -> f32 {
    exr::prelude::f16::from_bits(bits).to_f32()
}
