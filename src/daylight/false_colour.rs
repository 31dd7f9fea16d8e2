//! False colours: luminance or illuminance on a logarithmic colour scale ([`ColourMap`]) with a legend.
//!
//! Values outside the [`Range`] have the colour of its nearer end; pixels without light or surface are black.

use glam::DVec3;

use super::colour::srgb_eotf;

/// Fraction of the picture's values that an automatic range ignores at each end.
const OUTLIERS: f64 = 0.01;
/// The ends of an automatic range are multiples of this, decades.
const STEP_DECADES: f64 = 0.5;

/// The quantity that false colours show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Luminance toward the eye, cd/m².
    Luminance,
    /// Illuminance of the surface in the pixel, lux.
    Illuminance,
    /// Hours in which the sun shines on the surface in the pixel.
    SunHours,
}

impl Quantity {
    /// Unit of the quantity.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Luminance => "cd/m²",
            Self::Illuminance => "lux",
            Self::SunHours => "h",
        }
    }

    /// A fixed range from shadows to a sunny day, for animations.
    pub fn daytime(self) -> Range {
        match self {
            Self::Luminance => Range {
                min: 10.0,
                max: 1e5,
            },
            Self::Illuminance => Range {
                min: 100.0,
                max: 1e5,
            },
            Self::SunHours => Range {
                min: 0.0,
                max: 12.0,
            },
        }
    }
}

/// The values of the first and last colours. The scale between them is logarithmic, from 0 on linear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Value of the first colour, positive or 0, in the quantity's unit.
    pub min: f64,
    /// Value of the last colour, greater than `min`.
    pub max: f64,
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let least = if self.is_linear() {
            "0".to_owned()
        } else {
            label(self.min)
        };
        write!(f, "{least} to {}", label(self.max))
    }
}

/// Colours for the values of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colours {
    /// The values of the first and last colour.
    pub range: Range,
    /// The colours between them.
    pub map: ColourMap,
}

impl Colours {
    /// The linear BT.709 colour of `value`, 0..1; black for what is not on the scale: negative, or 0 on a logarithmic one.
    pub fn colour(&self, value: f64) -> DVec3 {
        if value > 0.0 || (value == 0.0 && self.range.is_linear()) {
            self.map.colour(self.range.share(value))
        } else {
            DVec3::ZERO
        }
    }
}

/// A labelled value of a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Value, in the quantity's unit.
    pub value: f64,
    /// Position on the scale: 0 for the first colour, 1 for the last.
    pub share: f64,
    /// The value as text.
    pub label: String,
}

impl Range {
    /// Smallest range of half decades around `values` without one percent at each end; `None` if no value is positive.
    pub fn around(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.filter(|v| v.is_finite() && *v > 0.0).collect();
        let last = values.len().checked_sub(1)?;
        let mut at = |share: f64| {
            let index = (share * last as f64).round() as usize;
            let (_, value, _) = values.select_nth_unstable_by(index, f64::total_cmp);
            value.log10() / STEP_DECADES
        };
        // A value on a half decade stays there despite rounding errors.
        let (low, high) = (at(OUTLIERS) + 1e-9, at(1.0 - OUTLIERS) - 1e-9);
        let low = low.floor();
        let high = high.ceil().max(low + 1.0);
        let value = |steps: f64| 10f64.powf(steps * STEP_DECADES);
        Some(Self {
            min: value(low),
            max: value(high),
        })
    }

    /// Whether the scale is linear.
    pub fn is_linear(&self) -> bool {
        self.min <= 0.0
    }

    /// Position of `value` on the scale, clamped to 0..=1.
    pub fn share(&self, value: f64) -> f64 {
        if self.is_linear() {
            return (value / self.max).clamp(0.0, 1.0);
        }
        let (scale, offset) = self.log2_scale();
        (value.log2() * scale + offset).clamp(0.0, 1.0)
    }

    /// (a, b) in position = a log₂(value) + b, for a shader, of a logarithmic scale.
    pub fn log2_scale(&self) -> (f64, f64) {
        let scale = 1.0 / (self.max.log2() - self.min.log2());
        (scale, -self.min.log2() * scale)
    }

    /// The values 1, 2 and 5 of every decade within the range; its ends if those are fewer than two. Of a linear scale, multiples of such a value.
    pub fn ticks(&self) -> Vec<Tick> {
        if self.is_linear() {
            return self.even_ticks();
        }
        let decades = self.min.log10().floor() as i32..=self.max.log10().ceil() as i32;
        let round = decades.flat_map(|decade| [1, 2, 5].map(|digit| (digit, decade)));
        let round = round.map(|(digit, decade)| decimal(digit, decade));
        // Tolerates rounding errors of the ends.
        let inside = |v: &f64| *v >= self.min * (1.0 - 1e-9) && *v <= self.max * (1.0 + 1e-9);
        let values: Vec<f64> = round.filter(inside).collect();
        let values = if values.len() < 2 {
            vec![self.min, self.max]
        } else {
            values
        };
        let tick = |value| Tick {
            value,
            share: self.share(value),
            label: label(value),
        };
        values.into_iter().map(tick).collect()
    }
}

impl Range {
    /// Four to ten multiples of 1, 2 or 5 of a decade.
    fn even_ticks(&self) -> Vec<Tick> {
        let decade = (0.1 * self.max).log10().floor() as i32;
        let steps = [decade, decade + 1].into_iter();
        let steps = steps.flat_map(|decade| [1, 2, 5].map(|digit| decimal(digit, decade)));
        let fits = |step: &f64| self.max / step < 10.5;
        let step = steps.into_iter().find(fits).unwrap_or(self.max);
        let count = (self.max / step * (1.0 + 1e-9)).floor() as u32;
        let tick = |k: u32| {
            let value = f64::from(k) * step;
            Tick {
                value,
                share: self.share(value),
                label: if k == 0 { "0".to_owned() } else { label(value) },
            }
        };
        (0..=count).map(tick).collect()
    }
}

/// `digit` times a power of ten, as the float nearest to its decimal text.
fn decimal(digit: i32, decade: i32) -> f64 {
    format!("{digit}e{decade}")
        .parse()
        .unwrap_or(f64::from(digit) * 10f64.powi(decade))
}

/// Up to four significant digits, thousands separated by blanks.
fn label(value: f64) -> String {
    let decimals = (3 - value.abs().log10().floor() as i32).clamp(0, 12);
    let text = format!("{value:.*}", decimals as usize);
    let text = match text.split_once('.') {
        Some((whole, part)) if part.trim_end_matches('0').is_empty() => whole.to_owned(),
        Some((whole, part)) => return format!("{whole}.{}", part.trim_end_matches('0')),
        None => text,
    };
    let mut grouped = String::new();
    for (i, digit) in text.chars().enumerate() {
        if i > 0 && (text.len() - i) % 3 == 0 {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// A sequence of colours. Each is a polynomial fit of the published table of sRGB values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// Mikhailov 2019, *Turbo, An Improved Rainbow Colormap for Visualization*, by Du's fit. Different hues separate values that
    /// would blend in a single-hue map, while lightness varies smoothly, without the bands of older rainbow maps. Red and green
    /// of equal lightness look alike to the colour-blind.
    #[default]
    Turbo,
    /// Smith and van der Walt 2015, *A Better Default Colormap for Matplotlib*: lightness grows evenly from first to last, also
    /// for the colour-blind and in grey. Within 0.017 of the table.
    Viridis,
    /// Nuñez, Anderton and Renslow 2018, *Optimizing colormaps with consideration for color vision deficiency*: looks the same to
    /// people with and without red-green deficiency. Within 0.042 of the table.
    Cividis,
}

impl ColourMap {
    /// Coefficients of the polynomial, from the constant term.
    fn terms(self) -> &'static [[f64; 3]] {
        match self {
            Self::Turbo => &[
                [0.135_721_38, 0.091_402_61, 0.106_673_30],
                [4.615_392_60, 2.194_188_39, 12.641_946_08],
                [-42.660_322_58, 4.842_966_58, -60.582_048_36],
                [132.131_082_34, -14.185_033_33, 110.362_767_71],
                [-152.942_393_96, 4.277_298_57, -89.903_109_12],
                [59.286_379_43, 2.829_566_04, 27.348_249_73],
            ],
            Self::Viridis => &[
                [0.274_455_42, 0.005_767_96, 0.332_663_88],
                [0.107_708_33, 1.396_469_68, 1.386_770_60],
                [-0.327_241_10, 0.214_813_56, 0.091_976_88],
                [-4.599_931_52, -5.758_238_19, -19.291_808_95],
                [6.203_735_90, 14.153_964_95, 56.656_299_57],
                [4.751_786_89, -13.749_439_40, -65.320_967_83],
                [-5.432_077_17, 4.641_571_32, 26.272_107_60],
            ],
            Self::Cividis => &[
                [-0.008_973_44, 0.136_755_89, 0.294_170_19],
                [-0.384_689_05, 0.639_493_70, 2.982_653_93],
                [15.429_210_35, 0.385_561_65, -22.363_760_37],
                [-58.977_031_46, -1.404_197_12, 74.863_561_10],
                [102.370_491_51, 2.600_914_30, -121.303_164_22],
                [-83.187_238_96, -2.140_750_39, 93.974_216_40],
                [25.776_070_14, 0.688_122_32, -28.262_533_02],
            ],
        }
    }

    /// The linear BT.709 colour at `share` of the sequence, 0..1.
    pub fn colour(self, share: f64) -> DVec3 {
        let x = share.clamp(0.0, 1.0);
        let terms = self.terms().iter().rev();
        let encoded = terms.fold(DVec3::ZERO, |sum, term| sum * x + DVec3::from(*term));
        encoded.clamp(DVec3::ZERO, DVec3::ONE).map(srgb_eotf)
    }
}

#[cfg(test)]
mod tests {
    use super::super::colour::{luminance, srgb_oetf};
    use super::*;

    /// Entries of a published table of 256 sRGB colours.
    type Table = [(u32, [f64; 3]); 10];

    const TURBO: Table = [
        (0, [0.18995, 0.07176, 0.23217]),
        (17, [0.25107, 0.25237, 0.63374]),
        (34, [0.27628, 0.42118, 0.89123]),
        (51, [0.25862, 0.57958, 0.99876]),
        (68, [0.15844, 0.73551, 0.92305]),
        (85, [0.09267, 0.86554, 0.76230]),
        (102, [0.19659, 0.94901, 0.59466]),
        (119, [0.42778, 0.99419, 0.38575]),
        (136, [0.64362, 0.98999, 0.23356]),
        (255, [0.47960, 0.01583, 0.01055]),
    ];
    const VIRIDIS: Table = [
        (0, [0.26700, 0.00487, 0.32942]),
        (17, [0.28266, 0.10020, 0.42216]),
        (34, [0.27713, 0.18523, 0.48990]),
        (51, [0.25394, 0.26525, 0.52998]),
        (85, [0.19063, 0.40706, 0.55609]),
        (102, [0.16363, 0.47113, 0.55815]),
        (136, [0.12057, 0.59642, 0.54361]),
        (170, [0.20803, 0.71870, 0.47287]),
        (204, [0.47750, 0.82144, 0.31820]),
        (255, [0.99325, 0.90616, 0.14394]),
    ];
    const CIVIDIS: Table = [
        (0, [0.0, 0.13511, 0.30475]),
        (17, [0.0, 0.18161, 0.42186]),
        (34, [0.11761, 0.22594, 0.43431]),
        (51, [0.20893, 0.27255, 0.42481]),
        (85, [0.34225, 0.36494, 0.42856]),
        (102, [0.40142, 0.41179, 0.44071]),
        (136, [0.51792, 0.50845, 0.47271]),
        (170, [0.64822, 0.61055, 0.45480]),
        (204, [0.78597, 0.72044, 0.39961]),
        (255, [0.99574, 0.90934, 0.21777]),
    ];

    #[test]
    fn maps_meet_their_tables() {
        // Errors of the coefficients, evaluated independently: at worst, in the mean.
        let maps = [
            (ColourMap::Turbo, TURBO, 0.13, 0.085),
            (ColourMap::Viridis, VIRIDIS, 0.017, 0.01),
            (ColourMap::Cividis, CIVIDIS, 0.042, 0.02),
        ];
        for (map, table, most, most_mean) in maps {
            let off = |(entry, rgb): (u32, [f64; 3])| {
                let ours = map.colour(f64::from(entry) / 255.0).map(srgb_oetf);
                (ours - DVec3::from_array(rgb)).abs().max_element()
            };
            let errors = table.map(off);
            let worst = errors.into_iter().fold(0.0, f64::max);
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            println!("{map:?}: {worst:.3} from its table at worst, {mean:.3} in the mean");
            assert!(worst < most && mean < most_mean, "{map:?} {errors:?}");
            for i in 0..=1000 {
                let c = map.colour(f64::from(i) / 1000.0);
                assert!(c.min_element() >= 0.0 && c.max_element() <= 1.0);
            }
        }
    }

    #[test]
    fn the_maps_for_the_colour_blind_grow_in_lightness() {
        for map in [ColourMap::Viridis, ColourMap::Cividis] {
            let lightness = |i: i32| luminance(map.colour(f64::from(i) / 32.0));
            for i in 0..32 {
                assert!(lightness(i + 1) > lightness(i), "{map:?} at {i}/32");
            }
        }
    }

    #[test]
    fn shares_are_logarithmic_and_cut() {
        let range = Range {
            min: 10.0,
            max: 1000.0,
        };
        for (value, share) in [
            (10.0, 0.0),
            (100.0, 0.5),
            (1000.0, 1.0),
            (1.0, 0.0),
            (1e9, 1.0),
        ] {
            assert!((range.share(value) - share).abs() < 1e-12, "{value}");
        }
        let map = ColourMap::Viridis;
        let colours = Colours { range, map };
        assert_eq!(colours.colour(0.0), DVec3::ZERO);
        assert_eq!(colours.colour(-1.0), DVec3::ZERO);
        assert_eq!(colours.colour(f64::NAN), DVec3::ZERO);
        assert_eq!(colours.colour(1.0), map.colour(0.0));
        assert_eq!(colours.colour(f64::INFINITY), map.colour(1.0));
    }

    #[test]
    fn ranges_are_half_decades_around_all_but_the_outliers() {
        let around = |low: f64, high: f64| {
            let values = (0..=1000).map(move |i| low + (high - low) * f64::from(i) / 1000.0);
            // Outliers, one in a thousand at each end, do not count.
            let values = values.chain([1e-9, 1e9, 0.0, -5.0, f64::NAN]);
            Range::around(values).expect("light")
        };
        let close = |range: Range, min: f64, max: f64| {
            assert!((range.min / min - 1.0).abs() < 1e-9, "{range:?}");
            assert!((range.max / max - 1.0).abs() < 1e-9, "{range:?}");
        };
        close(around(20.0, 900.0), 10f64.powf(1.0), 1000.0);
        close(around(40.0, 2000.0), 10f64.powf(1.5), 10f64.powf(3.5));
        close(around(100.0, 100.0), 100.0, 10f64.powf(2.5));
        assert_eq!(Range::around([0.0, -1.0].into_iter()), None);
        assert_eq!(Range::around(std::iter::empty()), None);
    }

    #[test]
    fn ticks_are_one_two_five() {
        let labels = |min, max| {
            let ticks = Range { min, max }.ticks();
            ticks.into_iter().map(|t| t.label).collect::<Vec<_>>()
        };
        assert_eq!(
            labels(100.0, 10_000.0),
            ["100", "200", "500", "1 000", "2 000", "5 000", "10 000"]
        );
        assert_eq!(
            labels(10f64.powf(1.5), 10f64.powf(2.5)),
            ["50", "100", "200"]
        );
        assert_eq!(labels(0.01, 0.1), ["0.01", "0.02", "0.05", "0.1"]);
        assert_eq!(labels(120.0, 130.0), ["120", "130"]);
        assert_eq!(labels(1.25, 1.75), ["1.25", "1.75"]);
        assert_eq!(labels(500_000.0, 1e6), ["500 000", "1 000 000"]);
        for tick in (Range {
            min: 30.0,
            max: 3e4,
        })
        .ticks()
        {
            let expected = (tick.value / 30.0).log10() / 3.0;
            assert!((tick.share - expected).abs() < 1e-12);
        }
    }
}
