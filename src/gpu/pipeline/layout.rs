//! Comparison of host structs with the shader blocks that read them.

use bytemuck::Pod;

use crate::gpu::pipeline::shader::{Field, Shader, text_equals};

/// A host struct whose bytes are read by a shader block (`layout(scalar)`).
///
/// Implemented by [`gpu_struct!`](crate::gpu_struct), which lists the members with their offsets.
pub trait GpuStruct: Pod {
    /// Members in declaration order.
    const FIELDS: &'static [Field];
}

/// Defines a `#[repr(C)]` struct of plain numbers and vectors that mirrors a shader block, and compares the two at compile
/// time. Syntax: `struct NAME: BLOCK of STAGE, ...`, where `BLOCK` is the name of a uniform block or `push`, and the stages are
/// those of [`shaders`](crate::gpu::shaders) that declare it.
///
/// Reordered members do not compile:
/// ```compile_fail
/// skylight::gpu_struct! {
///     struct Samples: push of IRRADIANCE_FRAG { count: u32, first: u32 }
/// }
/// ```
/// The block as the shader declares it:
/// ```
/// skylight::gpu_struct! {
///     struct Samples: push of IRRADIANCE_FRAG { first: u32, count: u32 }
/// }
/// ```
#[macro_export]
macro_rules! gpu_struct {
    ($(#[$meta:meta])* $vis:vis struct $name:ident : $block:ident of $($stage:ident),+ {
        $($(#[$field_meta:meta])* $field:ident : $ty:ty),* $(,)?
    }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        // The members are documented in the shader block, under the same names.
        #[allow(missing_docs)]
        $vis struct $name { $($(#[$field_meta])* $vis $field: $ty),* }

        impl $crate::gpu::GpuStruct for $name {
            const FIELDS: &'static [$crate::gpu::Field] = &[$($crate::gpu::Field {
                name: stringify!($field),
                offset: std::mem::offset_of!($name, $field) as u32,
                size: std::mem::size_of::<$ty>() as u32,
            }),*];
        }

        $(const _: () = $crate::gpu::assert_layout(
            <$name as $crate::gpu::GpuStruct>::FIELDS,
            stringify!($block),
            &$crate::gpu::shaders::$stage,
        );)+
    };
}

/// Compares a host struct with a block of a stage, at compile time.
///
/// # Panics
/// With the name of the first member whose name, offset or size differs.
pub const fn assert_layout(host: &[Field], block: &str, stage: &Shader) {
    let Some(members) = stage.block(block) else {
        panic!("the stage declares no block of this name");
    };
    if let Some(member) = first_difference(host, members) {
        panic!("{}", member);
    }
}

/// Name of the first member that differs between a host struct and a shader block.
const fn first_difference(host: &[Field], block: &[Field]) -> Option<&'static str> {
    let mut i = 0;
    while i < host.len() && i < block.len() {
        let (h, s) = (host[i], block[i]);
        if !text_equals(h.name, s.name) || h.offset != s.offset || h.size != s.size {
            return Some(h.name);
        }
        i += 1;
    }
    if i < host.len() {
        Some(host[i].name)
    } else if i < block.len() {
        Some(block[i].name)
    } else {
        None
    }
}

/// Compares a host struct with the members of a shader block.
///
/// # Errors
/// Describes the first difference: name, offset or size of a member, or the number of members.
pub(in crate::gpu) fn check_layout(host: &[Field], block: &[Field]) -> Result<(), String> {
    for (h, s) in host.iter().zip(block) {
        if h != s {
            return Err(format!("host {h:?} but shader {s:?}"));
        }
    }
    if host.len() == block.len() {
        Ok(())
    } else {
        Err(format!(
            "host has {} members, shader {}",
            host.len(),
            block.len()
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn field(name: &'static str, offset: u32, size: u32) -> Field {
        Field { name, offset, size }
    }

    #[test]
    fn differences_are_named() {
        let a = [field("x", 0, 4), field("y", 4, 12)];
        assert_eq!(check_layout(&a, &a), Ok(()));
        assert!(check_layout(&a, &a[..1]).is_err_and(|e| e.contains("2 members")));
        let swapped = [field("y", 0, 12), field("x", 12, 4)];
        assert!(check_layout(&a, &swapped).is_err_and(|e| e.contains("\"x\"")));
    }

    #[test]
    fn the_first_difference_is_found_in_names_offsets_sizes_and_number() {
        let host = [field("x", 0, 4), field("y", 4, 12)];
        assert_eq!(first_difference(&host, &host), None);
        let others = [
            [field("x", 0, 4), field("z", 4, 12)],
            [field("x", 0, 4), field("y", 8, 12)],
            [field("x", 0, 4), field("y", 4, 8)],
        ];
        for block in others {
            assert_eq!(first_difference(&host, &block), Some("y"), "{block:?}");
        }
        assert_eq!(first_difference(&host, &host[..1]), Some("y"));
        assert_eq!(first_difference(&host[..1], &host), Some("y"));
    }
}
