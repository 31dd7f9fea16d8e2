//! Numbers in files, to the last bit.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Numbers that are written as their bytes (base64, little endian): they come back as they are, infinite ones too.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::commands) struct Exact(pub Vec<f64>);

impl Exact {
    /// The only number; 0 without one.
    pub fn one(&self) -> f64 {
        self.0.first().copied().unwrap_or_default()
    }

    /// Their mean; 0 without any.
    pub fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len().max(1) as f64
    }

    /// Rows of equal length.
    pub fn rows<const N: usize>(&self) -> Vec<[f64; N]> {
        let rows = self.0.chunks_exact(N);
        rows.map(|row| std::array::from_fn(|at| row[at])).collect()
    }
}

impl From<f64> for Exact {
    fn from(value: f64) -> Self {
        Self(vec![value])
    }
}

impl FromIterator<f64> for Exact {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl Serialize for Exact {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = self.0.iter().flat_map(|v| v.to_le_bytes()).collect();
        serializer.serialize_str(&STANDARD.encode(bytes))
    }
}

impl<'de> Deserialize<'de> for Exact {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let bytes = STANDARD.decode(text).map_err(D::Error::custom)?;
        let (numbers, rest) = bytes.as_chunks::<8>();
        if !rest.is_empty() {
            return Err(D::Error::custom("half a number"));
        }
        Ok(numbers
            .iter()
            .map(|bytes| f64::from_le_bytes(*bytes))
            .collect())
    }
}

/// The same of a plain list, for `#[serde(with = ..)]`.
pub(super) mod list {
    use super::{Deserialize, Deserializer, Exact, Serialize, Serializer};

    pub fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        Exact(values.to_vec()).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
        Ok(Exact::deserialize(deserializer)?.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_comes_back() {
        let list = [
            0.1,
            -0.0,
            1e-320,
            f64::MAX,
            f64::INFINITY,
            1.0 / 3.0,
            f64::NAN,
        ];
        let text = serde_json::to_string(&Exact(list.to_vec())).expect("text");
        let read: Exact = serde_json::from_str(&text).expect("numbers");
        let bits = |list: &[f64]| list.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read.0), bits(&list));
        assert!(serde_json::from_str::<Exact>("\"AAAA\"").is_err());
        assert!(serde_json::from_str::<Exact>("\"?\"").is_err());
    }
}
