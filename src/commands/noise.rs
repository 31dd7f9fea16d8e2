//! Estimates the standard error of the mean of frames from the frames themselves.
//!
//! Batch means (Conway 1963, "Some Tactical Problems in Digital Simulation"): the frames so far are split into a few consecutive
//! batches of equal size; the variance of the batch means gives the standard error of the overall mean. The variance of single
//! frames would overestimate it, since a low-discrepancy sequence converges faster than random samples. Each batch is a stretch of
//! the same sequence, so most of that gain is accounted for; the gain between batches is not. All pixels share the directions of the
//! sky, so with few frames the estimate is itself noisy.

use crate::daylight::sampling::{rnd, tea};

/// Number of batches at which pairs are merged.
const MOST_BATCHES: usize = 8;
/// Fewest batches that allow an estimate.
const FEWEST_BATCHES: usize = 4;
/// Largest number of pixels used for the estimate: a root mean square of so many errors is itself certain within 1 % or 2 %, and looking at
/// all pixels of a picture takes longer than a GPU needs for drawing them.
const MOST_PIXELS: usize = 1 << 15;
/// Luminance to which pixels are clamped, kcd/m². Only the sun's disc and its reflections are brighter; without the clamp a few
/// of their pixels would outweigh the rest of the image.
const BRIGHTEST: f32 = 100.0;

/// The estimate for a growing number of frames.
pub(super) struct Noise {
    /// Batch size, frames.
    size: u32,
    /// Luminance of the cumulative means: over the first batch, the first two, the first three, and so on.
    means: Vec<Vec<f32>>,
    /// Pixels that are looked at, in rising order.
    pixels: Vec<usize>,
}

impl Noise {
    /// Starts with no frames of a picture of so many pixels.
    pub(super) fn new(pixels: usize) -> Self {
        Self::of_some(pixels, MOST_PIXELS)
    }

    /// The same with another number of pixels at most.
    fn of_some(pixels: usize, most: usize) -> Self {
        Self {
            size: 1,
            means: Vec::new(),
            pixels: spread(pixels, most),
        }
    }

    /// Numbers of the pixels that [`Noise::look`] wants, counted along the rows.
    pub(super) fn pixels(&self) -> &[usize] {
        &self.pixels
    }

    /// Number of frames after which to call [`Noise::look`] next.
    pub(super) fn next_look(&self) -> u32 {
        self.size * (self.means.len() as u32 + 1)
    }

    /// Adds the mean of the first [`Noise::next_look`] frames in each of [`Noise::pixels`]: RGBA, kcd/m².
    pub(super) fn look(&mut self, mean: &[[f32; 4]]) {
        let luminance = |t: &[f32; 4]| 0.2126 * t[0] + 0.7152 * t[1] + 0.0722 * t[2];
        let seen = mean.iter().map(luminance);
        self.means.push(seen.map(|l| l.min(BRIGHTEST)).collect());
        if self.means.len() == MOST_BATCHES {
            // Merges pairs of batches: keeps the means over the first two, the first four, and so on.
            let mut keep = false;
            self.means.retain(|_| {
                keep = !keep;
                !keep
            });
            self.size *= 2;
        }
    }

    /// Standard error of the newest mean (root mean square over the pixels), relative to the mean luminance. `None` with too few
    /// batches, 0 for a black image.
    pub(super) fn relative_error(&self) -> Option<f64> {
        let count = self.means.len();
        let newest = self.means.last().filter(|_| count >= FEWEST_BATCHES)?;
        let (mut squares, mut sum) = (0.0, 0.0);
        for (pixel, &mean) in newest.iter().enumerate() {
            let total = |batches: usize| match batches {
                0 => 0.0,
                n => n as f64 * f64::from(self.means[n - 1][pixel]),
            };
            let spread: f64 = (0..count)
                .map(|k| (total(k + 1) - total(k) - f64::from(mean)).powi(2))
                .sum();
            squares += spread / (count * (count - 1)) as f64;
            sum += f64::from(mean);
        }
        let pixels = newest.len() as f64;
        Some(if sum > 0.0 {
            (squares / pixels).sqrt() / (sum / pixels)
        } else {
            0.0
        })
    }
}

/// At most `most` of `pixels` numbers: one at random of each of as many stretches of equal length. A fixed step would be a pattern of columns where
/// it divides the width.
fn spread(pixels: usize, most: usize) -> Vec<usize> {
    if pixels <= most {
        return (0..pixels).collect();
    }
    let number = |i: usize| {
        let mut state = tea::<16>(i as u32, pixels as u32);
        let [start, end] = [i, i + 1].map(|i| i * pixels / most);
        start + ((end - start) as f64 * rnd(&mut state)) as usize
    };
    (0..most).map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sampling::r2;

    /// Estimates after each look, with the number of frames. Pixel `i` of a frame is `frame(index, i)`.
    fn estimates(frames: u32, pixels: usize, frame: impl Fn(u32, usize) -> f32) -> Vec<(u32, f64)> {
        seen(Noise::new(pixels), frames, frame)
    }

    fn seen(mut noise: Noise, frames: u32, frame: impl Fn(u32, usize) -> f32) -> Vec<(u32, f64)> {
        let pixels = noise.pixels().to_vec();
        let (mut sums, mut list) = (vec![0.0f64; pixels.len()], Vec::new());
        for index in 0..frames {
            for (pixel, sum) in pixels.iter().zip(&mut sums) {
                *sum += f64::from(frame(index, *pixel));
            }
            let count = index + 1;
            if noise.next_look() == count {
                let mean = |sum: &f64| [(sum / f64::from(count)) as f32; 4];
                noise.look(&sums.iter().map(mean).collect::<Vec<_>>());
                list.extend(noise.relative_error().map(|error| (count, error)));
            }
        }
        list
    }

    #[test]
    fn pixels_are_spread_evenly_over_rows_and_columns() {
        for [width, height] in [[640, 360], [1280, 720], [1024, 4096], [7, 5]] {
            let pixels = spread(width * height, MOST_PIXELS);
            assert_eq!(pixels.len(), MOST_PIXELS.min(width * height));
            assert!(pixels.windows(2).all(|pair| pair[0] < pair[1]));
            assert!(pixels.last().is_some_and(|last| *last < width * height));
            // Bands of an eighth of the width and of the height have as many each, but for chance.
            let most_off = |band: &dyn Fn(usize) -> usize| {
                let mut counts = [0.0f64; 8];
                pixels.iter().for_each(|p| counts[band(*p)] += 1.0);
                let mean = pixels.len() as f64 / 8.0;
                let off = counts.iter().map(|count| (count / mean - 1.0).abs());
                off.fold(0.0, f64::max)
            };
            if width >= 8 {
                assert!(most_off(&|p| p % width * 8 / width) < 0.1, "{width}");
                assert!(most_off(&|p| p / width * 8 / height) < 0.01, "{height}");
            }
        }
    }

    /// Noise that differs from column to column and from row to row, in a few pixels much more.
    #[test]
    fn some_pixels_tell_what_all_do() {
        const WIDTH: usize = 640;
        let pixels = WIDTH * 360;
        let frame = |index: u32, pixel: usize| {
            let mut state = tea::<4>(index, pixel as u32);
            let (x, y) = (pixel % WIDTH, pixel / WIDTH);
            let rare = if (x * 7 + y * 13).is_multiple_of(101) {
                5.0
            } else {
                1.0
            };
            let spread = rare * (0.1 + (x % 4) as f64 / 10.0 + (y % 5) as f64 / 20.0);
            (10.0 + spread * (rnd(&mut state) - 0.5)) as f32
        };
        let of = |most| seen(Noise::of_some(pixels, most), 16, frame);
        for ((frames, some), (_, all)) in of(MOST_PIXELS).into_iter().zip(of(pixels)) {
            assert!((some / all - 1.0).abs() < 0.04, "{frames}: {some} {all}");
        }
    }

    #[test]
    fn random_frames_have_their_standard_error() {
        // Uniform in 0..2: mean 1, variance 1/3.
        let random = |index: u32, pixel: usize| {
            let mut state = tea::<16>(index, pixel as u32);
            2.0 * rnd(&mut state) as f32
        };
        let list = estimates(1024, 4000, random);
        assert_eq!(list.last().map(|e| e.0), Some(1024));
        for (frames, error) in list {
            let exact = (1.0 / 3.0 / f64::from(frames)).sqrt();
            assert!(
                (error / exact - 1.0).abs() < 0.05,
                "{frames}: {error} for {exact}"
            );
        }
    }

    #[test]
    fn even_sequences_err_less_than_random_ones_and_less_than_is_told() {
        let even = |index: u32, pixel: usize| {
            let shift = pixel as f64 * 0.618_033_988_749_895;
            2.0 * (r2(index).x + shift).fract() as f32
        };
        for (frames, told) in estimates(1024, 500, even).into_iter().filter(|e| e.0 >= 32) {
            let mean = |pixel| {
                (0..frames).map(|i| f64::from(even(i, pixel))).sum::<f64>() / f64::from(frames)
            };
            let squares: f64 = (0..500).map(|pixel| (mean(pixel) - 1.0).powi(2)).sum();
            let (error, random) = (
                (squares / 500.0).sqrt(),
                (1.0 / 3.0 / f64::from(frames)).sqrt(),
            );
            assert!(
                error < told && told < random,
                "{frames}: {error} {told} {random}"
            );
        }
    }

    #[test]
    fn looks_come_at_most_a_quarter_apart_and_batches_stay_few() {
        let mut noise = Noise::new(3);
        let mut before = 0u32;
        for _ in 0..60 {
            let next = noise.next_look();
            assert!(
                before < 4 || next <= before + before.div_ceil(4),
                "{before} {next}"
            );
            noise.look(&[[1.0; 4]; 3]);
            assert!(noise.means.len() <= MOST_BATCHES);
            before = next;
        }
        assert_eq!(noise.relative_error(), Some(0.0));
    }

    #[test]
    fn the_disc_of_the_sun_does_not_rule_and_black_is_still() {
        let disc = |index: u32, pixel: usize| match pixel {
            0 => 1e6 * (index % 2) as f32,
            _ => 5.0,
        };
        // The disc cancels once a batch has two frames, long before the estimate is used.
        let mut list = estimates(64, 10_000, disc);
        list.retain(|e| e.0 > 8);
        assert!(list.len() > 3, "{list:?}");
        assert!(list.iter().all(|e| e.1 < 1e-6), "{list:?}");
        assert_eq!(estimates(4, 10, |_, _| 0.0), [(4, 0.0)]);
    }
}
