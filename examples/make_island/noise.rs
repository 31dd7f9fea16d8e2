//! Random numbers and turbulence noise with a fixed seed.

use glam::{Vec2, vec2};

/// A pseudo-random number generator (xorshift64*) with a fixed seed.
#[derive(Clone)]
pub struct Chance(u64);

impl Chance {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Uniform in `low`..`high`.
    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }
}

/// A random value in −1..1 for a lattice point.
fn lattice(x: i32, y: i32, seed: u32) -> f32 {
    let mut h = (x as u32).wrapping_mul(0x85EB_CA6B)
        ^ (y as u32).wrapping_mul(0xC2B2_AE35)
        ^ seed.wrapping_mul(0x27D4_EB2F);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    (h ^ (h >> 15)) as f32 / u32::MAX as f32 * 2.0 - 1.0
}

/// Smooth noise in −1..1 with a lattice spacing of one unit; it repeats after `period` units (0: never).
pub fn noise(p: Vec2, period: i32, seed: u32) -> f32 {
    let cell = p.floor();
    let f = p - cell;
    let s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let wrap = |i: i32| if period > 0 { i.rem_euclid(period) } else { i };
    let at = |dx: i32, dy: i32| {
        let (x, y) = (cell.x as i32 + dx, cell.y as i32 + dy);
        lattice(wrap(x), wrap(y), seed)
    };
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * s.x;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * s.x;
    low + (high - low) * s.y
}

/// Octaves of noise, each with double the frequency and half the amplitude, about −1..1.
pub fn fractal(p: Vec2, octaves: u32, period: i32, seed: u32) -> f32 {
    let (mut sum, mut scale, mut weight) = (0.0, 1.0, 0.5);
    for octave in 0..octaves {
        let offset = if period > 0 {
            Vec2::ZERO
        } else {
            vec2(17.3, -9.1) * octave as f32
        };
        sum += weight * noise(p * scale + offset, period * scale as i32, seed + octave);
        scale *= 2.0;
        weight *= 0.5;
    }
    sum
}

/// Turbulence (Perlin 1985): octaves of folded noise with sharp creases, 0..1.
pub fn turbulence(p: Vec2, octaves: u32, period: i32, seed: u32) -> f32 {
    let (mut sum, mut scale, mut weight) = (0.0, 1.0, 0.5);
    for octave in 0..octaves {
        sum += weight * noise(p * scale, period * scale as i32, seed + octave).abs();
        scale *= 2.0;
        weight *= 0.5;
    }
    sum
}

/// 0 below `low`, 1 above `high`, smooth in between.
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
