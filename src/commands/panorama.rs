//! The sphere of directions as images: equirectangular, a cross of cube faces, or six faces.

use std::f64::consts::PI;
use std::thread;

use glam::DVec3;

use crate::cli::Layout;
use crate::daylight::cube;

/// Face names in Vulkan's order.
pub const FACE_NAMES: [&str; 6] = ["px", "nx", "py", "ny", "pz", "nz"];

/// Column and row of each face in the cross, in Vulkan's order. Adjacent faces are not rotated against each other.
const CROSS: [(usize, usize); 6] = [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)];

/// An image, rows from the top.
pub struct Picture {
    /// Width and height, texels.
    pub size: [u32; 2],
    /// RGB; the fourth component is 1.
    pub texels: Vec<[f32; 4]>,
}

/// A function of a unit direction, called from several threads.
type Value<'v> = &'v (dyn Fn(DVec3) -> DVec3 + Sync);

/// Index and texels of one row.
type Row<'t> = (usize, &'t mut [[f32; 4]]);

/// Number of rows that [`draw`] reports progress for; `size` is the edge of a cube face, texels.
pub fn rows(layout: Layout, size: u32) -> u64 {
    match layout {
        Layout::Equirect => 2 * u64::from(size),
        Layout::Cross => 3 * u64::from(size),
        Layout::Faces => 6 * u64::from(size),
    }
}

/// Draws the images of `layout` with `value` at each texel centre; `size` is the edge of a cube face, texels.
pub fn draw(layout: Layout, size: u32, value: Value<'_>, done: &(dyn Fn() + Sync)) -> Vec<Picture> {
    let n = size as usize;
    match layout {
        Layout::Equirect => {
            let direction = |i, j| Some(equirect_direction(i, j, 4 * n, 2 * n));
            vec![picture([4 * size, 2 * size], &direction, value, done)]
        }
        Layout::Cross => {
            let direction = |i, j| cross_direction(i, j, n);
            vec![picture([4 * size, 3 * size], &direction, value, done)]
        }
        Layout::Faces => (0..cube::FACES)
            .map(|face| {
                let direction = |i, j| Some(cube::texel_direction(face, i, j, n));
                picture([size, size], &direction, value, done)
            })
            .collect(),
    }
}

/// Direction of an equirectangular texel. The first row is the zenith, the first column north; azimuth runs clockwise to the right.
fn equirect_direction(i: usize, j: usize, width: usize, height: usize) -> DVec3 {
    let azimuth = 2.0 * PI * (i as f64 + 0.5) / width as f64;
    let elevation = PI * (0.5 - (j as f64 + 0.5) / height as f64);
    let (sin_az, cos_az) = azimuth.sin_cos();
    let (sin_el, cos_el) = elevation.sin_cos();
    DVec3::new(sin_az * cos_el, sin_el, -cos_az * cos_el)
}

fn cross_direction(i: usize, j: usize, size: usize) -> Option<DVec3> {
    let cell = (i / size, j / size);
    let face = CROSS.iter().position(|place| *place == cell)?;
    Some(cube::texel_direction(face, i % size, j % size, size))
}

/// Draws an image, with rows distributed over all cores. Texels without a direction are 0.
fn picture(
    size: [u32; 2],
    direction: &(dyn Fn(usize, usize) -> Option<DVec3> + Sync),
    value: Value<'_>,
    done: &(dyn Fn() + Sync),
) -> Picture {
    let width = size[0] as usize;
    let mut texels = vec![[0.0, 0.0, 0.0, 1.0]; width * size[1] as usize];
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut hands: Vec<Vec<Row<'_>>> = (0..threads).map(|_| Vec::new()).collect();
    for (j, row) in texels.chunks_mut(width).enumerate() {
        hands[j % threads].push((j, row));
    }
    thread::scope(|scope| {
        for hand in hands {
            scope.spawn(move || {
                for (j, row) in hand {
                    for (i, texel) in row.iter_mut().enumerate() {
                        if let Some(direction) = direction(i, j) {
                            *texel = value(direction).as_vec3().extend(1.0).to_array();
                        }
                    }
                    done();
                }
            });
        }
    });
    Picture { size, texels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_of_an_equirect_are_north_and_clockwise() {
        let near = |i, j, expected: DVec3| {
            let found = equirect_direction(i, j, 400, 200);
            assert!((found - expected).length() < 0.02, "{i} {j} {found}");
        };
        near(0, 99, DVec3::NEG_Z);
        near(100, 99, DVec3::X);
        near(200, 99, DVec3::Z);
        near(300, 99, DVec3::NEG_X);
        near(0, 0, DVec3::Y);
        near(123, 199, DVec3::NEG_Y);
    }

    #[test]
    fn a_cross_has_no_seam_inside() {
        // Adjacent texels of the cross are adjacent on the sphere.
        let n = 16;
        for (i, j) in (0..4 * n - 1).flat_map(|i| (0..3 * n - 1).map(move |j| (i, j))) {
            let Some(here) = cross_direction(i, j, n) else {
                continue;
            };
            for next in [cross_direction(i + 1, j, n), cross_direction(i, j + 1, n)] {
                assert!(next.is_none_or(|d| d.dot(here) > 0.98), "{i} {j}");
            }
        }
    }

    #[test]
    fn every_layout_covers_the_sphere() {
        for (layout, pictures) in [
            (Layout::Equirect, 1),
            (Layout::Cross, 1),
            (Layout::Faces, 6),
        ] {
            let drawn = draw(layout, 8, &|d| d, &|| ());
            assert_eq!(drawn.len(), pictures);
            let all = || drawn.iter().flat_map(|p| &p.texels);
            for axis in 0..3 {
                let (low, high) = all().fold((0f32, 0f32), |(low, high), t| {
                    (low.min(t[axis]), high.max(t[axis]))
                });
                assert!(low < -0.97 && high > 0.97, "{layout:?} {axis} {low} {high}");
            }
        }
    }
}
