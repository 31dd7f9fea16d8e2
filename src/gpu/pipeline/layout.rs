//! Host structs and shader blocks: one table on each side, compared.

use bytemuck::Pod;

use crate::gpu::pipeline::shader::Field;

/// A host struct whose bytes a shader block (`layout(scalar)`) reads.
///
/// Implemented by the macro [`gpu_struct!`](crate::gpu_struct), which lists the members with their offsets.
pub trait GpuStruct: Pod {
    /// Members in order.
    const FIELDS: &'static [Field];
}

/// Defines a `#[repr(C)]` struct of plain numbers and vectors, and the table of its members for [`check_layout`].
#[macro_export]
macro_rules! gpu_struct {
    ($(#[$meta:meta])* $vis:vis struct $name:ident { $($(#[$field_meta:meta])* $field:ident : $ty:ty),* $(,)? }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        // The members are documented where they are declared first: in the shader's block of the same names.
        #[allow(missing_docs)]
        $vis struct $name { $($(#[$field_meta])* $vis $field: $ty),* }

        impl $crate::gpu::GpuStruct for $name {
            const FIELDS: &'static [$crate::gpu::Field] = &[$($crate::gpu::Field {
                name: stringify!($field),
                offset: std::mem::offset_of!($name, $field) as u32,
                size: std::mem::size_of::<$ty>() as u32,
            }),*];
        }
    };
}

/// Compares a host struct with the members a shader block declares.
///
/// # Errors
/// Says the first difference: a member's name, offset or size, or their number.
pub fn check_layout(host: &[Field], block: &[Field]) -> Result<(), String> {
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
    fn the_macro_lists_members() {
        gpu_struct! {
            struct Pair { a: f32, b: [f32; 3] }
        }
        assert_eq!(Pair::FIELDS, &[field("a", 0, 4), field("b", 4, 12)]);
    }
}
