//! What the C library does with the memory that a driver frees.

/// Freed memory, bytes, up to which it stays with the process.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const KEPT: i32 = 256 << 20;

/// Blocks from this size on are given back all the same, bytes.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const LARGE: i32 = 32 << 20;

/// Lets the process keep what is freed. A software driver takes memory for the triangles of each frame and frees it again; glibc
/// by default gives that back to the system each time, and each frame waits for a new page wherever it first writes: a sixth of
/// the time of G-buffer and shadow map of 100 000 triangles. Elsewhere it does nothing.
pub(in crate::gpu) fn keep_freed_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    for (parameter, bytes) in [
        (libc::M_TRIM_THRESHOLD, KEPT),
        // Setting the one stops glibc from adjusting the other.
        (libc::M_MMAP_THRESHOLD, LARGE),
    ] {
        // SAFETY: mallopt changes parameters of the allocator under its own lock; both are meant to be changed, at any time.
        // Refused, it changes nothing.
        unsafe { libc::mallopt(parameter, bytes) };
    }
}
