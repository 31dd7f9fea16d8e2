//! The irradiance of the device's sky: a uniform one, a clear one, random numbers; and the white furnace.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::check::Check;
use super::device::{Cube, Device, camera, rgb, settings};
use super::model::{Model, clear_day, constant_sky, matt};
use crate::daylight::irradiance::IrradianceMethod;
use crate::daylight::quadrature::SphereQuadrature;
use crate::daylight::sampling::{cosine_hemisphere, rnd, tea};
use crate::daylight::sky::Daylight;
use crate::daylight::tangent_frame::to_world;
use crate::gpu::Result;
use crate::passes::light::lighting::Show;
use crate::passes::sky::cube::SkyCube;
use crate::passes::sky::irradiance::{Irradiance, IrradianceSettings};
use crate::scene::Scene;

/// All methods of the irradiance.
pub const METHODS: [IrradianceMethod; 4] = [
    IrradianceMethod::Quasi,
    IrradianceMethod::MonteCarlo,
    IrradianceMethod::Exact,
    IrradianceMethod::Sh,
];

/// The sky and irradiance passes, without the rest of a frame.
pub struct SkyLight {
    /// The sky.
    pub sky: SkyCube,
    /// Its irradiance.
    pub irradiance: Irradiance,
}

impl SkyLight {
    /// The passes; nothing is drawn yet.
    ///
    /// # Errors
    /// The device fails.
    pub fn new(device: &mut Device, settings: IrradianceSettings) -> Result<Self> {
        Ok(Self {
            sky: SkyCube::new(&device.context, 256)?,
            irradiance: device.run(|rec| Irradiance::new(rec, settings))??,
        })
    }

    /// Adds the samples of one pass.
    ///
    /// # Errors
    /// The device fails.
    pub fn pass(&mut self, device: &mut Device, daylight: &Daylight) -> Result<()> {
        device.run(|rec| {
            let sky = self.sky.record(rec, daylight);
            self.irradiance.record(rec, &sky, daylight);
        })
    }

    /// Adds all samples.
    ///
    /// # Errors
    /// The device fails.
    pub fn refine(&mut self, device: &mut Device, daylight: &Daylight) -> Result<()> {
        self.pass(device, daylight)?;
        while !self.irradiance.is_complete() {
            self.pass(device, daylight)?;
        }
        Ok(())
    }

    /// E in klx from the 32-bit sums.
    ///
    /// # Errors
    /// The device fails.
    pub fn exact(&self, device: &mut Device) -> Result<Cube> {
        let sums = device.read(self.irradiance.sums())?.into_iter();
        Ok(Cube {
            edge: self.irradiance.settings().edge as usize,
            texels: sums.map(|t| rgb(t) / f64::from(t[3])).collect(),
        })
    }
}

/// A uniform sky of L = 1 gives E = π in every direction.
///
/// # Errors
/// The device fails.
pub fn compare_uniform(
    device: &mut Device,
    check: &mut Check,
    settings: IrradianceSettings,
) -> Result<()> {
    let mut light = SkyLight::new(device, settings)?;
    light.refine(device, &constant_sky(1000.0))?;
    for (_, found, [face, i, j]) in device.read_cube(light.irradiance.image())?.texels() {
        let at = || format!("{:?}, face {face} texel {i} {j}", settings.method);
        check.see_colour(found, DVec3::splat(PI), PI, at);
    }
    Ok(())
}

/// The first direction that the shader draws in a texel: the lecture's random numbers.
pub fn first_direction(texel: u32, face: u32, normal: DVec3) -> DVec3 {
    let mut t = tea::<4>(texel, face);
    let (xi1, xi2) = (rnd(&mut t), rnd(&mut t));
    to_world(cosine_hemisphere(DVec2::new(xi1, xi2)), normal)
}

/// The map of one random sample holds π times the sky in the direction that the CPU draws for each texel.
///
/// One bilinear tap: its weights have 8 bits on the device, so the error is 1/256 of the step between neighbouring texels, which is largest at the
/// horizon and in the glow.
///
/// # Errors
/// The device fails.
pub fn compare_random(device: &mut Device, check: &mut Check, edge: u32) -> Result<()> {
    let settings = IrradianceSettings {
        edge,
        method: IrradianceMethod::MonteCarlo,
        samples: 1,
        samples_per_pass: 1,
        route: None,
    };
    let mut light = SkyLight::new(device, settings)?;
    light.refine(device, &clear_day(230.0, 35.0))?;
    let found = light.exact(device)?;
    let sky = device.read_cube(light.sky.image())?;
    for (normal, value, [face, i, j]) in found.texels() {
        let direction = first_direction(j as u32 * edge + i as u32, face as u32, normal);
        // At the horizon, neighbours differ by the whole luminance of the sky.
        if direction.y.abs() < 2.0 / 256.0 {
            continue;
        }
        let expected = sky.sample(direction) * PI;
        let at = || format!("face {face} texel {i} {j}, {direction}");
        check.see_colour(value, expected, expected.min_element(), at);
    }
    Ok(())
}

/// A clear sky's irradiance against quadrature on the CPU, on 26 normals, relative to that of the horizontal.
fn compare_clear(device: &mut Device, check: &mut Check) -> Result<()> {
    let day = clear_day(150.0, 40.0);
    let settings = IrradianceSettings {
        samples: 4096,
        samples_per_pass: 1024,
        ..IrradianceSettings::default()
    };
    let mut light = SkyLight::new(device, settings)?;
    light.refine(device, &day)?;
    let map = light.exact(device)?;
    // Rings and columns: the sun's glow is a few degrees wide; the horizon lies between two rings.
    let quadrature = SphereQuadrature::sphere(192, 384);
    let up = day.sky_irradiance_up.max_element();
    for code in (0..27).filter(|code| *code != 13) {
        let axis = |place: i32| f64::from(code / place % 3 - 1);
        let normal = DVec3::new(axis(9), axis(3), axis(1)).normalize();
        let expected = quadrature.irradiance(normal, |direction| day.radiance(direction));
        let found = map.sample(normal) * 1e3;
        check.see_colour(found, expected, up, || format!("normal {normal:.2}"));
    }
    Ok(())
}

/// All checks of the irradiance.
///
/// # Errors
/// The device fails.
pub fn irradiance(device: &mut Device) -> Result<Vec<Check>> {
    let mut uniform = Check::relative("irradiance of a sky L = 1", "π", "", 1e-3);
    for method in METHODS {
        let settings = IrradianceSettings {
            method,
            samples: 256,
            samples_per_pass: 256,
            ..IrradianceSettings::default()
        };
        compare_uniform(device, &mut uniform, settings)?;
    }
    let mut clear = Check::relative("irradiance, clear sky", "quadrature", "lux", 0.005);
    compare_clear(device, &mut clear)?;
    let mut random = Check::relative("random numbers", "CPU", "klx", 5e-3);
    compare_random(device, &mut random, 32)?;
    Ok(vec![uniform, clear, random])
}

/// White convex bodies.
pub fn white_bodies() -> [(&'static str, Scene); 2] {
    let white = matt(1.0);
    [
        (
            "sphere",
            Model::default().sphere([0.0; 3], 1.0, 24, &white).build(),
        ),
        ("cube", Model::default().cube([0.0; 3], 0.8, &white).build()),
    ]
}

/// A white body under a uniform sky is invisible: every pixel reads L = 1. Returns the number of pixels that show the body.
///
/// # Errors
/// The device fails.
pub fn compare_furnace(
    device: &mut Device,
    check: &mut Check,
    (name, scene): (&str, &Scene),
    eye: [f32; 3],
    method: IrradianceMethod,
) -> Result<usize> {
    let (camera, day) = (camera(eye, [0.0; 3]), constant_sky(1000.0));
    let mut set = settings(160, 120);
    set.irradiance.method = method;
    let picture = device.picture(scene, set, &day, &camera)?;
    for (pixel, value) in picture.pixels() {
        check.see_colour(value, DVec3::ONE, 1.0, || {
            format!("{name} from {eye:?}, pixel {pixel:?}")
        });
    }
    let depth = device.picture(scene, set.showing(Show::Depth), &day, &camera)?;
    Ok(depth.pixels().filter(|(_, d)| d.x > 0.0).count())
}

/// The white furnace.
///
/// # Errors
/// The device fails.
pub fn furnace(device: &mut Device) -> Result<Vec<Check>> {
    // E is stored in 16 bits, a step of which is 0.1 %; devices may cut off instead of rounding.
    let mut check = Check::relative("white furnace, sphere and cube", "L = 1", "kcd/m²", 1e-3);
    let mut shown = Check::absolute("white furnace, pixels of the body", "outline", "", 0.5);
    for (name, scene) in &white_bodies() {
        let eye = [2.0, 1.5, 2.5];
        let body = (*name, scene);
        let pixels = compare_furnace(device, &mut check, body, eye, IrradianceMethod::Quasi)?;
        // Between an eighth and a half of the picture: an empty picture would pass.
        let share = pixels as f64 / (160.0 * 120.0);
        let expected = share.clamp(0.125, 0.5);
        shown.see(share, expected, 0.01, || (*name).to_owned());
    }
    Ok(vec![check, shown])
}
