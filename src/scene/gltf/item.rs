//! A value of the JSON that may be absent or of another type than expected, and access to its parts.

use serde_json::Value;

/// A value or nothing. A part of nothing is nothing, so that only what is drawn needs a check.
#[derive(Debug, Clone, Copy)]
pub struct Item<'j>(Option<&'j Value>);

impl<'j> Item<'j> {
    pub fn of(value: &'j Value) -> Self {
        Self(Some(value).filter(|value| !value.is_null()))
    }

    /// The part under a key.
    pub fn get(self, key: &str) -> Self {
        self.0
            .and_then(|value| value.get(key))
            .map_or(Self(None), Self::of)
    }

    /// An element of a list.
    pub fn at(self, index: usize) -> Self {
        self.0
            .and_then(|value| value.get(index))
            .map_or(Self(None), Self::of)
    }

    pub fn extension(self, name: &str) -> Self {
        self.get("extensions").get(name)
    }

    /// The names of all extensions.
    pub fn extensions(self) -> impl Iterator<Item = &'j str> {
        let map = self.get("extensions").0.and_then(Value::as_object);
        map.into_iter().flatten().map(|(name, _)| name.as_str())
    }

    pub fn exists(self) -> bool {
        self.0.is_some()
    }

    pub fn is_object(self) -> bool {
        self.0.is_some_and(Value::is_object)
    }

    /// The elements of a list; none if it is no list.
    pub fn items(self) -> impl ExactSizeIterator<Item = Self> + DoubleEndedIterator {
        let list = self
            .0
            .and_then(Value::as_array)
            .map_or(&[][..], Vec::as_slice);
        list.iter().map(Self::of)
    }

    pub fn text(self) -> Option<&'j str> {
        self.0?.as_str()
    }

    pub fn flag(self) -> Option<bool> {
        self.0?.as_bool()
    }

    pub fn number(self) -> Option<f64> {
        self.0?.as_f64()
    }

    /// A whole number, also one written as 3.0.
    pub fn index(self) -> Option<usize> {
        let value = self.0?;
        let whole = value
            .as_f64()
            .filter(|v| v.fract() == 0.0 && (0.0..9e15).contains(v));
        let index = value.as_u64().or(whole.map(|v| v as u64))?;
        usize::try_from(index).ok()
    }

    /// A whole number, `default` if it is absent, `None` if it is something else.
    pub fn index_or(self, default: usize) -> Option<usize> {
        if self.exists() {
            self.index()
        } else {
            Some(default)
        }
    }

    /// Exactly `N` numbers.
    pub fn numbers<const N: usize>(self) -> Option<[f64; N]> {
        let list = self.0?.as_array().filter(|list| list.len() == N)?;
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(list) {
            *number = value.as_f64()?;
        }
        Some(numbers)
    }

    /// A finite number as `f32`; `default` if it is absent or no number.
    pub fn float(self, default: f32) -> f32 {
        self.number().map_or(default, |v| v as f32)
    }

    /// `N` numbers as `f32`; `default` if they are absent or no numbers.
    pub fn floats<const N: usize>(self, default: [f32; N]) -> [f32; N] {
        self.numbers()
            .map_or(default, |list| list.map(|v| v as f32))
    }
}
