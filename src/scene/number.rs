//! Numbers as programs print them: decimal commas, and what C libraries write for infinity and "not a number".

/// Parses a number in any spelling; infinities and NaN are numbers too.
pub fn parse(word: &str) -> Option<f64> {
    if let Ok(value) = word.parse::<f64>() {
        return Some(value);
    }
    if word.bytes().filter(|byte| *byte == b',').count() == 1 && !word.contains('.') {
        return word.replace(',', ".").parse().ok();
    }
    special(word).or_else(|| exponent_of_fortran(word))
}

/// `1.#INF`, `-1.#IND`, `1.#QNAN`, `-nan(ind)`, `nan(snan)`, `+inf`.
fn special(word: &str) -> Option<f64> {
    let lower = word.to_ascii_lowercase();
    let (sign, plain) = match lower.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, lower.strip_prefix('+').unwrap_or(&lower)),
    };
    let of_windows = plain.strip_prefix("1.#").or(plain.strip_prefix("1,#"));
    match of_windows.unwrap_or(plain) {
        text if text.starts_with("inf") => Some(sign * f64::INFINITY),
        text if ["nan", "qnan", "snan", "ind"]
            .iter()
            .any(|k| text.starts_with(k)) =>
        {
            Some(f64::NAN)
        }
        _ => None,
    }
}

/// `1.5D+02`, and a suffix `f` as in source code.
fn exponent_of_fortran(word: &str) -> Option<f64> {
    let is_number = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let plain = word.strip_suffix(['f', 'F']).unwrap_or(word);
    let plain = plain.replace(['d', 'D'], "e");
    plain.parse().ok().filter(|_| is_number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_of_a_number() {
        for (word, value) in [
            ("1.5", 1.5),
            ("+1,5", 1.5),
            ("-,5", -0.5),
            ("1.5D+02", 150.0),
            ("2.0f", 2.0),
            ("1.#INF", f64::INFINITY),
            ("-1.#INF", f64::NEG_INFINITY),
            ("-Infinity", f64::NEG_INFINITY),
            ("1e999", f64::INFINITY),
        ] {
            assert_eq!(parse(word), Some(value), "{word}");
        }
        for word in [
            "-nan(ind)",
            "1.#QNAN",
            "-1.#IND00",
            "nan(snan)",
            "NaN",
            "-nan",
        ] {
            assert!(parse(word).is_some_and(f64::is_nan), "{word}");
        }
        for word in [
            "", "abc", "#", "1,2,3", "1.5,2", "deaf", "f", "d", "1..2", "--1",
        ] {
            assert_eq!(parse(word), None, "{word}");
        }
    }
}
