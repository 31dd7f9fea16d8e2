//! Sliders and fields of numbers. Typed numbers may have a decimal comma.

use std::ops::RangeInclusive;

use egui::emath::Numeric;
use egui::{DragValue, Slider};

/// A slider with a field for its value.
pub(super) fn slider<N: Numeric>(value: &mut N, range: RangeInclusive<N>) -> Slider<'_> {
    Slider::new(value, range).custom_parser(read)
}

/// A field for a value.
pub(super) fn field<N: Numeric>(value: &mut N) -> DragValue<'_> {
    DragValue::new(value).custom_parser(read)
}

/// A number as people type it: with blanks, a Unicode minus, a decimal point or comma.
fn read(text: &str) -> Option<f64> {
    let text: String = text.split_whitespace().collect();
    let text = text.replace('−', "-");
    let has_comma_alone = text.matches(',').count() == 1 && !text.contains('.');
    let text = if has_comma_alone {
        text.replace(',', ".")
    } else {
        text.replace(',', "")
    };
    text.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn numbers_are_read_with_point_and_comma() {
        assert_eq!(read("3.5"), Some(3.5));
        assert_eq!(read("3,5"), Some(3.5));
        assert_eq!(read(" −0,25 "), Some(-0.25));
        assert_eq!(read("12 500"), Some(12_500.0));
        assert_eq!(read("12,500.5"), Some(12_500.5));
        assert_eq!(read("1,234,567"), Some(1_234_567.0));
        assert_eq!(read("two"), None);
        assert_eq!(read(""), None);
    }
}
