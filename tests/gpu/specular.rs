//! The sky that the device prefilters for rough metals against the CPU's.

use crate::common::Worst;
use crate::gpu::{Device, clear_day, constant_sky, named};
use skylight::daylight::cube::CubeMap;
use skylight::daylight::cube_pyramid::CubePyramid;
use skylight::daylight::ggx;
use skylight::daylight::sky::Daylight;
use skylight::passes::sky::cube::{SkyCube, SkyImages};
use skylight::passes::sky::route::CubeRoute;
use skylight::passes::sky::specular::{EDGE, SpecularCube};

const SAMPLES: u32 = 64;

const ROUTES: [CubeRoute; 2] = [CubeRoute::Geometry, CubeRoute::Compute];

fn filtered(device: &mut Device, daylight: &Daylight, route: CubeRoute) -> SpecularCube {
    let mut sky = SkyCube::new(&device.context, 16).expect("a sky cube");
    device.run(|rec| {
        let mut specular = SpecularCube::new(rec, SAMPLES, Some(route)).expect("a cube");
        let images = sky.record(rec, daylight);
        let levels = specular.record(rec, &images).levels();
        assert_eq!(levels, ggx::levels(EDGE));
        specular
    })
}

#[test]
fn every_level_is_the_cpus() {
    let mut device = Device::new();
    let daylight = clear_day(137.0, 20.0);
    let cpu = CubePyramid::new(CubeMap::from_fn(EDGE as usize, |d| {
        daylight.radiance(d) * 1e-3
    }));
    let levels = ggx::levels(EDGE);
    for route in ROUTES {
        let specular = filtered(&mut device, &daylight, route);
        for level in 0..levels {
            let cube = device.read_cube(specular.level(level as usize).expect("a level"));
            assert_eq!(cube.edge as u32, EDGE >> level);
            let samples = ggx::filtered_samples(ggx::roughness(level, levels), SAMPLES);
            // Every seventh texel; seven is coprime to the edges.
            let mut errors: Vec<f64> = cube
                .texels()
                .step_by(7)
                .map(|(direction, found, _)| {
                    let expected = ggx::prefiltered(&cpu, direction, &samples).as_dvec3();
                    (found / expected - 1.0).abs().max_element()
                })
                .collect();
            errors.sort_by(f64::total_cmp);
            let (most, worst) = (errors[errors.len() * 95 / 100], errors[errors.len() - 1]);
            println!("{route:?} level {level}: 95 % {most:.1e}, worst {worst:.1e}");
            assert!(
                most < 3e-3 && worst < 1e-2,
                "{route:?} {level} {most} {worst}"
            );
        }
    }
}

#[test]
fn a_constant_sky_stays_what_it_is() {
    let mut device = Device::new();
    let mut worst = Worst::new("L = 1 kcd/m² prefiltered", 1e-3);
    let specular = filtered(&mut device, &constant_sky(1000.0), ROUTES[0]);
    let mut see = |device: &mut Device, specular: &SpecularCube, what: &str| {
        for level in 0..ggx::levels(EDGE) as usize {
            let cube = device.read_cube(specular.level(level).expect("a level"));
            for (_, found, texel) in named(&cube) {
                let error = (found - 1.0).abs().max_element();
                worst.see(error, format!("{what} {level} {texel}"));
            }
        }
    };
    see(&mut device, &specular, "of the sky");
    // Filtered again, from the assembled levels: each of them was written.
    let mut specular = specular;
    let mut again = device.run(|rec| SpecularCube::new(rec, SAMPLES, None).expect("a cube"));
    let mut sky = SkyCube::new(&device.context, 16).expect("a sky cube");
    device.run(|rec| {
        let images = sky.record(rec, &constant_sky(1000.0));
        let smooth = specular.record(rec, &images);
        again.record(rec, &SkyImages { smooth, ..images });
    });
    see(&mut device, &again, "again");
    worst.finish();
}
