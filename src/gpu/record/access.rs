//! Barriers as a table: pure functions map (previous access, next access) of an image or a buffer to a barrier.

use ash::vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};

/// The last or next access of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ImageAccess {
    /// Newly created; contents undefined.
    Undefined,
    /// Written (and read, if loaded or blended) as a colour attachment.
    ColorAttachment,
    /// Written and tested as a depth attachment.
    DepthAttachment,
    /// Read through a sampler by a fragment or compute shader.
    Sampled,
    /// A depth image that is sampled, and possibly depth-tested, but not written.
    SampledDepth,
    /// Texels are written by a compute shader.
    StorageWrite,
    /// Source of a copy or blit.
    CopySource,
    /// Target of a copy or blit.
    CopyTarget,
    /// Acquired from the presentation engine: contents undefined, not accessible until its semaphore is signalled.
    Acquired,
    /// Released to the presentation engine.
    Present,
}

/// The last or next access of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BufferAccess {
    /// Target of a copy.
    CopyTarget,
    /// Vertex attributes of a draw; what copies have written is visible to shaders too.
    Vertex,
    /// Indices of a draw; what copies have written is visible to shaders too.
    Index,
    /// Read as a storage buffer by a shader.
    StorageRead,
    /// Read and written as a storage buffer by a compute shader.
    StorageWrite,
    /// Read by the CPU.
    HostRead,
}

/// A barrier between two accesses of an image, independent of the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageBarrier {
    /// Execution and memory dependency.
    pub memory: MemoryBarrier,
    /// Image layout before.
    pub old_layout: Layout,
    /// Image layout after.
    pub new_layout: Layout,
}

/// An execution and memory dependency.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryBarrier {
    /// Stages that must have finished.
    pub src_stage: Stage,
    /// Writes to make available.
    pub src_access: Access,
    /// Stages that wait.
    pub dst_stage: Stage,
    /// Accesses to which those writes become visible.
    pub dst_access: Access,
}

/// Stages of the depth test.
const DEPTH_TESTS: Stage =
    Stage::from_raw(Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw());
/// Stages that sample images.
const SAMPLING: Stage =
    Stage::from_raw(Stage::FRAGMENT_SHADER.as_raw() | Stage::COMPUTE_SHADER.as_raw());
/// Stages that read storage buffers.
const STORAGE_READING: Stage = Stage::from_raw(Stage::VERTEX_SHADER.as_raw() | SAMPLING.as_raw());

/// One row of the image table: stages, reads, writes, layout.
const fn row(of: ImageAccess) -> (Stage, Access, Access, Layout) {
    const NONE: Access = Access::NONE;
    match of {
        ImageAccess::Undefined => (Stage::NONE, NONE, NONE, Layout::UNDEFINED),
        ImageAccess::ColorAttachment => (
            Stage::COLOR_ATTACHMENT_OUTPUT,
            Access::COLOR_ATTACHMENT_READ,
            Access::COLOR_ATTACHMENT_WRITE,
            Layout::COLOR_ATTACHMENT_OPTIMAL,
        ),
        ImageAccess::DepthAttachment => (
            DEPTH_TESTS,
            Access::DEPTH_STENCIL_ATTACHMENT_READ,
            Access::DEPTH_STENCIL_ATTACHMENT_WRITE,
            Layout::DEPTH_ATTACHMENT_OPTIMAL,
        ),
        ImageAccess::Sampled => (
            SAMPLING,
            Access::SHADER_SAMPLED_READ,
            NONE,
            Layout::SHADER_READ_ONLY_OPTIMAL,
        ),
        ImageAccess::SampledDepth => (
            Stage::from_raw(SAMPLING.as_raw() | DEPTH_TESTS.as_raw()),
            Access::from_raw(
                Access::SHADER_SAMPLED_READ.as_raw()
                    | Access::DEPTH_STENCIL_ATTACHMENT_READ.as_raw(),
            ),
            NONE,
            Layout::DEPTH_READ_ONLY_OPTIMAL,
        ),
        ImageAccess::StorageWrite => {
            let write = Access::SHADER_STORAGE_WRITE;
            (Stage::COMPUTE_SHADER, NONE, write, Layout::GENERAL)
        }
        ImageAccess::CopySource => {
            let layout = Layout::TRANSFER_SRC_OPTIMAL;
            (Stage::TRANSFER, Access::TRANSFER_READ, NONE, layout)
        }
        ImageAccess::CopyTarget => {
            let layout = Layout::TRANSFER_DST_OPTIMAL;
            (Stage::TRANSFER, NONE, Access::TRANSFER_WRITE, layout)
        }
        // The submission waits on the semaphore at this stage, and the barrier chains with that wait.
        ImageAccess::Acquired => {
            let stage = Stage::COLOR_ATTACHMENT_OUTPUT;
            (stage, NONE, NONE, Layout::UNDEFINED)
        }
        ImageAccess::Present => (Stage::NONE, NONE, NONE, Layout::PRESENT_SRC_KHR),
    }
}

/// One row of the buffer table: stages, reads, writes.
const fn buffer_row(of: BufferAccess) -> (Stage, Access, Access) {
    match of {
        BufferAccess::CopyTarget => (Stage::TRANSFER, Access::NONE, Access::TRANSFER_WRITE),
        BufferAccess::Vertex => (
            Stage::from_raw(Stage::VERTEX_ATTRIBUTE_INPUT.as_raw() | STORAGE_READING.as_raw()),
            Access::from_raw(
                Access::VERTEX_ATTRIBUTE_READ.as_raw() | Access::SHADER_STORAGE_READ.as_raw(),
            ),
            Access::NONE,
        ),
        BufferAccess::Index => (
            Stage::from_raw(Stage::INDEX_INPUT.as_raw() | STORAGE_READING.as_raw()),
            Access::from_raw(Access::INDEX_READ.as_raw() | Access::SHADER_STORAGE_READ.as_raw()),
            Access::NONE,
        ),
        BufferAccess::StorageRead => (STORAGE_READING, Access::SHADER_STORAGE_READ, Access::NONE),
        BufferAccess::StorageWrite => (
            Stage::COMPUTE_SHADER,
            Access::SHADER_STORAGE_READ,
            Access::SHADER_STORAGE_WRITE,
        ),
        BufferAccess::HostRead => (Stage::HOST, Access::HOST_READ, Access::NONE),
    }
}

/// The layout of an image during an access.
pub const fn layout(of: ImageAccess) -> Layout {
    row(of).3
}

/// The barrier between two accesses of an image; `None` between reads in the same layout.
///
/// Read after write: waits for the write and makes it visible. Write after read: execution dependency only. Write after write:
/// both.
pub const fn barrier(previous: ImageAccess, next: ImageAccess) -> Option<ImageBarrier> {
    let (src_stage, _, src_writes, old_layout) = row(previous);
    let (dst_stage, dst_reads, dst_writes, new_layout) = row(next);
    let same_layout = old_layout.as_raw() == new_layout.as_raw();
    if same_layout && src_writes.is_empty() && dst_writes.is_empty() {
        return None;
    }
    Some(ImageBarrier {
        memory: MemoryBarrier {
            src_stage,
            src_access: src_writes,
            dst_stage,
            dst_access: Access::from_raw(dst_reads.as_raw() | dst_writes.as_raw()),
        },
        old_layout,
        new_layout,
    })
}

/// The barrier between two accesses of a buffer; `None` between reads. Same rules as [`barrier`].
pub const fn buffer_barrier(previous: BufferAccess, next: BufferAccess) -> Option<MemoryBarrier> {
    let (src_stage, _, src_access) = buffer_row(previous);
    let (dst_stage, dst_reads, dst_writes) = buffer_row(next);
    if src_access.is_empty() && dst_writes.is_empty() {
        return None;
    }
    Some(MemoryBarrier {
        src_stage,
        src_access,
        dst_stage,
        dst_access: Access::from_raw(dst_reads.as_raw() | dst_writes.as_raw()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ImageAccess; 10] = [
        ImageAccess::Undefined,
        ImageAccess::ColorAttachment,
        ImageAccess::DepthAttachment,
        ImageAccess::Sampled,
        ImageAccess::SampledDepth,
        ImageAccess::StorageWrite,
        ImageAccess::CopySource,
        ImageAccess::CopyTarget,
        ImageAccess::Acquired,
        ImageAccess::Present,
    ];

    fn expect(
        previous: ImageAccess,
        next: ImageAccess,
        stages: (Stage, Stage),
        accesses: (Access, Access),
    ) {
        let barrier = barrier(previous, next).expect("a barrier").memory;
        assert_eq!(
            (barrier.src_stage, barrier.dst_stage),
            stages,
            "{previous:?} -> {next:?}"
        );
        assert_eq!(
            (barrier.src_access, barrier.dst_access),
            accesses,
            "{previous:?} -> {next:?}"
        );
    }

    #[test]
    fn fresh_to_color_waits_for_nothing() {
        expect(
            ImageAccess::Undefined,
            ImageAccess::ColorAttachment,
            (Stage::NONE, Stage::COLOR_ATTACHMENT_OUTPUT),
            (
                Access::NONE,
                Access::COLOR_ATTACHMENT_READ | Access::COLOR_ATTACHMENT_WRITE,
            ),
        );
    }

    #[test]
    fn color_to_sampled_shows_the_write() {
        expect(
            ImageAccess::ColorAttachment,
            ImageAccess::Sampled,
            (
                Stage::COLOR_ATTACHMENT_OUTPUT,
                Stage::FRAGMENT_SHADER | Stage::COMPUTE_SHADER,
            ),
            (Access::COLOR_ATTACHMENT_WRITE, Access::SHADER_SAMPLED_READ),
        );
    }

    #[test]
    fn sampled_to_color_only_waits() {
        expect(
            ImageAccess::Sampled,
            ImageAccess::ColorAttachment,
            (
                Stage::FRAGMENT_SHADER | Stage::COMPUTE_SHADER,
                Stage::COLOR_ATTACHMENT_OUTPUT,
            ),
            (
                Access::NONE,
                Access::COLOR_ATTACHMENT_READ | Access::COLOR_ATTACHMENT_WRITE,
            ),
        );
    }

    #[test]
    fn color_to_color_keeps_order() {
        expect(
            ImageAccess::ColorAttachment,
            ImageAccess::ColorAttachment,
            (
                Stage::COLOR_ATTACHMENT_OUTPUT,
                Stage::COLOR_ATTACHMENT_OUTPUT,
            ),
            (
                Access::COLOR_ATTACHMENT_WRITE,
                Access::COLOR_ATTACHMENT_READ | Access::COLOR_ATTACHMENT_WRITE,
            ),
        );
    }

    #[test]
    fn depth_to_sampled_depth_shows_the_write_to_shaders_and_tests() {
        let tests = Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS;
        let shaders = Stage::FRAGMENT_SHADER | Stage::COMPUTE_SHADER;
        expect(
            ImageAccess::DepthAttachment,
            ImageAccess::SampledDepth,
            (tests, shaders | tests),
            (
                Access::DEPTH_STENCIL_ATTACHMENT_WRITE,
                Access::SHADER_SAMPLED_READ | Access::DEPTH_STENCIL_ATTACHMENT_READ,
            ),
        );
    }

    #[test]
    fn sampled_depth_to_depth_only_waits() {
        let tests = Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS;
        let shaders = Stage::FRAGMENT_SHADER | Stage::COMPUTE_SHADER;
        expect(
            ImageAccess::SampledDepth,
            ImageAccess::DepthAttachment,
            (shaders | tests, tests),
            (
                Access::NONE,
                Access::DEPTH_STENCIL_ATTACHMENT_READ | Access::DEPTH_STENCIL_ATTACHMENT_WRITE,
            ),
        );
    }

    #[test]
    fn stored_by_compute_then_sampled_and_back() {
        let reads = Stage::FRAGMENT_SHADER | Stage::COMPUTE_SHADER;
        expect(
            ImageAccess::StorageWrite,
            ImageAccess::Sampled,
            (Stage::COMPUTE_SHADER, reads),
            (Access::SHADER_STORAGE_WRITE, Access::SHADER_SAMPLED_READ),
        );
        expect(
            ImageAccess::Sampled,
            ImageAccess::StorageWrite,
            (reads, Stage::COMPUTE_SHADER),
            (Access::NONE, Access::SHADER_STORAGE_WRITE),
        );
    }

    #[test]
    fn upload_then_sample() {
        expect(
            ImageAccess::CopyTarget,
            ImageAccess::Sampled,
            (
                Stage::TRANSFER,
                Stage::FRAGMENT_SHADER | Stage::COMPUTE_SHADER,
            ),
            (Access::TRANSFER_WRITE, Access::SHADER_SAMPLED_READ),
        );
    }

    #[test]
    fn render_then_copy_out() {
        expect(
            ImageAccess::ColorAttachment,
            ImageAccess::CopySource,
            (Stage::COLOR_ATTACHMENT_OUTPUT, Stage::TRANSFER),
            (Access::COLOR_ATTACHMENT_WRITE, Access::TRANSFER_READ),
        );
    }

    #[test]
    fn copied_to_a_buffer_then_read() {
        let shaders = Stage::VERTEX_SHADER | Stage::FRAGMENT_SHADER | Stage::COMPUTE_SHADER;
        for (next, dst_stage, dst_access) in [
            (
                BufferAccess::Vertex,
                Stage::VERTEX_ATTRIBUTE_INPUT | shaders,
                Access::VERTEX_ATTRIBUTE_READ | Access::SHADER_STORAGE_READ,
            ),
            (
                BufferAccess::Index,
                Stage::INDEX_INPUT | shaders,
                Access::INDEX_READ | Access::SHADER_STORAGE_READ,
            ),
            (
                BufferAccess::StorageRead,
                shaders,
                Access::SHADER_STORAGE_READ,
            ),
            (BufferAccess::HostRead, Stage::HOST, Access::HOST_READ),
        ] {
            let expected = MemoryBarrier {
                src_stage: Stage::TRANSFER,
                src_access: Access::TRANSFER_WRITE,
                dst_stage,
                dst_access,
            };
            let barrier = buffer_barrier(BufferAccess::CopyTarget, next);
            assert_eq!(barrier, Some(expected), "{next:?}");
            assert_eq!(buffer_barrier(next, next), None, "{next:?}");
            let back = buffer_barrier(next, BufferAccess::CopyTarget).expect("a barrier");
            assert_eq!(back.src_access, Access::NONE, "{next:?}");
            assert_eq!(back.dst_access, Access::TRANSFER_WRITE, "{next:?}");
        }
    }

    #[test]
    fn color_to_present_shows_the_write_to_nobody() {
        expect(
            ImageAccess::ColorAttachment,
            ImageAccess::Present,
            (Stage::COLOR_ATTACHMENT_OUTPUT, Stage::NONE),
            (Access::COLOR_ATTACHMENT_WRITE, Access::NONE),
        );
    }

    #[test]
    fn acquired_images_wait_where_their_semaphore_is_waited_for() {
        let output = Stage::COLOR_ATTACHMENT_OUTPUT;
        let drawn = Access::COLOR_ATTACHMENT_READ | Access::COLOR_ATTACHMENT_WRITE;
        expect(
            ImageAccess::Acquired,
            ImageAccess::ColorAttachment,
            (output, output),
            (Access::NONE, drawn),
        );
    }

    #[test]
    fn reads_after_reads_of_one_layout_need_nothing() {
        for read in [
            ImageAccess::Sampled,
            ImageAccess::SampledDepth,
            ImageAccess::CopySource,
        ] {
            assert_eq!(barrier(read, read), None, "{read:?}");
        }
    }

    #[test]
    fn every_pair_that_writes_or_changes_layout_has_a_barrier() {
        for previous in ALL {
            for next in ALL {
                let (_, _, src_writes, old) = row(previous);
                let (_, _, dst_writes, new) = row(next);
                let needed = old != new || !src_writes.is_empty() || !dst_writes.is_empty();
                assert_eq!(
                    barrier(previous, next).is_some(),
                    needed,
                    "{previous:?} -> {next:?}"
                );
            }
        }
    }

    #[test]
    fn what_was_written_is_always_made_available() {
        for previous in [
            ImageAccess::ColorAttachment,
            ImageAccess::DepthAttachment,
            ImageAccess::CopyTarget,
        ] {
            for next in ALL {
                let barrier = barrier(previous, next).expect("a barrier after a write");
                let barrier = barrier.memory;
                assert!(!barrier.src_access.is_empty(), "{previous:?} -> {next:?}");
                assert!(!barrier.src_stage.is_empty(), "{previous:?} -> {next:?}");
            }
        }
    }
}
