//! Push constants word by word, to push those that differ.

use std::ops::Range;

use bytemuck::Pod;

/// Words of push constants that every device has room for.
const MOST: usize = 32;

/// A block of push constants.
#[derive(Clone, Copy)]
pub(in crate::gpu) struct PushWords {
    words: [u32; MOST],
    count: usize,
}

impl PushWords {
    /// No block.
    pub const NONE: Self = Self {
        words: [0; MOST],
        count: 0,
    };

    /// The words of a block.
    pub fn of<T: Pod>(value: &T) -> Self {
        const {
            assert!(
                size_of::<T>() <= 4 * MOST && size_of::<T>().is_multiple_of(4),
                "up to 32 words of push constants"
            );
        }
        let bytes = bytemuck::bytes_of(value);
        let mut this = Self::NONE;
        this.count = bytes.len() / 4;
        bytemuck::cast_slice_mut(&mut this.words)[..bytes.len()].copy_from_slice(bytes);
        this
    }

    /// Whether it has no words.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The bytes of some of its words.
    pub fn bytes(&self, words: Range<usize>) -> &[u8] {
        bytemuck::cast_slice(&self.words[words])
    }

    /// From the first to the last of the words in which it differs from another; all if that is not of its size.
    pub fn changed_from(&self, old: &Self) -> Range<usize> {
        if self.count != old.count {
            return 0..self.count;
        }
        let differs = |k: &usize| self.words[*k] != old.words[*k];
        let first = (0..self.count).find(differs).unwrap_or(self.count);
        let last = (first..self.count).rfind(differs);
        first..last.map_or(first, |last| last + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[repr(C)]
    #[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
    struct Block {
        a: f32,
        b: [f32; 2],
        c: u32,
    }

    #[test]
    fn of_a_block_only_what_changed_is_pushed() {
        let of = |a, b, c| PushWords::of(&Block { a, b, c });
        let first = of(1.0, [2.0, 3.0], 4);
        assert_eq!(first.changed_from(&PushWords::NONE), 0..4, "all at first");
        assert_eq!(first.changed_from(&first), 4..4);
        assert_eq!(of(1.0, [2.0, 3.0], 5).changed_from(&first), 3..4);
        assert_eq!(of(0.0, [2.0, 3.0], 4).changed_from(&first), 0..1);
        assert_eq!(of(1.0, [9.0, 3.0], 9).changed_from(&first), 1..4);
    }
}
