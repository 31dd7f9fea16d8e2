//! glTF buffers and accessors. Every range is checked before anything is allocated.

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use base64::Engine;
use gltf::accessor::{Accessor, DataType, Dimensions};
use percent_encoding::percent_decode_str;

use crate::scene::builder::Builder;
use crate::scene::files::Lookup;
use crate::scene::texture::picture::EmbeddedImage;

/// The bytes of all buffers.
#[derive(Debug)]
pub struct Buffers(Vec<Rc<Vec<u8>>>);

/// What a URI refers to.
pub enum Uri {
    /// Bytes embedded in the URI.
    Data(Vec<u8>),
    /// A file.
    File(Lookup),
}

/// Resolves a URI of the model at `path`.
pub fn resolve(builder: &Builder, path: &Path, uri: &str) -> Result<Uri, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, text) = data.split_once(',').ok_or("a data URI has no comma")?;
        if !kind.ends_with(";base64") {
            return Err("a data URI is not base64".to_owned());
        }
        let bytes = base64::engine::general_purpose::STANDARD.decode(text);
        return bytes
            .map(Uri::Data)
            .map_err(|_| "a data URI has invalid base64".to_owned());
    }
    let name = percent_decode_str(uri).decode_utf8_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    Ok(Uri::File(builder.files.find(folder, &name)))
}

impl Buffers {
    /// Reads all buffers. Buffers with the same source share their bytes.
    pub fn read<'a>(builder: &Builder, path: &Path, gltf: &'a gltf::Gltf) -> Result<Self, String> {
        // A malicious file could name the same source a thousand times.
        let mut known: HashMap<Option<&str>, Rc<Vec<u8>>> = HashMap::new();
        let blob = gltf.blob.clone().map(|blob| (None, Rc::new(blob)));
        known.extend(blob);
        let mut read = |buffer: gltf::Buffer<'a>| {
            let uri = match buffer.source() {
                gltf::buffer::Source::Bin => None,
                gltf::buffer::Source::Uri(uri) => Some(uri),
            };
            let bytes = match (known.get(&uri), uri) {
                (Some(bytes), _) => bytes.clone(),
                (None, None) => return Err("the binary chunk is missing".to_owned()),
                (None, Some(text)) => Rc::new(read_uri(builder, path, text)?),
            };
            known.insert(uri, bytes.clone());
            if bytes.len() < buffer.length() {
                return Err(format!("buffer {} is truncated", buffer.index()));
            }
            Ok(bytes)
        };
        gltf.buffers()
            .map(&mut read)
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// An image stored in a buffer view.
    pub fn picture(&self, view: &gltf::buffer::View<'_>) -> Result<EmbeddedImage, String> {
        let length = self.view(view)?.len();
        Ok(EmbeddedImage {
            bytes: self.0[view.buffer().index()].clone(),
            range: view.offset()..view.offset() + length,
        })
    }

    /// The bytes of a buffer view.
    pub fn view(&self, view: &gltf::buffer::View<'_>) -> Result<&[u8], String> {
        let end = view.offset().checked_add(view.length());
        let bytes = self.0.get(view.buffer().index());
        end.and_then(|end| bytes?.get(view.offset()..end))
            .ok_or_else(|| format!("buffer view {} exceeds its buffer", view.index()))
    }

    /// Reads at most `limit` elements of an accessor as `N` numbers each. Missing components are 0; normalised integers map to
    /// 0..1 or −1..1.
    pub fn floats<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        limit: usize,
    ) -> Result<Vec<[f32; N]>, String> {
        let layout = Layout::of(accessor, limit)?;
        let read = |bytes: &[u8]| {
            let number = |i: usize| {
                let at = i * layout.size;
                number(
                    &bytes[at..at + layout.size],
                    layout.kind,
                    accessor.normalized(),
                )
            };
            std::array::from_fn(|i| if i < layout.width { number(i) } else { 0.0 })
        };
        let mut values = match accessor.view() {
            Some(view) => {
                let bytes = self.elements(&view, accessor.offset(), &layout)?;
                bytes.map(read).collect()
            }
            None => vec![[0.0; N]; layout.count],
        };
        self.replace_sparse(accessor, &layout, &mut values, read)?;
        Ok(values)
    }

    /// Reads at most `limit` indices from an accessor.
    pub fn indices(&self, accessor: &Accessor<'_>, limit: usize) -> Result<Vec<u32>, String> {
        let layout = Layout::of(accessor, limit)?;
        let kind = layout.kind;
        let view = accessor.view();
        let (1, Some(view), None) = (layout.width, view, accessor.sparse()) else {
            return Err("the indices have an unsupported type".to_owned());
        };
        let elements = self.elements(&view, accessor.offset(), &layout)?;
        Ok(elements.map(|bytes| index(bytes, kind)).collect())
    }

    fn replace_sparse<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        layout: &Layout,
        values: &mut [[f32; N]],
        read: impl Fn(&[u8]) -> [f32; N],
    ) -> Result<(), String> {
        let Some(sparse) = accessor.sparse() else {
            return Ok(());
        };
        let count = sparse.count();
        if count > layout.count {
            return Err(format!(
                "accessor {} replaces more elements than it has",
                accessor.index()
            ));
        }
        let (kind, places) = (sparse.indices().index_type(), sparse.indices());
        let (kind, size) = match kind {
            gltf::accessor::sparse::IndexType::U8 => (DataType::U8, 1),
            gltf::accessor::sparse::IndexType::U16 => (DataType::U16, 2),
            gltf::accessor::sparse::IndexType::U32 => (DataType::U32, 4),
        };
        let index_layout = Layout {
            count,
            kind,
            size,
            width: 1,
        };
        let value_layout = Layout { count, ..*layout };
        let places = self.elements(&places.view(), places.offset(), &index_layout)?;
        let values_at = self.elements(
            &sparse.values().view(),
            sparse.values().offset(),
            &value_layout,
        )?;
        for (place, new) in places.zip(values_at) {
            let value = values.get_mut(index(place, kind) as usize);
            *value.ok_or_else(|| {
                format!(
                    "accessor {} replaces an element that does not exist",
                    accessor.index()
                )
            })? = read(new);
        }
        Ok(())
    }

    /// The bytes of each element.
    fn elements<'b>(
        &'b self,
        view: &gltf::buffer::View<'_>,
        offset: usize,
        layout: &Layout,
    ) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, String> {
        let element = layout.size * layout.width;
        let stride = view.stride().unwrap_or(element).max(1);
        let needed = (layout.count.max(1) - 1)
            .checked_mul(stride)
            .and_then(|n| n.checked_add(element));
        let bytes = self.view(view)?;
        let bytes = bytes.get(offset..).unwrap_or_default();
        if needed.is_none_or(|needed| needed > bytes.len()) || stride < element {
            return Err(format!("an accessor exceeds buffer view {}", view.index()));
        }
        let count = layout.count;
        Ok((0..count).map(move |i| &bytes[i * stride..i * stride + element]))
    }
}

/// Reads all bytes a URI refers to.
fn read_uri(builder: &Builder, path: &Path, uri: &str) -> Result<Vec<u8>, String> {
    match resolve(builder, path, uri)? {
        Uri::Data(bytes) => Ok(bytes),
        Uri::File(Lookup::Found(file)) => builder.files.read(&file).map_err(|e| e.to_string()),
        Uri::File(Lookup::Missing(file)) => Err(format!("{} is missing", file.display())),
        Uri::File(Lookup::Outside(file)) => Err(format!(
            "{} is outside the model's folder; pass --allow-outside to allow it",
            file.display()
        )),
    }
}

/// Memory layout of an accessor's elements.
#[derive(Debug, Clone, Copy)]
struct Layout {
    count: usize,
    kind: DataType,
    /// Bytes per component.
    size: usize,
    /// Components per element.
    width: usize,
}

impl Layout {
    fn of(accessor: &Accessor<'_>, limit: usize) -> Result<Self, String> {
        let count = accessor.count();
        if count > limit {
            let index = accessor.index();
            return Err(format!(
                "accessor {index} has {count} elements, the limit is {limit}"
            ));
        }
        let width = match accessor.dimensions() {
            Dimensions::Scalar => 1,
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            _ => return Err(format!("accessor {} has a matrix type", accessor.index())),
        };
        Ok(Self {
            count,
            kind: accessor.data_type(),
            size: accessor.data_type().size(),
            width,
        })
    }
}

fn index(bytes: &[u8], kind: DataType) -> u32 {
    match (kind, bytes) {
        (DataType::U8, [a]) => u32::from(*a),
        (DataType::U16, [a, b]) => u32::from(u16::from_le_bytes([*a, *b])),
        (DataType::U32, [a, b, c, d]) => u32::from_le_bytes([*a, *b, *c, *d]),
        // An invalid index, so that the mesh is rejected.
        _ => u32::MAX,
    }
}

/// Conversion of normalised integers: glTF 2.0, section 3.11.
fn number(bytes: &[u8], kind: DataType, normalised: bool) -> f32 {
    let (value, largest) = match (kind, bytes) {
        (DataType::F32, [a, b, c, d]) => return f32::from_le_bytes([*a, *b, *c, *d]),
        (DataType::I8, [a]) => (f32::from(*a as i8), 127.0),
        (DataType::I16, [a, b]) => (f32::from(i16::from_le_bytes([*a, *b])), 32_767.0),
        (DataType::U8, _) => (index(bytes, kind) as f32, 255.0),
        (DataType::U16, _) => (index(bytes, kind) as f32, 65_535.0),
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
        assert_eq!(number(&1.5f32.to_le_bytes(), DataType::F32, false), 1.5);
        assert_eq!(number(&[255], DataType::U8, true), 1.0);
        assert_eq!(number(&[0x81], DataType::I8, true), -1.0);
        assert_eq!(number(&[0x80], DataType::I8, true), -1.0, "−128 is clamped");
        assert_eq!(number(&[0xff, 0xff], DataType::U16, true), 1.0);
        assert_eq!(number(&[0x01, 0x80], DataType::I16, true), -1.0);
        assert_eq!(number(&[7, 0], DataType::U16, false), 7.0);
        assert_eq!(index(&[1, 2], DataType::U16), 0x0201);
        assert_eq!(index(&[1, 2], DataType::U8), u32::MAX);
    }
}
