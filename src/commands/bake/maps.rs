//! The values of a map: one level, or the mip levels of a cube.

use glam::DVec3;

use crate::cli::{BakeArgs, Layout, Map};
use crate::commands::light::Light;
use crate::commands::panorama::{self, Picture};
use crate::daylight::cube::{CubeMap, FACES};
use crate::daylight::cube_pyramid::CubePyramid;
use crate::daylight::ggx;
use crate::daylight::irradiance::IrradianceEstimator;
use crate::output::CubeLevel;

/// The images of a map at one roughness: one, or six faces.
pub struct Baked {
    /// Of a specular map.
    pub roughness: Option<f64>,
    /// In the order of the files.
    pub pictures: Vec<Picture>,
}

/// The images of the map in a layout: one level, or one for each roughness.
pub fn bake(args: &BakeArgs, layout: Layout, light: &Light) -> Vec<Baked> {
    let levels = match args.map {
        Map::Specular => ggx::levels(args.edge),
        Map::Sky | Map::Irradiance => 1,
    };
    let rows = (0..levels).map(|level| panorama::rows(layout, args.edge >> level));
    let progress = crate::commands::progress(rows.sum(), "rows", light.settings.quiet);
    let draw = |edge: u32, value: &(dyn Fn(DVec3) -> DVec3 + Sync)| {
        panorama::draw(layout, edge, value, &|| progress.inc(1))
    };
    let radiance = |direction: DVec3| light.daylight.radiance(direction);
    let one = |pictures| Baked {
        roughness: None,
        pictures,
    };
    let baked = match args.map {
        Map::Sky => vec![one(draw(args.edge, &radiance))],
        Map::Irradiance => {
            let settings = &light.settings;
            let samples = settings.irradiance_samples;
            let e = IrradianceEstimator::new(settings.irradiance, radiance, samples);
            vec![one(draw(args.edge, &|normal| e.at(normal)))]
        }
        Map::Specular => {
            let sky = CubePyramid::new(cube_of(&draw_faces(args.edge, &radiance)));
            let at = |level| {
                let roughness = ggx::roughness(level, levels);
                let samples = ggx::filtered_samples(roughness, ggx::SAMPLES);
                let filtered = |r| ggx::prefiltered(&sky, r, &samples).as_dvec3();
                let pictures = match level {
                    0 => draw(args.edge, &radiance),
                    _ => draw(args.edge >> level, &filtered),
                };
                Baked {
                    roughness: Some(roughness),
                    pictures,
                }
            };
            (0..levels).map(at).collect()
        }
    };
    progress.finish_and_clear();
    baked
}

fn draw_faces(edge: u32, value: &(dyn Fn(DVec3) -> DVec3 + Sync)) -> Vec<Picture> {
    panorama::draw(Layout::Faces, edge, value, &|| ())
}

/// The six pictures of a cube's faces as a cube map.
fn cube_of(faces: &[Picture]) -> CubeMap {
    let size = faces[0].size[0] as usize;
    let texels = faces.iter().flat_map(|face| &face.texels);
    CubeMap::from_texels(
        size,
        texels
            .map(|t| DVec3::new(t[0].into(), t[1].into(), t[2].into()))
            .collect(),
    )
}

/// The mip levels of a cube: those of the roughnesses, or the halvings of the only one.
pub fn cube_levels(baked: &[Baked]) -> Vec<CubeLevel> {
    match baked {
        [
            Baked {
                roughness: None,
                pictures,
            },
        ] => {
            let pyramid = CubePyramid::new(cube_of(pictures));
            let level = |k: usize| CubeLevel {
                edge: pyramid.edge() >> k,
                texels: pyramid
                    .texels(k)
                    .map(|t| t.extend(1.0).to_array())
                    .collect(),
            };
            (0..pyramid.levels()).map(level).collect()
        }
        levels => levels
            .iter()
            .map(|level| cube_level(&level.pictures))
            .collect(),
    }
}

fn cube_level(faces: &[Picture]) -> CubeLevel {
    debug_assert_eq!(faces.len(), FACES);
    CubeLevel {
        edge: faces[0].size[0],
        texels: faces
            .iter()
            .flat_map(|face| &face.texels)
            .copied()
            .collect(),
    }
}
