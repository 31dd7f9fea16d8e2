//! Colours for values, and the legend that tells them.

use super::super::table::rounded;
use crate::daylight::false_colour::{ColourMap, Range};
use crate::output::{Anchor, Drawing, Fill, Ink, Part, Size};

/// Width of the bar, pixels.
const BAR: f64 = 18.0;

/// Bands of the bar.
const BANDS: usize = 64;

/// Colours of a range of values.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    kind: Kind,
    map: ColourMap,
    /// Unit of the values.
    pub unit: String,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// From 0 to a value above it, in steps.
    Linear { most: f64, step: f64 },
    /// Logarithmic.
    Logarithmic(Range),
}

impl Scale {
    /// From 0 to 100 for percentages of hours or points; else to a round number above the largest value.
    pub fn linear(values: &[f64], unit: &str, is_share: bool, map: ColourMap) -> Self {
        let largest = values.iter().copied().fold(0.0, f64::max);
        let (most, step) = if is_share {
            (100.0, 20.0)
        } else {
            round_above(largest)
        };
        Self {
            kind: Kind::Linear { most, step },
            map,
            unit: unit.to_owned(),
        }
    }

    /// Half decades around the values.
    pub fn logarithmic(values: impl Iterator<Item = f64>, unit: &str, map: ColourMap) -> Self {
        let range = Range::around(values).unwrap_or(Range {
            min: 10.0,
            max: 100.0,
        });
        Self {
            kind: Kind::Logarithmic(range),
            map,
            unit: unit.to_owned(),
        }
    }

    /// Place on the scale, 0..=1.
    pub fn share(&self, value: f64) -> f64 {
        match self.kind {
            Kind::Linear { most, .. } => (value / most).clamp(0.0, 1.0),
            Kind::Logarithmic(range) => range.share(value),
        }
    }

    /// Colour at a place.
    pub fn ink(&self, share: f64) -> Ink {
        Ink::of(self.map.colour(share))
    }

    /// Values at which it is labelled.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        match self.kind {
            Kind::Linear { most, step } => {
                let count = (most / step).round() as usize;
                let value = |k: usize| rounded(k as f64 * step);
                (0..=count)
                    .map(|k| (value(k), value(k).to_string()))
                    .collect()
            }
            Kind::Logarithmic(range) => {
                let ticks = range.ticks().into_iter();
                ticks.map(|tick| (tick.value, tick.label)).collect()
            }
        }
    }

    /// Draws the legend: a bar of this height with its upper left corner there, the unit above.
    pub fn draw(&self, drawing: &mut Drawing, [x, y]: [f64; 2], height: f64) {
        drawing.text([x, y - 10.0], Anchor::Start, Size::Small, &self.unit);
        let band = height / BANDS as f64;
        for k in 0..BANDS {
            let share = 1.0 - (k as f64 + 0.5) / BANDS as f64;
            drawing.parts.push(Part::Fill(Fill {
                areas: vec![[x, y + k as f64 * band, BAR, band]],
                ink: self.ink(share),
                title: String::new(),
                name: "legend",
            }));
        }
        for (value, label) in self.ticks() {
            let at = y + (1.0 - self.share(value)) * height;
            drawing.line(vec![[x + BAR, at], [x + BAR + 4.0, at]], Ink::BLACK, 1.0);
            drawing.text([x + BAR + 8.0, at + 4.0], Anchor::Start, Size::Small, label);
        }
    }
}

/// The least of 1, 2, 2.5, 5, 10 times a power of ten that is not below a value, and a fifth or a quarter of it.
fn round_above(value: f64) -> (f64, f64) {
    if value <= 0.0 || !value.is_finite() {
        return (1.0, 0.2);
    }
    let decade = 10f64.powf((value * (1.0 - 1e-9)).log10().floor());
    let parts = [(1.0, 5.0), (2.0, 4.0), (2.5, 5.0), (5.0, 5.0), (10.0, 5.0)];
    let (digit, count) = parts
        .into_iter()
        .find(|(digit, _)| digit * decade >= value * (1.0 - 1e-9))
        .unwrap_or((10.0, 5.0));
    (digit * decade, digit * decade / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_map() {
        let map = ColourMap::Viridis;
        let scale = Scale::linear(&[12.0, 55.0], "%", true, map);
        for value in [0.0, 12.0, 50.0, 100.0] {
            assert_eq!(
                scale.ink(scale.share(value)),
                Ink::of(map.colour(value / 100.0))
            );
        }
        // The ends of Viridis, of its published table, within the fit's 0.017.
        let near = |ink: Ink, rgb: [f64; 3]| {
            ink.0
                .iter()
                .zip(rgb)
                .all(|(byte, v)| (f64::from(*byte) / 255.0 - v).abs() < 0.02)
        };
        assert!(near(scale.ink(0.0), [0.26700, 0.00487, 0.32942]));
        assert!(near(scale.ink(1.0), [0.99325, 0.90616, 0.14394]));
    }

    #[test]
    fn ranges_end_at_round_numbers() {
        for (value, most) in [
            (0.0, 1.0),
            (0.7, 1.0),
            (1.0, 1.0),
            (3.2, 5.0),
            (2.2, 2.5),
            (310.0, 500.0),
            (1000.0, 1000.0),
            (1001.0, 2000.0),
        ] {
            assert_eq!(round_above(value).0, most, "{value}");
        }
        let scale = Scale::linear(&[3.2], "%", false, ColourMap::Turbo);
        let labels: Vec<String> = scale.ticks().into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0", "1", "2", "3", "4", "5"]);
        let lux = Scale::logarithmic([100.0, 3000.0].into_iter(), "lux", ColourMap::Turbo);
        assert!((lux.share(100.0)).abs() < 1e-9 && lux.share(1e6) == 1.0);
    }
}
