//! The tables of an atmosphere's view on the device, one under the sun and one under the moon: each is made again when its light, air or altitude
//! change; the tables of the air are copied there when the air changes.

use std::sync::Arc;

use glam::{DVec3, IVec2, Vec2, Vec3};

use crate::daylight::atmosphere::Atmosphere;
use crate::daylight::atmosphere::air::Air;
use crate::daylight::atmosphere::field::{COEFFICIENTS, HIGH_SLOPE, HIGH_SUN, LEAST_SUN};
use crate::daylight::atmosphere::medium::{
    DENSITY_STEP, GROUND_RADIUS, LN_AIR_DENSITY, OZONE_HALF_WIDTH, OZONE_PEAK, RAYLEIGH_MOMENTS,
    THICKNESS, rayleigh_phase,
};
use crate::daylight::atmosphere::scattered_sky::ScatteredSky;
use crate::daylight::atmosphere::sky_view::{HALF_HEIGHT, WIDTH};
use crate::daylight::atmosphere::solve::Effort;
use crate::daylight::atmosphere::{GROUND_CELLS, VIEW_CELLS, colour, columns};
use crate::daylight::colour::rgb_from_xyz;
use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;
use crate::gpu::{
    Buffer, BufferKind, Context, Format, Image, ImageDesc, Pipeline, Recorder, Result, shaders,
};
use crate::gpu_struct;
use crate::passes::{compute, kilo};

gpu_struct! {
    /// Sun and observer.
    pub struct ViewPush: push of SKY_VIEW_COMP {
        sun_sine: f32,
        altitude: f32,
        horizon: f32,
    }
}

gpu_struct! {
    /// The air; see [`crate::daylight::atmosphere::medium::Medium`].
    pub struct AirModel: model of SKY_VIEW_COMP, AIR_COMP {
        rayleigh: [f32; 4],
        aerosol_scattering: [f32; 4],
        aerosol: [f32; 4],
        ozone: [f32; 4],
        rgb: [Vec3; 4],
        ln_density: [f32; 64],
        density_step: f32,
        ozone_tent: Vec2,
        scale_height: f32,
        asymmetry: f32,
        rayleigh_phase: Vec3,
        ground_albedo: f32,
        ground_radius: f32,
        thickness: f32,
        sun_radius: f32,
        depth_size: IVec2,
        field_size: IVec2,
        low_steps: i32,
        sun_grid: Vec3,
        cells: i32,
        ground_cells: i32,
    }
}

/// The pass that fills the table of the view.
pub struct AtmosphereView {
    pipeline: Pipeline,
    /// Optical depths, field, irradiance of the ground.
    tables: Buffer,
    /// Under the sun and under the moon.
    views: [Image; 2],
    /// The air whose tables are on the device, at sea level.
    air: Option<Air>,
    /// Air and light of each view.
    drawn: [Option<(Air, DVec3)>; 2],
}

/// The tables of a sky's view, kcd/m², not clipped.
#[derive(Clone, Copy)]
pub struct SkyViews<'v> {
    /// Under the sun.
    pub sun: &'v Image,
    /// Under a sun in the place of the moon; the same as [`Self::sun`] if the sky has no moon.
    pub moon: &'v Image,
}

impl AtmosphereView {
    /// Creates pipeline, tables and image.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>) -> Result<Self> {
        let grid = Effort::FULL.grid;
        let entries = columns::WIDTH * columns::HEIGHT
            + grid.altitudes * grid.suns * COEFFICIENTS
            + grid.suns;
        let bytes = (entries * size_of::<[f32; 4]>()) as u64;
        let size = [WIDTH as u32, 2 * HALF_HEIGHT as u32];
        let view = |name| {
            let desc = ImageDesc::flat(name, Format::R32G32B32A32_SFLOAT, size).stored();
            Image::new(context, &desc)
        };
        Ok(Self {
            pipeline: compute(context, "sky view", &shaders::SKY_VIEW_COMP, &[])?,
            tables: Buffer::new(context, "air", BufferKind::Storage, bytes)?,
            views: [view("sky view")?, view("sky view, moon")?],
            air: None,
            drawn: [None; 2],
        })
    }

    /// The views of `sky`; made where they are not those of the last call.
    pub fn record(&mut self, recorder: &mut Recorder, sky: &ScatteredSky) -> SkyViews<'_> {
        let atmosphere = &sky.atmosphere;
        let air = Air {
            altitude_m: 0.0,
            ..atmosphere.air
        };
        if self.air != Some(air) {
            recorder.write(&self.tables, bytemuck::cast_slice(&tables(atmosphere)));
            self.air = Some(air);
        }
        for (i, light) in [Some(&sky.sun), sky.moon.as_ref()].into_iter().enumerate() {
            let Some(toward) = light.map(|light| light.direction) else {
                continue;
            };
            let wanted = Some((atmosphere.air, toward));
            if self.drawn[i] != wanted {
                self.draw(recorder, atmosphere, toward, &self.views[i]);
                self.drawn[i] = wanted;
            }
        }
        let [sun, moon] = &self.views;
        SkyViews {
            sun,
            moon: if sky.moon.is_some() { moon } else { sun },
        }
    }

    fn draw(&self, recorder: &mut Recorder, atmosphere: &Atmosphere, toward: DVec3, view: &Image) {
        let push = ViewPush {
            sun_sine: toward.y as f32,
            altitude: (atmosphere.observer() - GROUND_RADIUS) as f32,
            horizon: columns::horizon_cosine(atmosphere.observer()).asin() as f32,
        };
        recorder
            .pass("sky view", &self.pipeline)
            .uniform("model", &air_model(atmosphere))
            .storage("air", &self.tables)
            .push(&push)
            .store("sky_view", view)
            .dispatch();
    }

    /// Makes the next views new.
    pub fn invalidate(&mut self) {
        self.drawn = [None; 2];
    }

    /// The tables of the air of the last views.
    pub fn tables(&self) -> &Buffer {
        &self.tables
    }

    /// The tables of the view under the sun and under the moon, kcd/m².
    pub fn images(&self) -> &[Image; 2] {
        &self.views
    }
}

/// Optical depths to the top of the air, the field, the irradiance of the ground.
fn tables(atmosphere: &Atmosphere) -> Vec<[f32; 4]> {
    let depth = |entry: &[f32; 3]| {
        let columns = Vec3::from_array(*entry).as_dvec3();
        let depth = atmosphere.medium.optical_depth(columns);
        depth.as_vec4().to_array()
    };
    let depths = atmosphere.columns.entries.iter().map(depth);
    let field = atmosphere.field.texels.iter().flatten().copied();
    let ground = atmosphere.field.ground.iter().copied();
    depths.chain(field).chain(ground).collect()
}

/// The air as the shaders know it.
pub(in crate::passes::sky) fn air_model(atmosphere: &Atmosphere) -> AirModel {
    let (medium, grid) = (&atmosphere.medium, &atmosphere.field.grid);
    let isotropic = rayleigh_phase(0.0);
    let int = |n: usize| n as i32;
    AirModel {
        rayleigh: medium.rayleigh.as_vec4().to_array(),
        aerosol_scattering: medium.aerosol_scattering().as_vec4().to_array(),
        aerosol: medium.aerosol.as_vec4().to_array(),
        ozone: medium.ozone.as_vec4().to_array(),
        rgb: colour::XYZ.map(|xyz| kilo(rgb_from_xyz(xyz))),
        // The table of 61, and its last value again.
        ln_density: std::array::from_fn(|i| LN_AIR_DENSITY[i.min(LN_AIR_DENSITY.len() - 1)] as f32),
        density_step: DENSITY_STEP as f32,
        ozone_tent: Vec2::new(OZONE_PEAK as f32, OZONE_HALF_WIDTH as f32),
        scale_height: medium.scale_height as f32,
        asymmetry: medium.asymmetry as f32,
        rayleigh_phase: Vec3::new(
            isotropic as f32,
            (rayleigh_phase(1.0) - isotropic) as f32,
            RAYLEIGH_MOMENTS[2] as f32,
        ),
        ground_albedo: medium.ground_albedo as f32,
        ground_radius: GROUND_RADIUS as f32,
        thickness: THICKNESS as f32,
        sun_radius: SUN_ANGULAR_RADIUS as f32,
        depth_size: IVec2::new(int(columns::WIDTH), int(columns::HEIGHT)),
        field_size: IVec2::new(int(grid.altitudes), int(grid.suns)),
        low_steps: int(grid.low_steps()),
        sun_grid: Vec3::new(LEAST_SUN as f32, HIGH_SUN as f32, HIGH_SLOPE as f32),
        cells: int(VIEW_CELLS),
        ground_cells: int(GROUND_CELLS),
    }
}
