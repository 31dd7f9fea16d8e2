//! Accessors: how the elements of a buffer view are laid out and read.

use crate::scene::gltf::item::Item;

/// Number and size of elements, bytes.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    pub count: usize,
    pub element: usize,
}

/// Type of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Kind {
    pub fn of(item: Item<'_>) -> Option<Self> {
        Some(match item.index()? {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// A checked accessor.
#[derive(Debug, Clone, Copy)]
pub struct Accessor<'j> {
    pub number: usize,
    /// Number of elements.
    pub count: usize,
    pub kind: Kind,
    /// Components of an element.
    pub width: usize,
    pub normalised: bool,
    /// `None` for zeros.
    pub view: Option<usize>,
    pub offset: usize,
    pub sparse: Item<'j>,
}

impl<'j> Accessor<'j> {
    pub fn of(item: Item<'j>, number: usize) -> Option<Self> {
        let kind = Kind::of(item.get("componentType"))?;
        let width = match item.get("type").text()? {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            // Smaller types and matrices have padded columns; nothing that is drawn has them.
            "MAT4" if kind == Kind::F32 => 16,
            _ => return None,
        };
        let view = item.get("bufferView");
        Some(Self {
            number,
            count: item.get("count").index()?,
            kind,
            width,
            normalised: item.get("normalized").flag().unwrap_or(false),
            view: if view.exists() {
                Some(view.index()?)
            } else {
                None
            },
            offset: item.get("byteOffset").index_or(0)?,
            sparse: item.get("sparse"),
        })
    }

    pub fn layout(&self) -> Layout {
        Layout {
            count: self.count,
            element: self.kind.size() * self.width,
        }
    }
}

/// An index; the largest number, so that it is not used, for other types.
pub fn index(bytes: &[u8], kind: Kind) -> u32 {
    match (kind, bytes) {
        (Kind::U8, [a]) => u32::from(*a),
        (Kind::U16, [a, b]) => u32::from(u16::from_le_bytes([*a, *b])),
        (Kind::U32, [a, b, c, d]) => u32::from_le_bytes([*a, *b, *c, *d]),
        _ => u32::MAX,
    }
}

/// Conversion of normalised integers: glTF 2.0, section 3.11.
pub fn number_of(bytes: &[u8], kind: Kind, normalised: bool) -> f32 {
    let (value, largest) = match (kind, bytes) {
        (Kind::F32, [a, b, c, d]) => return f32::from_le_bytes([*a, *b, *c, *d]),
        (Kind::I8, [a]) => (f32::from(*a as i8), 127.0),
        (Kind::I16, [a, b]) => (f32::from(i16::from_le_bytes([*a, *b])), 32_767.0),
        (Kind::U8, _) => (index(bytes, kind) as f32, 255.0),
        (Kind::U16, _) => (index(bytes, kind) as f32, 65_535.0),
        _ => (index(bytes, kind) as f32, 4_294_967_295.0),
    };
    if normalised {
        (value / largest).max(-1.0)
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_kind() {
        assert_eq!(number_of(&1.5f32.to_le_bytes(), Kind::F32, false), 1.5);
        assert_eq!(number_of(&[255], Kind::U8, true), 1.0);
        assert_eq!(number_of(&[0x81], Kind::I8, true), -1.0);
        assert_eq!(number_of(&[0x80], Kind::I8, true), -1.0, "−128 is clamped");
        assert_eq!(number_of(&[0xff, 0xff], Kind::U16, true), 1.0);
        assert_eq!(number_of(&[0x01, 0x80], Kind::I16, true), -1.0);
        assert_eq!(number_of(&[7, 0], Kind::U16, false), 7.0);
        assert_eq!(index(&[1, 2], Kind::U16), 0x0201);
        assert_eq!(index(&[1, 2], Kind::U8), u32::MAX);
    }
}
