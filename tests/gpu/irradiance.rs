//! The irradiance cube of the device: a uniform sky, the reference data, the lecture's random numbers, refinement.

use std::f64::consts::PI;

use crate::common::{Table, Worst, at_share};
use crate::gpu::{Cube, Device, HALF_ROUNDOFF, clear_day, finish, named};
use glam::DVec3;
use skylight::daylight::irradiance::IrradianceMethod;
use skylight::daylight::preetham::Preetham;
use skylight::daylight::sky::{Conditions, Daylight, Sky, SkyModel};
use skylight::gpu::{ContextOptions, Optional, Route};
use skylight::passes::sky::irradiance::IrradianceSettings;
use skylight::passes::sky::route::CubeRoute;
use skylight::validate::check::Check;
use skylight::validate::light::{METHODS, SkyLight, compare_random, compare_uniform};

/// Edge of a face of the tested maps, texels; the program uses 32.
const EDGE: u32 = 64;

/// The passes of the device, without errors.
struct Light(SkyLight);

impl Light {
    fn new(
        device: &mut Device,
        method: IrradianceMethod,
        samples: u32,
        samples_per_pass: u32,
    ) -> Self {
        Self::by(
            device,
            IrradianceSettings {
                edge: EDGE,
                method,
                samples,
                samples_per_pass,
                route: None,
            },
        )
    }

    fn by(device: &mut Device, settings: IrradianceSettings) -> Self {
        Self(SkyLight::new(device, settings).expect("cubes"))
    }

    fn pass(&mut self, device: &mut Device, daylight: &Daylight) {
        self.0.pass(device, daylight).expect("drawn");
    }

    fn refine(&mut self, device: &mut Device, daylight: &Daylight) {
        self.0.refine(device, daylight).expect("drawn");
    }

    /// E in klx from the 32-bit sums.
    fn exact(&self, device: &mut Device) -> Cube {
        self.0.exact(device).expect("read back")
    }
}

#[test]
fn a_constant_sky_gives_pi_on_all_faces() {
    let mut device = Device::new();
    let mut check = Check::relative("E of a constant sky L = 1", "π", "", 1e-3);
    for method in METHODS {
        let settings = IrradianceSettings {
            edge: EDGE,
            method,
            samples: 256,
            samples_per_pass: 128,
            route: None,
        };
        compare_uniform(&mut device, &mut check, settings).expect("drawn");
    }
    finish(&check);
}

#[test]
fn the_map_holds_the_mean_of_the_sums_and_not_a_pi_th_of_it() {
    let mut device = Device::new();
    let mut light = Light::new(&mut device, IrradianceMethod::Quasi, 128, 128);
    light.refine(&mut device, &clear_day(120.0, 35.0));
    let exact = light.exact(&mut device);
    let map = device.read_cube(light.0.irradiance.image());
    // The map is the 32-bit mean rounded to 16 bits.
    let mut worst = Worst::new("map against sum / count", 1.01 * HALF_ROUNDOFF);
    for ((_, found, texel), mean) in named(&map).zip(&exact.texels) {
        worst.see((found / *mean - 1.0).abs().max_element(), texel);
    }
    worst.finish();
}

/// Preetham's sky of a row of the reference data, over a ground of the given radiance, cd/m².
fn reference_sky(turbidity: f64, theta_s_deg: f64, ground_luminance: DVec3) -> Daylight {
    let mut day = clear_day(90.0, 90.0 - theta_s_deg);
    let theta_s = theta_s_deg.to_radians();
    let sun = DVec3::new(theta_s.sin(), theta_s.cos(), 0.0);
    day.sky = Sky::Preetham(Preetham::new(turbidity, sun));
    day.guard.sun_direction = sun;
    day.guard.scale = 1.0;
    day.guard.night = DVec3::ZERO;
    day.ground_luminance = ground_luminance;
    day
}

/// One sky of the reference data: its normals with E over black ground and over ground of albedo 0.2, lux.
struct Case {
    turbidity: f64,
    theta_s_deg: f64,
    up: DVec3,
    normals: Vec<(DVec3, [DVec3; 2])>,
}

fn cases() -> Option<Vec<Case>> {
    let table = Table::read("irradiance_reference.csv")?;
    let mut cases: Vec<Case> = Vec::new();
    for row in table.rows() {
        let (turbidity, theta_s_deg) = (row.get("T"), row.get("theta_s_deg"));
        let same = |c: &Case| (c.turbidity, c.theta_s_deg) == (turbidity, theta_s_deg);
        if !cases.last().is_some_and(same) {
            cases.push(Case {
                turbidity,
                theta_s_deg,
                up: DVec3::ZERO,
                normals: Vec::new(),
            });
        }
        let case = cases.last_mut().expect("pushed");
        // In the file z is up; its y becomes north.
        let normal = DVec3::new(row.get("nx"), row.get("nz"), -row.get("ny")).normalize();
        let black = row.get3(["E_R", "E_G", "E_B"]);
        case.normals
            .push((normal, [black, row.get3(["Eg_R", "Eg_G", "Eg_B"])]));
        if normal.y > 0.999_999 {
            case.up = black;
        }
    }
    Some(cases)
}

/// Relative errors for all skies and normals of the file: of the largest channel, relative to E of the up normal.
fn reference_errors(method: IrradianceMethod, samples: u32) -> Option<Vec<(f64, String)>> {
    let cases = cases()?;
    let mut device = Device::new();
    let mut light = Light::new(&mut device, method, samples, samples);
    let mut errors = Vec::new();
    for case in &cases {
        for (which, albedo) in [0.0, 0.2].into_iter().enumerate() {
            let ground = case.up * (albedo / PI);
            let day = reference_sky(case.turbidity, case.theta_s_deg, ground);
            light.refine(&mut device, &day);
            let map = light.exact(&mut device);
            for (normal, expected) in &case.normals {
                let difference = map.sample(*normal) * 1e3 - expected[which];
                let error = difference.abs().max_element() / case.up.max_element();
                let (t, z) = (case.turbidity, case.theta_s_deg);
                errors.push((
                    error,
                    format!("T {t} theta_s {z} albedo {albedo} n {normal}"),
                ));
            }
        }
    }
    Some(errors)
}

fn rms(errors: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = errors.len() as f64;
    (errors.map(|e| e * e).sum::<f64>() / count).sqrt()
}

fn check_reference(method: IrradianceMethod, samples: u32, rms_allowed: f64, largest: f64) {
    let Some(errors) = reference_errors(method, samples) else {
        return;
    };
    let rms = rms(errors.iter().map(|e| e.0));
    println!(
        "{method:?} {samples}: rms {rms:.2e} of E_up over {} rows (allowed {rms_allowed})",
        errors.len()
    );
    let mut worst = Worst::new("irradiance against the reference", largest);
    for (error, at) in errors {
        worst.see(error, at);
    }
    worst.finish();
    assert!(rms <= rms_allowed, "rms {rms:e}");
}

#[test]
fn quasi_meets_the_reference() {
    // Required of low-discrepancy samples under skies with a bright glow: 0.3 % rms with 256, 0.1 % with 1024.
    check_reference(IrradianceMethod::Quasi, 256, 3e-3, 0.02);
    check_reference(IrradianceMethod::Quasi, 1024, 1e-3, 0.01);
}

#[test]
fn monte_carlo_meets_the_reference_within_its_noise() {
    // The standard deviation of one sample is at most half of E_up (1/sqrt(1024) of it is 1.6 %); single normals in the glow
    // of a low sun have several times that.
    check_reference(IrradianceMethod::MonteCarlo, 1024, 0.02, 0.15);
}

#[test]
fn the_exact_sum_meets_the_reference() {
    // No noise: the remaining error is from the size of the coarse sky's texels.
    check_reference(IrradianceMethod::Exact, 1, 5e-4, 3e-3);
}

#[test]
fn spherical_harmonics_meet_the_reference_roughly() {
    // Ramamoorthi & Hanrahan 2001: for one light, order 2 has about 1 % of error on average and 9 % at worst.
    check_reference(IrradianceMethod::Sh, 1, 0.015, 0.09);
}

#[test]
fn monte_carlo_noise_falls_with_the_root_of_the_samples() {
    let mut device = Device::new();
    let day = clear_day(140.0, 50.0);
    let mut quasi = Light::new(&mut device, IrradianceMethod::Quasi, 4096, 1024);
    quasi.refine(&mut device, &day);
    let truth = quasi.exact(&mut device);
    let up = truth.sample(DVec3::Y).y;
    let mut noise = |samples| {
        let mut light = Light::new(&mut device, IrradianceMethod::MonteCarlo, samples, 64);
        light.refine(&mut device, &day);
        let found = light.exact(&mut device);
        let errors: Vec<f64> = found
            .texels
            .iter()
            .zip(&truth.texels)
            .map(|(a, b)| (a.y - b.y) / up)
            .collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        (rms(errors.into_iter()), mean)
    };
    let (coarse, coarse_mean) = noise(64);
    let (fine, fine_mean) = noise(1024);
    println!(
        "rms {coarse:.4} of E_up with 64 samples, {fine:.4} with 1024: ratio {:.2}",
        coarse / fine
    );
    println!("means {coarse_mean:.1e}, {fine_mean:.1e}");
    // 16 times the samples give a quarter of the noise, estimated from 6144 texels (1 %); 10 % for the quasi map's own error.
    assert!((coarse / fine - 4.0).abs() < 0.4);
    // Texels are independent: the error of the mean is the noise over sqrt(6144) = 78; four of those.
    assert!(coarse_mean.abs() < 4.0 * coarse / 78.0);
    assert!(fine_mean.abs() < 4.0 * fine / 78.0);
}

#[test]
fn random_numbers_and_directions_are_the_cpus() {
    let mut device = Device::new();
    let mut check = Check::relative("E of one sample against pi L(direction)", "CPU", "", 5e-3);
    compare_random(&mut device, &mut check, EDGE).expect("drawn");
    finish(&check);
}

#[test]
fn four_passes_make_the_same_map_as_one() {
    let mut device = Device::new();
    let day = clear_day(200.0, 25.0);
    let maps = [128, 512].map(|per_pass| {
        let mut light = Light::new(&mut device, IrradianceMethod::Quasi, 512, per_pass);
        light.refine(&mut device, &day);
        assert_eq!(light.0.irradiance.samples_done(), 512);
        light.exact(&mut device)
    });
    // The same 512 float32 additions in another order: at most a few times 512 roundings of 2^-24.
    let mut worst = Worst::new("4 x 128 against 1 x 512 samples", 512.0 / 16_777_216.0);
    for ((_, one, texel), other) in named(&maps[0]).zip(&maps[1].texels) {
        worst.see((one / *other - 1.0).abs().max_element(), texel);
    }
    worst.finish();
}

#[test]
fn a_changed_sky_starts_anew() {
    let mut device = Device::new();
    let (first, second) = (clear_day(90.0, 20.0), clear_day(270.0, 60.0));
    let mut changed = Light::new(&mut device, IrradianceMethod::Quasi, 1024, 64);
    changed.refine(&mut device, &first);
    changed.pass(&mut device, &second);
    assert_eq!(
        changed.0.irradiance.samples_done(),
        0,
        "a draft is not kept"
    );
    let draft = device.read_cube(changed.0.irradiance.image());
    changed.refine(&mut device, &second);
    let refined = device.read_cube(changed.0.irradiance.image());
    let brightest = refined
        .texels
        .iter()
        .fold(0.0, |most: f64, e| most.max(e.max_element()));
    let mut worst = Worst::new("a draft against the map, of the largest irradiance", 0.03);
    for ((_, e, texel), refined) in named(&draft).zip(&refined.texels) {
        worst.see((e - *refined).abs().max_element() / brightest, texel);
    }
    worst.finish();
    let mut fresh = Light::new(&mut device, IrradianceMethod::Quasi, 1024, 64);
    fresh.refine(&mut device, &second);
    let (a, b) = (changed.exact(&mut device), fresh.exact(&mut device));
    let different = a.texels.iter().zip(&b.texels).filter(|(a, b)| a != b);
    assert_eq!(different.count(), 0, "something of the old sky is left");
    println!("{} texels are the same", a.texels.len());
}

#[test]
fn three_routes_make_the_same_map() {
    let mut device = Device::new();
    let day = clear_day(150.0, 40.0);
    let mut map = |method, route| {
        let settings = IrradianceSettings {
            method,
            samples: 4096,
            samples_per_pass: 4096,
            route: Some(route),
            ..IrradianceSettings::default()
        };
        let mut light = Light::by(&mut device, settings);
        light.refine(&mut device, &day);
        let sums = device.read(light.0.irradiance.sums()).into_iter();
        sums.map(|t| DVec3::from_array(crate::gpu::rgb(t)) / f64::from(t[3]))
            .collect::<Vec<_>>()
    };
    let layered = map(IrradianceMethod::Quasi, CubeRoute::Geometry);
    let computed = map(IrradianceMethod::Quasi, CubeRoute::Compute);
    let exact = map(IrradianceMethod::Exact, CubeRoute::Geometry);
    let exact_computed = map(IrradianceMethod::Exact, CubeRoute::Compute);
    let up = exact.iter().map(|e| e.max_element()).fold(0.0, f64::max);
    let compare = |what, tolerance, a: &[DVec3], b: &[DVec3]| {
        let mut worst = Worst::new(what, tolerance);
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            worst.see((*a - *b).abs().max_element() / up, i);
        }
        worst.finish();
    };
    // The same sum of the same lookups; directions differ by rounding, and lookups by 1/256 of the resulting change.
    compare(
        "compute against gl_Layer, of E_max",
        1e-4,
        &computed,
        &layered,
    );
    compare("the exact sums, of E_max", 1e-6, &exact_computed, &exact);
    compare(
        "gl_Layer against the exact sum, of E_max",
        2e-3,
        &layered,
        &exact,
    );
    compare(
        "compute against the exact sum, of E_max",
        2e-3,
        &computed,
        &exact,
    );
}

#[test]
fn a_device_without_geometry_shaders_draws_the_same_maps() {
    let mut with = Device::with(&ContextOptions {
        route: Some(Route::Fragment),
        ..ContextOptions::default()
    });
    let mut without = Device::with(&ContextOptions {
        without: vec![Optional::GeometryShader],
        ..ContextOptions::default()
    });
    assert_eq!(CubeRoute::of(&with.context), CubeRoute::Geometry);
    assert_eq!(CubeRoute::of(&without.context), CubeRoute::Compute);
    for model in [SkyModel::Preetham, SkyModel::Hosek, SkyModel::Atmosphere] {
        // Low enough for a visible ground, a glow and, with Preetham, dark corners.
        let day = sky_of(model, 3.0);
        let [a, b] = [&mut with, &mut without].map(|device| {
            let mut light = Light::new(device, IrradianceMethod::Quasi, 256, 128);
            light.refine(device, &day);
            let sky = device.read_cube(light.0.sky.image());
            let map = light.exact(device);
            (sky.texels, map.texels)
        });
        let mut worst = Worst::new("sky by compute against gl_Layer", 2.0 * HALF_ROUNDOFF);
        for (i, (a, b)) in a.0.iter().zip(&b.0).enumerate() {
            worst.see(
                ((*a - *b) / a.max(DVec3::splat(1e-9))).abs().max_element(),
                i,
            );
        }
        worst.finish();
        let up = a.1.iter().map(|e| e.max_element()).fold(0.0, f64::max);
        let mut worst = Worst::new("E by compute against gl_Layer, of E_max", 5e-4);
        for (i, (a, b)) in a.1.iter().zip(&b.1).enumerate() {
            worst.see((*a - *b).abs().max_element() / up, i);
        }
        worst.finish();
    }
}

#[test]
fn a_device_that_does_not_filter_floats_draws_the_same_maps() {
    let mut with = Device::new();
    let mut without = Device::with(&ContextOptions {
        without: vec![Optional::FloatFilter],
        ..ContextOptions::default()
    });
    for model in [SkyModel::Preetham, SkyModel::Atmosphere] {
        let day = sky_of(model, 20.0);
        let [a, b] = [&mut with, &mut without].map(|device| {
            let mut light = Light::new(device, IrradianceMethod::Quasi, 256, 128);
            light.refine(device, &day);
            light.exact(device).texels
        });
        let up = a.iter().map(|e| e.max_element()).fold(0.0, f64::max);
        let apart = a.iter().zip(&b).map(|(a, b)| (*a - *b).abs());
        let mut apart: Vec<f64> = apart.map(|d| d.max_element() / up).collect();
        let [most, all] = [0.98, 1.0].map(|share| at_share(&mut apart, share));
        println!(
            "E with filters in the shader, of E_max: 98 % within {most:.1e}, all within {all:.1e}"
        );
        // Devices may filter with weights of 8 bits. On the diagonals of faces rounding decides about the frame of the samples.
        assert!(most <= 1e-3 && all <= 0.03, "{model:?}: {most} {all}");
    }
}

fn sky_of(model: SkyModel, sun_elevation_deg: f64) -> Daylight {
    Daylight::new(&Conditions {
        model,
        sun_elevation_deg,
        ..Conditions::default()
    })
}
