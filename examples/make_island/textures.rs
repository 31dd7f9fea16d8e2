//! Images: leaves, sea ripples, grain of ground and stone.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::noise::{Chance, fractal, turbulence};

/// Tiles of the leaf atlas: corner and size in texture coordinates.
pub const BROAD: [Vec2; 2] = [vec2(0.0, 0.0), vec2(0.5, 0.5)];
pub const NEEDLE: [Vec2; 2] = [vec2(0.5, 0.0), vec2(0.5, 0.5)];
pub const SPRAY: [Vec2; 2] = [vec2(0.0, 0.5), vec2(0.5, 0.5)];
pub const FROND: [Vec2; 2] = [vec2(0.5, 0.5), vec2(0.5, 0.5)];

const ATLAS: usize = 512;
const TILE: f32 = 256.0;

/// An image of linear RGB and coverage.
struct Canvas {
    texels: Vec<[f32; 4]>,
}

impl Canvas {
    /// Draws a leaf: a pointed oval from `foot` to `tip` (atlas texels), clipped to its tile.
    fn leaf(&mut self, tile: [Vec2; 2], foot: Vec2, tip: Vec2, width: f32, colour: Vec3) {
        let origin = tile[0] * ATLAS as f32;
        let along = tip - foot;
        let length = along.length();
        let unit = along / length;
        let low = (foot.min(tip) - width).max(Vec2::splat(1.0)).floor();
        let high = (foot.max(tip) + width).min(Vec2::splat(TILE - 2.0)).ceil();
        for y in low.y as usize..=high.y.max(low.y) as usize {
            for x in low.x as usize..=high.x.max(low.x) as usize {
                let p = vec2(x as f32 + 0.5, y as f32 + 0.5) - foot;
                let (t, s) = (p.dot(unit) / length, p.perp_dot(unit).abs());
                if !(0.0..=1.0).contains(&t) {
                    continue;
                }
                let half = width * (std::f32::consts::PI * t.powf(0.8)).sin();
                let cover = (half - s + 0.5).clamp(0.0, 1.0);
                let vein = if s < 0.8 { 1.18 } else { 1.0 };
                let at = (origin.y as usize + y) * ATLAS + origin.x as usize + x;
                blend(
                    &mut self.texels[at],
                    colour * vein * (0.85 + 0.3 * t),
                    cover,
                );
            }
        }
    }
}

fn blend(texel: &mut [f32; 4], colour: Vec3, cover: f32) {
    for (old, new) in texel.iter_mut().zip(colour.to_array()) {
        *old += (new - *old) * cover;
    }
    texel[3] = texel[3].max(cover);
}

/// The leaf atlas, RGBA.
pub fn leaves() -> Vec<u8> {
    let mean = [0.085, 0.125, 0.035, 0.0];
    let mut canvas = Canvas {
        texels: vec![mean; ATLAS * ATLAS],
    };
    let mut chance = Chance::new(77);
    broad(&mut canvas, &mut chance);
    needles(&mut canvas, &mut chance);
    spray(&mut canvas, &mut chance);
    frond(&mut canvas, &mut chance);
    png(
        ATLAS,
        4,
        canvas.texels.iter().flat_map(|[r, g, b, a]| {
            [
                signal(*r),
                signal(*g),
                signal(*b),
                (a * 255.0).round() as u8,
            ]
        }),
    )
}

fn green(chance: &mut Chance) -> Vec3 {
    let t = chance.unit();
    vec3(0.055, 0.10, 0.025) * (1.0 - t) + vec3(0.14, 0.185, 0.05) * t
}

/// A sprig of about thirty small leaves.
fn broad(canvas: &mut Canvas, chance: &mut Chance) {
    for _ in 0..26 {
        let angle = chance.within(0.0, std::f32::consts::TAU);
        let out = vec2(angle.cos(), angle.sin());
        let foot = vec2(128.0, 128.0) + out * chance.within(10.0, 86.0);
        let turn = angle + chance.within(-0.9, 0.9);
        let tip = foot + vec2(turn.cos(), turn.sin()) * chance.within(26.0, 40.0);
        canvas.leaf(BROAD, foot, tip, chance.within(6.0, 8.5), green(chance));
    }
}

/// Needles fanning out from the bottom.
fn needles(canvas: &mut Canvas, chance: &mut Chance) {
    for _ in 0..52 {
        let foot = vec2(
            128.0 + chance.within(-50.0, 50.0),
            chance.within(150.0, 250.0),
        );
        let lean = chance.within(-0.85, 0.85) + (foot.x - 128.0) / 90.0;
        let tip = foot + vec2(lean.sin(), -lean.cos()) * chance.within(80.0, 140.0);
        canvas.leaf(
            NEEDLE,
            foot,
            tip,
            chance.within(2.2, 3.4),
            green(chance) * 0.95,
        );
    }
}

/// The scaly spray of a cypress.
fn spray(canvas: &mut Canvas, chance: &mut Chance) {
    for i in 0..80 {
        let t = i as f32 / 80.0;
        let foot = vec2(
            128.0 + chance.within(-62.0, 62.0) * (1.0 - 0.7 * t),
            250.0 - 190.0 * t,
        );
        let lean = chance.within(-0.6, 0.6);
        let tip = foot + vec2(lean.sin(), -lean.cos()) * chance.within(24.0, 46.0);
        canvas.leaf(
            SPRAY,
            foot,
            tip,
            chance.within(3.5, 6.0),
            green(chance) * 0.85,
        );
    }
}

/// Half-folded leaflets on both sides of a midrib.
fn frond(canvas: &mut Canvas, chance: &mut Chance) {
    for i in 0..34 {
        let t = i as f32 / 34.0;
        let length = 118.0 * (1.0 - t).powf(0.35) * (0.45 + 0.55 * (6.0 * t).min(1.0));
        for side in [-1.0, 1.0] {
            let foot = vec2(128.0, 250.0 - 236.0 * t);
            let lean = side * (1.15 - 0.55 * t + chance.within(-0.06, 0.06));
            let tip = foot + vec2(lean.sin(), -lean.cos()) * length;
            canvas.leaf(FROND, foot, tip, 3.0, green(chance) * 1.1);
        }
    }
    canvas.leaf(
        FROND,
        vec2(128.0, 262.0),
        vec2(128.0, 8.0),
        3.5,
        vec3(0.22, 0.2, 0.09),
    );
}

/// Fine grain around 1 for ground and stone, grey RGB. `sharp` gives veins and pits instead of clouds.
pub fn grain(sharp: bool) -> Vec<u8> {
    const SIZE: usize = 256;
    let texel = |i: usize| {
        let p = vec2((i % SIZE) as f32, (i / SIZE) as f32) / SIZE as f32;
        let v = if sharp {
            0.86 - 0.30 * turbulence(p * 6.0, 5, 6, 5) + 0.14 * fractal(p * 3.0, 5, 3, 9)
        } else {
            0.80 + 0.34 * fractal(p * 8.0, 5, 8, 3)
        };
        [signal(v.clamp(0.0, 1.0)); 3]
    };
    png(SIZE, 3, (0..SIZE * SIZE).flat_map(texel))
}

/// Normal map of a repeating height field; `height` is in units of the image width.
fn normal_map(size: usize, height: impl Fn(Vec2) -> f32) -> Vec<u8> {
    let e = 1.0 / size as f32;
    let texel = |i: usize| {
        let p = vec2((i % size) as f32, (i / size) as f32) * e;
        let dx = (height(p + vec2(e, 0.0)) - height(p - vec2(e, 0.0))) / (2.0 * e);
        let dy = (height(p + vec2(0.0, e)) - height(p - vec2(0.0, e))) / (2.0 * e);
        // Rows run down; the green channel points up.
        let n = vec3(-dx, dy, 1.0).normalize();
        (n * 127.5 + 127.5).round().to_array().map(|v| v as u8)
    };
    png(size, 3, (0..size * size).flat_map(texel))
}

/// Ripples of a calm sea.
pub fn ripples() -> Vec<u8> {
    normal_map(256, |p| {
        let bent = p + 0.03 * vec2(fractal(p * 3.0, 3, 3, 1), fractal(p * 3.0, 3, 3, 2));
        0.010 * fractal(bent * vec2(5.0, 7.0), 4, 0, 4).mul_add(0.0, fractal(bent * 5.0, 4, 5, 4))
            + 0.006 * (1.0 - fractal(bent * 9.0, 3, 9, 8).abs())
    })
}

/// Bumps of rough ground and stone.
pub fn bumps() -> Vec<u8> {
    normal_map(256, |p| {
        0.012 * fractal(p * 8.0, 5, 8, 3) + 0.018 * turbulence(p * 6.0, 5, 6, 5)
    })
}

/// IEC 61966-2-1: the sRGB byte of a linear value.
fn signal(light: f32) -> u8 {
    let v = if light <= 0.003_130_8 {
        12.92 * light
    } else {
        1.055 * light.powf(1.0 / 2.4) - 0.055
    };
    (v.clamp(0.0, 1.0) * 255.0).round() as u8
}

fn png(size: usize, channels: usize, texels: impl Iterator<Item = u8>) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size as u32, size as u32);
    let alpha = channels == 4;
    encoder.set_color(if alpha {
        png::ColorType::Rgba
    } else {
        png::ColorType::Rgb
    });
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("a header in memory");
    let bytes: Vec<u8> = texels.collect();
    writer.write_image_data(&bytes).expect("texels in memory");
    writer.finish().expect("an end in memory");
    file
}
