//! Uploads of buffers and textures.

use ash::vk;

use crate::gpu::error::Result;
use crate::gpu::memory::buffer::{Buffer, BufferKind};
use crate::gpu::memory::image::{Image, ImageDesc};
use crate::gpu::record::access::{BufferAccess, ImageAccess};
use crate::gpu::record::recorder::Recorder;

/// Alignment of copy offsets into staging buffers, bytes: a multiple of every texel size and of 4
/// (VUID-vkCmdCopyBufferToImage-dstImage-07978).
const COPY_ALIGNMENT: usize = 16;

/// Creates a device buffer with the given contents. If a staging copy is needed, it runs when the recorder is finished;
/// commands recorded later see the contents.
///
/// # Errors
/// When device memory is exhausted.
pub fn upload_buffer(
    recorder: &mut Recorder,
    name: &str,
    kind: BufferKind,
    bytes: &[u8],
) -> Result<Buffer> {
    let mut target = Buffer::new(&recorder.context, name, kind, bytes.len() as u64)?;
    if !recorder.context.stage_uploads
        && let Some(mapped) = target.coherent_bytes_mut()
    {
        // The buffer is not in use yet, and a submission makes earlier host writes visible to the device.
        mapped[..bytes.len()].copy_from_slice(bytes);
        return Ok(target);
    }
    if bytes.is_empty() {
        return Ok(target);
    }
    let mut source = staging(recorder, bytes.len())?;
    source.bytes_mut()[..bytes.len()].copy_from_slice(bytes);
    let region = [vk::BufferCopy::default().size(bytes.len() as u64)];
    recorder.order(&target, BufferAccess::CopyTarget);
    let raw = recorder.context.raw();
    // SAFETY: both buffers hold the bytes copied and live until `finish`.
    unsafe { raw.cmd_copy_buffer(recorder.command, source.raw(), target.raw(), &region) };
    if let Some(next) = kind.read_access() {
        recorder.order(&target, next);
    }
    recorder.keep(source);
    Ok(target)
}

/// Creates a texture from its mip levels (largest first, tightly packed). The copy runs when the recorder is finished.
///
/// # Errors
/// When device memory is exhausted or the texture is too large for the device.
pub fn upload_texture(
    recorder: &mut Recorder,
    desc: &ImageDesc<'_>,
    levels: &[&[u8]],
) -> Result<Image> {
    let image = Image::new(&recorder.context, desc)?;
    let mut end = 0;
    let offsets: Vec<usize> = levels
        .iter()
        .map(|bytes| {
            let offset = end;
            end = (end + bytes.len()).next_multiple_of(COPY_ALIGNMENT);
            offset
        })
        .collect();
    let mut source = staging(recorder, end)?;
    for (offset, bytes) in offsets.iter().zip(levels) {
        source.bytes_mut()[*offset..offset + bytes.len()].copy_from_slice(bytes);
    }
    let region = |(level, offset): (usize, &usize)| {
        vk::BufferImageCopy::default()
            .buffer_offset(*offset as u64)
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                mip_level: level as u32,
                base_array_layer: 0,
                layer_count: image.layers(),
            })
            .image_extent(vk::Extent3D {
                width: (desc.size[0] >> level).max(1),
                height: (desc.size[1] >> level).max(1),
                depth: 1,
            })
    };
    let regions: Vec<_> = offsets.iter().enumerate().map(region).collect();
    recorder.transition([(&image, ImageAccess::CopyTarget)].into_iter());
    // SAFETY: the buffer holds all levels and lives until `finish`; the image is in the copy layout.
    unsafe {
        recorder.context.raw().cmd_copy_buffer_to_image(
            recorder.command,
            source.raw(),
            image.raw(),
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
            &regions,
        );
    }
    recorder.keep(source);
    recorder.transition([(&image, ImageAccess::Sampled)].into_iter());
    Ok(image)
}

fn staging(recorder: &Recorder, bytes: usize) -> Result<Buffer> {
    let context = &recorder.context;
    Buffer::new(context, "staging", BufferKind::Staging, bytes as u64)
}
