//! CPU data to the device, once, before frames.

use ash::vk;

use crate::gpu::error::Result;
use crate::gpu::memory::buffer::{Buffer, BufferKind};
use crate::gpu::memory::image::{Image, ImageDesc};
use crate::gpu::record::access::Use;
use crate::gpu::record::recorder::Recorder;

fn staging(recorder: &Recorder, bytes: &[u8]) -> Result<Buffer> {
    let size = bytes.len() as u64;
    let mut buffer = Buffer::new(&recorder.context, "staging", BufferKind::Staging, size)?;
    buffer.bytes_mut()[..bytes.len()].copy_from_slice(bytes);
    Ok(buffer)
}

/// Makes a device buffer with content. Where it has to be copied, that runs when the recorder is finished.
///
/// # Errors
/// When memory is out.
pub fn upload_buffer(
    recorder: &mut Recorder,
    name: &str,
    kind: BufferKind,
    bytes: &[u8],
) -> Result<Buffer> {
    let mut target = Buffer::new(&recorder.context, name, kind, bytes.len() as u64)?;
    if let Some(mapped) = target.coherent_bytes_mut() {
        // The device shares its memory with the CPU. Nothing has used the buffer, and what the CPU wrote before a
        // submission the device sees in it.
        mapped[..bytes.len()].copy_from_slice(bytes);
        return Ok(target);
    }
    let source = staging(recorder, bytes)?;
    if !bytes.is_empty() {
        let region = [vk::BufferCopy::default().size(bytes.len() as u64)];
        // SAFETY: both buffers hold at least the bytes copied and live until `finish`. The device waits for the
        // submission to end before anything else is submitted, so no barrier is needed.
        unsafe {
            recorder.context.raw().cmd_copy_buffer(
                recorder.command,
                source.raw(),
                target.raw(),
                &region,
            );
        }
    }
    recorder.keep(source);
    Ok(target)
}

/// Makes a texture from its mip levels (largest first, tightly packed). The copy runs when the recorder is finished.
///
/// # Errors
/// When memory is out or the texture too large for the device.
pub fn upload_texture(
    recorder: &mut Recorder,
    desc: &ImageDesc<'_>,
    levels: &[&[u8]],
) -> Result<Image> {
    let image = Image::new(&recorder.context, desc)?;
    recorder.transition([(&image, Use::CopyTarget)].into_iter());
    for (level, bytes) in levels.iter().enumerate() {
        let source = staging(recorder, bytes)?;
        let region = [vk::BufferImageCopy::default()
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
            })];
        // SAFETY: the buffer holds the level and lives until `finish`; the image was brought to the copy layout.
        unsafe {
            recorder.context.raw().cmd_copy_buffer_to_image(
                recorder.command,
                source.raw(),
                image.raw(),
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &region,
            );
        }
        recorder.keep(source);
    }
    recorder.transition([(&image, Use::Sampled)].into_iter());
    Ok(image)
}
