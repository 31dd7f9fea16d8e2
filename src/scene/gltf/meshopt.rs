//! Buffer views compressed by meshoptimizer (`EXT_meshopt_compression`, `KHR_meshopt_compression`).

use meshopt::encoding;

use crate::scene::gltf::item::Item;

/// Names of the extension, which have the same properties.
const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Bytes that a compressed byte can stand for: a block of 256 vertices costs at least 2 bits for each byte of a vertex.
const MAX_RATIO: usize = 1_024;

/// The extension of a view that is compressed.
pub fn compression(view: Item<'_>) -> Option<Item<'_>> {
    let mut found = NAMES.iter().map(|name| view.extension(name));
    found.find(|extension| extension.is_object())
}

/// What a compressed view becomes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    count: usize,
    /// Bytes of an element.
    pub stride: usize,
    mode: Mode,
    filter: Filter,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Filter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Colour,
}

impl Plan {
    /// Reads and checks the properties of the extension, for this many compressed bytes.
    pub fn of(extension: Item<'_>, compressed: usize) -> Option<Self> {
        let plan = Self {
            count: extension.get("count").index()?,
            stride: extension.get("byteStride").index()?,
            mode: match extension.get("mode").text()? {
                "ATTRIBUTES" => Mode::Attributes,
                "TRIANGLES" => Mode::Triangles,
                "INDICES" => Mode::Indices,
                _ => return None,
            },
            filter: match extension.get("filter").text().unwrap_or("NONE") {
                "NONE" => Filter::None,
                "OCTAHEDRAL" => Filter::Octahedral,
                "QUATERNION" => Filter::Quaternion,
                "EXPONENTIAL" => Filter::Exponential,
                "COLOR" => Filter::Colour,
                _ => return None,
            },
        };
        let fits = match plan.mode {
            Mode::Attributes => plan.stride.is_multiple_of(4) && (4..=256).contains(&plan.stride),
            Mode::Triangles => [2, 4].contains(&plan.stride) && plan.count.is_multiple_of(3),
            Mode::Indices => [2, 4].contains(&plan.stride),
        };
        let filterable = match plan.filter {
            Filter::None => true,
            Filter::Octahedral | Filter::Colour => [4, 8].contains(&plan.stride),
            Filter::Quaternion => plan.stride == 8,
            Filter::Exponential => plan.stride.is_multiple_of(4),
        };
        let most = compressed.saturating_mul(MAX_RATIO);
        (fits && filterable && plan.bytes()? <= most).then_some(plan)
    }

    /// Number of bytes that result.
    pub fn bytes(&self) -> Option<usize> {
        self.count.checked_mul(self.stride)
    }

    /// Decodes a view; `None` if it is damaged.
    pub fn decode(&self, compressed: &[u8]) -> Option<Vec<u8>> {
        let (count, stride) = (self.count, self.stride);
        let bytes = match (self.mode, stride) {
            (Mode::Attributes, _) => vertices(compressed, count, stride)?,
            (Mode::Triangles, 2) => shorts(&encoding::decode_index_buffer(compressed, count).ok()?),
            (Mode::Triangles, _) => words(&encoding::decode_index_buffer(compressed, count).ok()?),
            (Mode::Indices, 2) => shorts(&encoding::decode_index_sequence(compressed, count).ok()?),
            (Mode::Indices, _) => words(&encoding::decode_index_sequence(compressed, count).ok()?),
        };
        Some(self.filtered(bytes))
    }

    fn filtered(&self, mut bytes: Vec<u8>) -> Vec<u8> {
        let eight = self.stride == 4;
        match self.filter {
            Filter::None => return bytes,
            Filter::Octahedral if eight => {
                encoding::decode_filter_oct::<i8>(bytemuck::cast_slice_mut(&mut bytes));
                return bytes;
            }
            Filter::Colour if eight => {
                encoding::decode_filter_color::<u8>(bytemuck::cast_slice_mut(&mut bytes));
                return bytes;
            }
            Filter::Exponential => {
                let mut values: Vec<[u32; 1]> = bytemuck::pod_collect_to_vec(&bytes);
                encoding::decode_filter_exp(&mut values);
                return bytemuck::pod_collect_to_vec(&values);
            }
            Filter::Octahedral | Filter::Quaternion | Filter::Colour => {}
        }
        if self.filter == Filter::Colour {
            let mut values: Vec<[u16; 4]> = bytemuck::pod_collect_to_vec(&bytes);
            encoding::decode_filter_color(&mut values);
            return bytemuck::pod_collect_to_vec(&values);
        }
        let mut values: Vec<[i16; 4]> = bytemuck::pod_collect_to_vec(&bytes);
        if self.filter == Filter::Quaternion {
            encoding::decode_filter_quat(&mut values);
        } else {
            encoding::decode_filter_oct(&mut values);
        }
        bytemuck::pod_collect_to_vec(&values)
    }
}

fn shorts(values: &[u16]) -> Vec<u8> {
    bytemuck::cast_slice(values).to_vec()
}

fn words(values: &[u32]) -> Vec<u8> {
    bytemuck::cast_slice(values).to_vec()
}

/// An element of `N` words: the decoder takes the size of an element from its type.
#[derive(Clone)]
struct Element<const N: usize>([u32; N]);

impl<const N: usize> Default for Element<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

fn elements<const N: usize>(compressed: &[u8], count: usize) -> Option<Vec<u8>> {
    let decoded = encoding::decode_vertex_buffer::<Element<N>>(compressed, count).ok()?;
    let mut bytes = Vec::with_capacity(4 * N * count);
    for element in &decoded {
        bytes.extend_from_slice(bytemuck::cast_slice(&element.0));
    }
    Some(bytes)
}

fn vertices(compressed: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    macro_rules! of_size {
        ($($words:literal)*) => {
            match stride / 4 {
                $($words => elements::<$words>(compressed, count),)*
                _ => None,
            }
        };
    }
    of_size!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32
        33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn plan(json: &serde_json::Value, compressed: usize) -> Option<Plan> {
        Plan::of(Item::of(json), compressed)
    }

    #[test]
    fn what_was_encoded_comes_back() {
        let vertices: Vec<[f32; 3]> = (0..50).map(|i| [i as f32, 0.5, -1.0]).collect();
        let code = encoding::encode_vertex_buffer(&vertices).expect("an encoder");
        let json = json!({"count": 50, "byteStride": 12, "mode": "ATTRIBUTES"});
        let decoded = plan(&json, code.len()).expect("a plan").decode(&code);
        assert_eq!(decoded.as_deref(), Some(bytemuck::cast_slice(&vertices)));
        let indices: Vec<u32> = (0..48).collect();
        let code = encoding::encode_index_buffer(&indices, 48).expect("an encoder");
        let json = json!({"count": 48, "byteStride": 2, "mode": "TRIANGLES"});
        let decoded = plan(&json, code.len()).expect("a plan").decode(&code);
        assert_eq!(decoded.map(|bytes| bytes.len()), Some(96));
        assert_eq!(
            plan(&json, code.len()).expect("a plan").decode(&code[..9]),
            None
        );
    }

    #[test]
    fn normals_are_unit_vectors_behind_the_octahedral_filter() {
        let normals = [[0.6f32, 0.0, 0.8, 0.0], [0.0, -1.0, 0.0, 0.0]];
        let code = encoding::encode_filter_oct::<i8>(&normals, 8);
        let code = encoding::encode_vertex_buffer(&code).expect("an encoder");
        let json =
            json!({"count": 2, "byteStride": 4, "mode": "ATTRIBUTES", "filter": "OCTAHEDRAL"});
        let decoded = plan(&json, code.len())
            .expect("a plan")
            .decode(&code)
            .expect("decoded");
        let found = decoded
            .chunks_exact(4)
            .map(|n| [n[0], n[1], n[2]].map(|v| f32::from(v as i8) / 127.0));
        for (found, normal) in found.zip(normals) {
            assert!(
                found.iter().zip(normal).all(|(a, b)| (a - b).abs() < 0.03),
                "{found:?}"
            );
        }
    }

    #[test]
    fn bad_properties_are_no_plan() {
        for json in [
            json!({}),
            json!({"count": 5, "byteStride": 6, "mode": "ATTRIBUTES"}),
            json!({"count": 5, "byteStride": 0, "mode": "ATTRIBUTES"}),
            json!({"count": 4, "byteStride": 2, "mode": "TRIANGLES"}),
            json!({"count": 3, "byteStride": 12, "mode": "INDICES"}),
            json!({"count": 3, "byteStride": 12, "mode": "ATTRIBUTES", "filter": "QUATERNION"}),
            json!({"count": 9_000_000_000u64, "byteStride": 4, "mode": "INDICES"}),
            json!({"count": 3, "byteStride": 4, "mode": "POINTS"}),
        ] {
            assert_eq!(plan(&json, 100), None, "{json}");
        }
    }
}
