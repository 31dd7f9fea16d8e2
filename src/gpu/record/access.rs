//! Barriers as a table: one pure function turns (previous use, next use) into a barrier.

use ash::vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};

/// What an image (or the memory of a buffer) was last, or will next be, used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Use {
    /// Fresh: no content.
    Undefined,
    /// Written (and read, when loaded or blended) as a colour attachment.
    ColorAttachment,
    /// Written and tested as a depth attachment.
    DepthAttachment,
    /// Read through a sampler by a fragment or compute shader.
    Sampled,
    /// A depth image read through a sampler, and perhaps tested against without being written.
    SampledDepth,
    /// Written by a compute shader, every texel.
    StorageWrite,
    /// Source of a copy or blit.
    CopySource,
    /// Target of a copy or blit.
    CopyTarget,
    /// Read by the CPU.
    HostRead,
    /// Given by the presentation engine: no content, and not to be touched before its semaphore has been waited for.
    Acquired,
    /// Handed to the presentation engine.
    Present,
}

/// A barrier without its image: what must have happened, and before what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Barrier {
    /// Stages that must have finished.
    pub src_stage: Stage,
    /// Writes that must be visible.
    pub src_access: Access,
    /// Stages that wait.
    pub dst_stage: Stage,
    /// Accesses that see the writes.
    pub dst_access: Access,
    /// Image layout before.
    pub old_layout: Layout,
    /// Image layout after.
    pub new_layout: Layout,
}

/// One row of the table: stages, reads, writes, layout.
const fn row(of: Use) -> (Stage, Access, Access, Layout) {
    match of {
        Use::Undefined => (Stage::NONE, Access::NONE, Access::NONE, Layout::UNDEFINED),
        Use::ColorAttachment => (
            Stage::COLOR_ATTACHMENT_OUTPUT,
            Access::COLOR_ATTACHMENT_READ,
            Access::COLOR_ATTACHMENT_WRITE,
            Layout::COLOR_ATTACHMENT_OPTIMAL,
        ),
        Use::DepthAttachment => (
            Stage::from_raw(
                Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw(),
            ),
            Access::DEPTH_STENCIL_ATTACHMENT_READ,
            Access::DEPTH_STENCIL_ATTACHMENT_WRITE,
            Layout::DEPTH_ATTACHMENT_OPTIMAL,
        ),
        Use::Sampled => (
            Stage::from_raw(Stage::FRAGMENT_SHADER.as_raw() | Stage::COMPUTE_SHADER.as_raw()),
            Access::SHADER_SAMPLED_READ,
            Access::NONE,
            Layout::SHADER_READ_ONLY_OPTIMAL,
        ),
        Use::SampledDepth => (
            Stage::from_raw(
                Stage::FRAGMENT_SHADER.as_raw()
                    | Stage::COMPUTE_SHADER.as_raw()
                    | Stage::EARLY_FRAGMENT_TESTS.as_raw()
                    | Stage::LATE_FRAGMENT_TESTS.as_raw(),
            ),
            Access::from_raw(
                Access::SHADER_SAMPLED_READ.as_raw()
                    | Access::DEPTH_STENCIL_ATTACHMENT_READ.as_raw(),
            ),
            Access::NONE,
            Layout::DEPTH_READ_ONLY_OPTIMAL,
        ),
        Use::StorageWrite => (
            Stage::COMPUTE_SHADER,
            Access::NONE,
            Access::SHADER_STORAGE_WRITE,
            Layout::GENERAL,
        ),
        Use::CopySource => (
            Stage::TRANSFER,
            Access::TRANSFER_READ,
            Access::NONE,
            Layout::TRANSFER_SRC_OPTIMAL,
        ),
        Use::CopyTarget => (
            Stage::TRANSFER,
            Access::NONE,
            Access::TRANSFER_WRITE,
            Layout::TRANSFER_DST_OPTIMAL,
        ),
        Use::HostRead => (
            Stage::HOST,
            Access::HOST_READ,
            Access::NONE,
            Layout::GENERAL,
        ),
        // The submission waits for the semaphore at this stage: the barrier chains to it.
        Use::Acquired => (
            Stage::COLOR_ATTACHMENT_OUTPUT,
            Access::NONE,
            Access::NONE,
            Layout::UNDEFINED,
        ),
        Use::Present => (
            Stage::NONE,
            Access::NONE,
            Access::NONE,
            Layout::PRESENT_SRC_KHR,
        ),
    }
}

/// The layout in which an image is used.
pub const fn layout(of: Use) -> Layout {
    row(of).3
}

/// The barrier between two uses, or `None` when reads follow reads in the same layout.
///
/// A read after a write waits for the write and sees it; a write after a read only waits; a write after a write
/// does both.
pub const fn barrier(previous: Use, next: Use) -> Option<Barrier> {
    let (src_stage, _, src_writes, old_layout) = row(previous);
    let (dst_stage, dst_reads, dst_writes, new_layout) = row(next);
    let same_layout = old_layout.as_raw() == new_layout.as_raw();
    if same_layout && src_writes.is_empty() && dst_writes.is_empty() {
        return None;
    }
    Some(Barrier {
        src_stage,
        src_access: src_writes,
        dst_stage,
        dst_access: Access::from_raw(dst_reads.as_raw() | dst_writes.as_raw()),
        old_layout,
        new_layout,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Use; 11] = [
        Use::Undefined,
        Use::ColorAttachment,
        Use::DepthAttachment,
        Use::Sampled,
        Use::SampledDepth,
        Use::StorageWrite,
        Use::CopySource,
        Use::CopyTarget,
        Use::HostRead,
        Use::Acquired,
        Use::Present,
    ];

    fn expect(previous: Use, next: Use, stages: (Stage, Stage), accesses: (Access, Access)) {
        let barrier = barrier(previous, next).expect("a barrier");
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
            Use::Undefined,
            Use::ColorAttachment,
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
            Use::ColorAttachment,
            Use::Sampled,
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
            Use::Sampled,
            Use::ColorAttachment,
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
            Use::ColorAttachment,
            Use::ColorAttachment,
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
            Use::DepthAttachment,
            Use::SampledDepth,
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
            Use::SampledDepth,
            Use::DepthAttachment,
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
            Use::StorageWrite,
            Use::Sampled,
            (Stage::COMPUTE_SHADER, reads),
            (Access::SHADER_STORAGE_WRITE, Access::SHADER_SAMPLED_READ),
        );
        expect(
            Use::Sampled,
            Use::StorageWrite,
            (reads, Stage::COMPUTE_SHADER),
            (Access::NONE, Access::SHADER_STORAGE_WRITE),
        );
    }

    #[test]
    fn upload_then_sample() {
        expect(
            Use::CopyTarget,
            Use::Sampled,
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
            Use::ColorAttachment,
            Use::CopySource,
            (Stage::COLOR_ATTACHMENT_OUTPUT, Stage::TRANSFER),
            (Access::COLOR_ATTACHMENT_WRITE, Access::TRANSFER_READ),
        );
    }

    #[test]
    fn copied_then_read_on_the_host() {
        expect(
            Use::CopyTarget,
            Use::HostRead,
            (Stage::TRANSFER, Stage::HOST),
            (Access::TRANSFER_WRITE, Access::HOST_READ),
        );
    }

    #[test]
    fn color_to_present_shows_the_write_to_nobody() {
        expect(
            Use::ColorAttachment,
            Use::Present,
            (Stage::COLOR_ATTACHMENT_OUTPUT, Stage::NONE),
            (Access::COLOR_ATTACHMENT_WRITE, Access::NONE),
        );
    }

    #[test]
    fn acquired_images_wait_where_their_semaphore_is_waited_for() {
        let output = Stage::COLOR_ATTACHMENT_OUTPUT;
        let drawn = Access::COLOR_ATTACHMENT_READ | Access::COLOR_ATTACHMENT_WRITE;
        expect(
            Use::Acquired,
            Use::ColorAttachment,
            (output, output),
            (Access::NONE, drawn),
        );
    }

    #[test]
    fn reads_after_reads_of_one_layout_need_nothing() {
        for read in [
            Use::Sampled,
            Use::SampledDepth,
            Use::CopySource,
            Use::HostRead,
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
        for previous in [Use::ColorAttachment, Use::DepthAttachment, Use::CopyTarget] {
            for next in ALL {
                let barrier = barrier(previous, next).expect("a barrier after a write");
                assert!(!barrier.src_access.is_empty(), "{previous:?} -> {next:?}");
                assert!(!barrier.src_stage.is_empty(), "{previous:?} -> {next:?}");
            }
        }
    }
}
