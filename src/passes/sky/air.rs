//! The air between the eye and the surfaces: its table for every direction and distance ([`crate::daylight::atmosphere::aerial`]), made
//! again when sun, air or the altitude of the eye change; and the sky behind them, seen from that altitude. Turning the eye, moving it on a level and tiles of a picture need no other.

use std::sync::Arc;

use bytemuck::Zeroable;
use glam::{IVec4, Vec2, Vec3};

use crate::daylight::atmosphere::aerial::{AZIMUTHS, DENSITY_ROWS, Rays, SOURCE_ROWS, STEPS};
use crate::daylight::atmosphere::colour;
use crate::daylight::atmosphere::medium::GROUND_RADIUS;
use crate::daylight::atmosphere::scattered_sky::ScatteredSky;
use crate::daylight::atmosphere::sky_view::toward;
use crate::daylight::colour::rgb_from_xyz;
use crate::daylight::sky::{Daylight, Sky};
use crate::gpu::{
    Context, Format, Image, ImageDesc, Pass, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;
use crate::passes::sky::atmosphere::{AtmosphereView, air_model};
use crate::passes::sky::cube::SkyBehind;
use crate::passes::{compute, kilo};
use crate::scene::Bounds;

/// Diagonal of the scene from which the air in it is drawn, metres: in less there is nothing to see.
pub const LEAST_SCENE: f32 = 200.0;

/// Least altitude of the eye, metres: rays of an eye in the ground have no length.
const LEAST_ALTITUDE: f64 = 1.0;

gpu_struct! {
    /// Sun and eye.
    pub struct Push: push of AIR_COMP {
        sun_sine: f32,
        altitude: f32,
        ceiling: f32,
        horizon: f32,
    }
}

gpu_struct! {
    /// See `include/air.glsl`.
    pub struct AirBlock: air of LIGHTING_FRAG, DOME_GATHER_FRAG, DOME_SPECULAR_FRAG {
        rayleigh: [f32; 4],
        aerosol: [f32; 4],
        ozone: [f32; 4],
        transmittance: [Vec3; 4],
        inscatter: [Vec3; 4],
        veil: Vec3,
        sun: Vec3,
        toward_sun: Vec2,
        altitude: f32,
        ceiling: f32,
        horizon: f32,
        ground_radius: f32,
        asymmetry: f32,
        sizes: IVec4,
    }
}

const SIZES: IVec4 = IVec4::new(
    AZIMUTHS as i32,
    SOURCE_ROWS as i32,
    DENSITY_ROWS as i32,
    STEPS as i32,
);

/// The size of the table for the shader that fills it.
fn constants() -> [(&'static str, u32); 4] {
    [
        ("AZIMUTHS", AZIMUTHS as u32),
        ("SOURCE_ROWS", SOURCE_ROWS as u32),
        ("DENSITY_ROWS", DENSITY_ROWS as u32),
        ("STEPS", STEPS as u32),
    ]
}

/// The air before the eye, as shaders look it up.
#[derive(Clone, Copy)]
pub struct AirBefore<'a> {
    /// `None`: there is none, or it is not drawn.
    table: Option<&'a Image>,
    /// The sky behind, kcd/m².
    behind: Option<&'a Image>,
    block: AirBlock,
}

impl Default for AirBefore<'_> {
    /// No air.
    fn default() -> Self {
        // exp(0) at four wavelengths: transmittance 1.
        let block = AirBlock {
            transmittance: [Vec3::splat(0.25); 4],
            ceiling: 1.0,
            sizes: SIZES,
            ..AirBlock::zeroed()
        };
        Self {
            table: None,
            behind: None,
            block,
        }
    }
}

impl<'a> AirBefore<'a> {
    /// The sky behind as the eye sees it; without air, `sky`.
    pub fn sky_or(&self, sky: &'a Image) -> &'a Image {
        self.behind.unwrap_or(sky)
    }

    /// Binds it in a pass; without a table, `other` takes its place, as every binding must be written.
    pub fn sampled_by<'r>(&self, pass: Pass<'r>, other: &'r Image) -> Pass<'r>
    where
        'a: 'r,
    {
        pass.sample("air_table", self.table.unwrap_or(other), Sampler::Linear)
            .uniform("air", &self.block)
    }
}

/// The pass that fills the table.
pub struct Air {
    pipeline: Pipeline,
    table: Image,
    /// Tables of the air, and the view from the altitude of the eye.
    view: AtmosphereView,
    behind: SkyBehind,
    /// y of the lowest point of the scene, metres.
    lowest: f64,
    /// Daylight and altitude, km, of the newest table and sky.
    drawn: Option<(Daylight, f64)>,
}

impl Air {
    /// Creates pipelines and images for a scene within `bounds`; a face of the sky's cube has `edge` texels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, bounds: &Bounds, edge: u32) -> Result<Self> {
        let size = [STEPS * AZIMUTHS, 4 * SOURCE_ROWS + STEPS].map(|n| n as u32);
        let table = ImageDesc::flat("air", Format::R32G32B32A32_SFLOAT, size).stored();
        Ok(Self {
            pipeline: compute(context, "air", &shaders::AIR_COMP, &constants())?,
            table: Image::new(context, &table)?,
            view: AtmosphereView::new(context)?,
            behind: SkyBehind::new(context, edge)?,
            lowest: bounds.min.y.into(),
            drawn: None,
        })
    }

    /// The air before an eye whose y is `eye`, metres. Without an atmosphere there is none.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        daylight: &Daylight,
        eye: f32,
    ) -> AirBefore<'_> {
        let Sky::Atmosphere(sky) = &daylight.sky else {
            return AirBefore::default();
        };
        let place = sky.atmosphere.air.altitude_m;
        let altitude = altitude_of(place, eye.into(), self.lowest) / 1000.0;
        let rays = Rays::new(altitude);
        let is_drawn = |(of, at): &(Daylight, f64)| of == daylight && *at == altitude;
        if !self.drawn.as_ref().is_some_and(is_drawn) {
            let here = sky.from_altitude(1000.0 * rays.altitude);
            let views = self.view.record(recorder, &here);
            self.behind.record(recorder, daylight, &here, views);
            let rows = 2 * SOURCE_ROWS + (2 * DENSITY_ROWS).div_ceil(AZIMUTHS);
            recorder
                .pass("air", &self.pipeline)
                .uniform("model", &air_model(&sky.atmosphere))
                .storage("air", self.view.tables())
                .push(&Push {
                    sun_sine: sky.brighter().direction.y as f32,
                    altitude: rays.altitude as f32,
                    ceiling: rays.ceiling as f32,
                    horizon: rays.horizon as f32,
                })
                .store("air_table", &self.table)
                .dispatch_over([AZIMUTHS as u32, rows as u32, 1]);
            self.drawn = Some((daylight.clone(), altitude));
        }
        AirBefore {
            table: Some(&self.table),
            behind: Some(self.behind.image()),
            block: block_of(daylight, sky, &rays),
        }
    }

    /// Makes the next table and sky new.
    pub fn invalidate(&mut self) {
        self.view.invalidate();
        self.drawn = None;
    }

    /// The table, see `include/air.glsl`.
    pub fn image(&self) -> &Image {
        &self.table
    }
}

/// Altitude of an eye above the sea, metres. y = 0 lies at the altitude of the place; a scene that would reach below the sea is lifted
/// until its lowest point is there.
pub fn altitude_of(place: f64, eye: f64, lowest: f64) -> f64 {
    let lift = (-(place + lowest)).max(0.0);
    (place + eye + lift).max(LEAST_ALTITUDE)
}

fn block_of(daylight: &Daylight, sky: &ScatteredSky, rays: &Rays) -> AirBlock {
    let (medium, guard) = (&sky.atmosphere.medium, &daylight.guard);
    let light = sky.brighter();
    let white: glam::DVec3 = colour::XYZ.map(rgb_from_xyz).into_iter().sum();
    AirBlock {
        rayleigh: medium.rayleigh.as_vec4().to_array(),
        aerosol: medium.aerosol.as_vec4().to_array(),
        ozone: medium.ozone.as_vec4().to_array(),
        transmittance: colour::XYZ.map(|xyz| (rgb_from_xyz(xyz) / white).as_vec3()),
        inscatter: colour::XYZ.map(|xyz| kilo(rgb_from_xyz(xyz) * (guard.scale * light.share))),
        veil: kilo(daylight.veil()),
        sun: light.direction.as_vec3(),
        toward_sun: toward(light.direction).as_vec2(),
        altitude: rays.altitude as f32,
        ceiling: rays.ceiling as f32,
        horizon: rays.horizon as f32,
        ground_radius: GROUND_RADIUS as f32,
        asymmetry: medium.asymmetry as f32,
        sizes: SIZES,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eye_is_at_its_altitude_and_nothing_is_below_the_sea() {
        // Above the place; in a valley below it; of a model whose y are altitudes.
        assert_eq!(altitude_of(1500.0, 2.0, 0.0), 1502.0);
        assert_eq!(altitude_of(1500.0, -200.0, -300.0), 1300.0);
        assert_eq!(altitude_of(0.0, 2500.0, 800.0), 2500.0);
        // The lowest point would be at -300 m, at -100 m: lifted.
        assert_eq!(altitude_of(0.0, 20.0, -300.0), 320.0);
        assert_eq!(altitude_of(200.0, 20.0, -300.0), 320.0);
        // Below everything.
        assert_eq!(altitude_of(0.0, -50.0, 0.0), LEAST_ALTITUDE);
    }
}
