//! glTF buffers, views and accessors. Every range is checked before anything is allocated; a buffer that is missing or cut off
//! costs only what lies in it.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::rc::Rc;

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

use crate::scene::builder::Builder;
use crate::scene::files::Lookup;
use crate::scene::gltf::accessor::{Accessor, Kind, Layout, index, number_of};
use crate::scene::gltf::item::Item;
use crate::scene::gltf::meshopt::{Plan, compression};
use crate::scene::losses::shortened;
use crate::scene::texture::picture::EmbeddedImage;

/// Limit on all decompressed views together, bytes.
const MAX_DECOMPRESSED: usize = 2 << 30;

/// Bytes that several parts may share, or why they cannot be read.
type Shared = Result<Rc<Vec<u8>>, String>;

/// The buffers of a file, and its accessors.
#[derive(Debug)]
pub struct Buffers<'j> {
    root: Item<'j>,
    bytes: Vec<Shared>,
    /// Views that were decompressed.
    decompressed: RefCell<HashMap<usize, Shared>>,
    decompressed_left: Cell<usize>,
}

/// What a URI refers to.
pub enum Uri {
    /// Bytes embedded in the URI.
    Data(Vec<u8>),
    /// A file.
    File(Lookup),
}

/// Base64 with or without padding: some exporters leave it out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// Resolves a URI of the model at `path`.
pub fn resolve(builder: &Builder, path: &Path, uri: &str) -> Result<Uri, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, text) = data.split_once(',').ok_or("a data URI has no comma")?;
        if !kind.ends_with(";base64") {
            return Ok(Uri::Data(percent_decode_str(text).collect()));
        }
        let has_blanks = text.contains(|c: char| c.is_ascii_whitespace() || "-_%".contains(c));
        let bytes = if has_blanks {
            let plain = percent_decode_str(text).decode_utf8_lossy();
            let plain: String = plain.split_ascii_whitespace().collect();
            BASE64.decode(plain.replace('-', "+").replace('_', "/"))
        } else {
            BASE64.decode(text)
        };
        return bytes
            .map(Uri::Data)
            .map_err(|_| "a data URI has invalid base64".to_owned());
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    Ok(Uri::File(builder.files.find_uri(folder, uri)))
}

/// A range of bytes that holds elements.
struct View {
    bytes: Rc<Vec<u8>>,
    range: Range<usize>,
    /// Bytes from one element to the next; `None` if they are packed.
    stride: Option<usize>,
}

impl<'j> Buffers<'j> {
    /// Reads all buffers. Buffers with the same source share their bytes.
    pub fn read(builder: &Builder, path: &Path, root: Item<'j>, binary: Option<Vec<u8>>) -> Self {
        // A malicious file could name the same source a thousand times.
        let mut known: HashMap<Option<&str>, Shared> = HashMap::new();
        let missing = || "a buffer without a URI needs the binary chunk of a GLB".to_owned();
        known.insert(None, binary.map(Rc::new).ok_or_else(missing));
        let buffers = root.get("buffers").items().map(|buffer| {
            let uri = buffer.get("uri").text();
            let read = || read_uri(builder, path, uri.unwrap_or_default()).map(Rc::new);
            known.entry(uri).or_insert_with(read).clone()
        });
        Self {
            root,
            bytes: buffers.collect(),
            decompressed: RefCell::default(),
            decompressed_left: Cell::new(MAX_DECOMPRESSED),
        }
    }

    /// An image stored in a buffer view.
    pub fn picture(&self, view: usize) -> Result<EmbeddedImage, String> {
        let View { bytes, range, .. } = self.view(view)?;
        Ok(EmbeddedImage { bytes, range })
    }

    fn view(&self, number: usize) -> Result<View, String> {
        let view = self.root.get("bufferViews").at(number);
        if !view.exists() {
            return Err(format!("bufferViews[{number}] does not exist"));
        }
        let Some(extension) = compression(view) else {
            let (bytes, range) = self.range(number, view)?;
            let stride = view.get("byteStride").index().filter(|stride| *stride > 0);
            return Ok(View {
                bytes,
                range,
                stride,
            });
        };
        let (bytes, range) = self.range(number, extension)?;
        let plan = Plan::of(extension, range.len())
            .ok_or_else(|| format!("bufferViews[{number}] has an unknown compression"))?;
        let mut known = self.decompressed.borrow_mut();
        let decode = || {
            let size = plan.bytes().unwrap_or(usize::MAX);
            let left = self.decompressed_left.get().checked_sub(size);
            let damaged = format!("the compressed bufferViews[{number}] is damaged");
            self.decompressed_left
                .set(left.ok_or("too much is compressed")?);
            plan.decode(&bytes[range]).map(Rc::new).ok_or(damaged)
        };
        let bytes = known.entry(number).or_insert_with(decode).clone()?;
        Ok(View {
            range: 0..bytes.len(),
            bytes,
            stride: Some(plan.stride),
        })
    }

    /// The buffer of a view or of its compressed form, and the range in it.
    fn range(&self, number: usize, view: Item<'_>) -> Result<(Rc<Vec<u8>>, Range<usize>), String> {
        let range = || {
            let start = view.get("byteOffset").index_or(0)?;
            let end = start.checked_add(view.get("byteLength").index()?)?;
            Some(start..end)
        };
        let range = range().ok_or_else(|| format!("bufferViews[{number}] has no valid range"))?;
        let buffer = view.get("buffer").index().and_then(|i| self.bytes.get(i));
        let bytes = buffer
            .ok_or_else(|| format!("bufferViews[{number}] has no buffer"))?
            .clone()?;
        if range.end > bytes.len() {
            return Err(format!(
                "bufferViews[{number}] exceeds its buffer, which may be cut off"
            ));
        }
        Ok((bytes, range))
    }

    /// An accessor of at most `limit` elements.
    pub fn accessor(&self, number: usize, limit: usize) -> Result<Accessor<'j>, String> {
        let item = self.root.get("accessors").at(number);
        if !item.exists() {
            return Err(format!("accessors[{number}] does not exist"));
        }
        let accessor = Accessor::of(item, number)
            .ok_or_else(|| format!("accessors[{number}] has no valid type, count or offset"))?;
        if accessor.count > limit {
            let count = accessor.count;
            return Err(format!(
                "accessors[{number}] has {count} elements, the limit is {limit}"
            ));
        }
        Ok(accessor)
    }

    /// Reads an accessor as `N` numbers for each element. Missing components are 0; normalised integers map to 0..1 or −1..1.
    pub fn floats<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[f32; N]>, String> {
        let (kind, width) = (accessor.kind, accessor.width);
        let read = |bytes: &[u8]| {
            let number = |i: usize| {
                let at = i * kind.size();
                number_of(&bytes[at..at + kind.size()], kind, accessor.normalised)
            };
            std::array::from_fn(|i| if i < width { number(i) } else { 0.0 })
        };
        let mut values = match accessor.view {
            Some(view) => {
                let elements = self.elements(view, accessor.offset, accessor.layout())?;
                elements.map(read)
            }
            None => vec![[0.0; N]; accessor.count],
        };
        self.replace_sparse(accessor, &mut values, read)?;
        Ok(values)
    }

    /// At most about `most` elements of an accessor, spread over it; replaced ones are not looked at.
    pub fn sample(&self, number: usize, most: usize) -> Result<Vec<[f32; 3]>, String> {
        let accessor = self.accessor(number, usize::MAX)?;
        let (3, Some(view)) = (accessor.width, accessor.view) else {
            return Ok(Vec::new());
        };
        let (kind, step) = (accessor.kind, accessor.count.div_ceil(most.max(1)).max(1));
        let elements = self.elements(view, accessor.offset, accessor.layout())?;
        let size = kind.size();
        let component = |bytes: &[u8], i: usize| {
            number_of(&bytes[i * size..(i + 1) * size], kind, accessor.normalised)
        };
        let read = |i: usize| {
            let bytes = elements.at(i);
            [0, 1, 2].map(|k| component(bytes, k))
        };
        Ok((0..accessor.count).step_by(step).map(read).collect())
    }

    /// Reads an accessor as `N` whole numbers for each element, missing ones 0.
    pub fn integers<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
    ) -> Result<Vec<[u32; N]>, String> {
        let (kind, width) = (accessor.kind, accessor.width);
        let whole = matches!(kind, Kind::U8 | Kind::U16 | Kind::U32);
        let (true, Some(view)) = (whole, accessor.view) else {
            let number = accessor.number;
            return Err(format!("accessors[{number}] does not hold whole numbers"));
        };
        let read = |bytes: &[u8]| {
            let number = |i: usize| index(&bytes[i * kind.size()..][..kind.size()], kind);
            std::array::from_fn(|i| if i < width { number(i) } else { 0 })
        };
        let elements = self.elements(view, accessor.offset, accessor.layout())?;
        let mut values = elements.map(read);
        self.replace_sparse(accessor, &mut values, read)?;
        Ok(values)
    }

    fn replace_sparse<T>(
        &self,
        accessor: &Accessor<'_>,
        values: &mut [T],
        read: impl Fn(&[u8]) -> T,
    ) -> Result<(), String> {
        let sparse = accessor.sparse;
        if !sparse.exists() {
            return Ok(());
        }
        let wrong = || format!("accessors[{}].sparse is not valid", accessor.number);
        let count = sparse.get("count").index().filter(|n| *n <= accessor.count);
        let count = count.ok_or_else(wrong)?;
        let place = |key: &str| {
            let part = sparse.get(key);
            let view = part.get("bufferView").index();
            view.zip(part.get("byteOffset").index_or(0))
                .ok_or_else(wrong)
        };
        let kind = Kind::of(sparse.get("indices").get("componentType"));
        let kind = kind.filter(|kind| matches!(kind, Kind::U8 | Kind::U16 | Kind::U32));
        let kind = kind.ok_or_else(wrong)?;
        let ((view, offset), layout) = (
            place("indices")?,
            Layout {
                count,
                element: kind.size(),
            },
        );
        let places = self
            .elements(view, offset, layout)?
            .map(|bytes| index(bytes, kind));
        let (view, offset) = place("values")?;
        let layout = Layout {
            count,
            ..accessor.layout()
        };
        let new = self.elements(view, offset, layout)?.map(read);
        for (place, new) in places.into_iter().zip(new) {
            *values.get_mut(place as usize).ok_or_else(wrong)? = new;
        }
        Ok(())
    }

    fn elements(&self, view: usize, offset: usize, layout: Layout) -> Result<Elements, String> {
        let exceeded = || format!("an accessor exceeds bufferViews[{view}]");
        let View {
            bytes,
            range,
            stride,
        } = self.view(view)?;
        let stride = stride.unwrap_or(layout.element);
        let needed = (layout.count.max(1) - 1)
            .checked_mul(stride)
            .and_then(|n| n.checked_add(layout.element)?.checked_add(offset));
        if needed.is_none_or(|needed| needed > range.len()) || stride < layout.element {
            return Err(exceeded());
        }
        Ok(Elements {
            bytes,
            start: range.start + offset,
            stride,
            layout,
        })
    }
}

/// Elements of an accessor; their range was checked.
struct Elements {
    bytes: Rc<Vec<u8>>,
    start: usize,
    stride: usize,
    layout: Layout,
}

impl Elements {
    fn at(&self, i: usize) -> &[u8] {
        &self.bytes[self.start + i * self.stride..][..self.layout.element]
    }

    fn map<T>(&self, read: impl Fn(&[u8]) -> T) -> Vec<T> {
        (0..self.layout.count).map(|i| read(self.at(i))).collect()
    }
}

/// Reads all bytes a URI refers to.
fn read_uri(builder: &Builder, path: &Path, uri: &str) -> Result<Vec<u8>, String> {
    match resolve(builder, path, uri)? {
        Uri::Data(bytes) => Ok(bytes),
        Uri::File(Lookup::Found(file)) => builder.files.read(&file).map_err(|e| e.to_string()),
        Uri::File(Lookup::Missing(_)) => Err(format!("{} is missing", shortened(uri, 60))),
        Uri::File(Lookup::Outside(file)) => Err(format!(
            "{} is outside the model's folder; pass --allow-outside to allow it",
            file.display()
        )),
    }
}
