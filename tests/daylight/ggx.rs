//! A sky prefiltered for rough metals against an integral over the sky itself.

use glam::{DVec3, Vec3};
use skylight::daylight::cube::CubeMap;
use skylight::daylight::cube_pyramid::CubePyramid;
use skylight::daylight::ggx::{SAMPLES, distribution, filtered_samples, prefiltered};
use skylight::daylight::irradiance::ExactIrradiance;
use skylight::daylight::quadrature::gauss_legendre;
use skylight::daylight::sampling::{hammersley, uniform_sphere};
use skylight::daylight::{Conditions, Daylight, SkyModel, tangent_frame};

fn daylight(elevation: f64) -> Daylight {
    Daylight::new(&Conditions {
        model: SkyModel::Hosek,
        sun_azimuth_deg: 137.0,
        sun_elevation_deg: elevation,
        ..Conditions::default()
    })
}

/// The mean of the radiance over the lobe about `r`, by nodes in the angle of the half vector and azimuth.
fn integral(daylight: &Daylight, r: DVec3, alpha: f64) -> DVec3 {
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for (x, weight) in gauss_legendre(128) {
        let theta = std::f64::consts::FRAC_PI_4 * x * x * x;
        let (sine, cosine) = (2.0 * theta).sin_cos();
        let lobe = distribution(alpha, theta.cos()) * cosine * sine * x * x * weight;
        for k in 0..384 {
            let (s, c) = (std::f64::consts::TAU * (f64::from(k) + 0.5) / 384.0).sin_cos();
            let l = tangent_frame::to_world(DVec3::new(c * sine, s * sine, cosine), r);
            sum += lobe * daylight.radiance(l.normalize());
            weights += lobe;
        }
    }
    sum / weights
}

/// Roughness, and rms of the relative error in the brightest channel over directions of the whole sphere.
fn rms_error(elevation: f64, roughness: f64) -> f64 {
    const COUNT: u32 = 60;
    let daylight = daylight(elevation);
    let cube = CubePyramid::new(CubeMap::from_fn(256, |d| daylight.radiance(d)));
    let samples = filtered_samples(roughness, SAMPLES);
    let square = |k: u32| {
        let r = uniform_sphere(hammersley(k, COUNT));
        let expected = integral(&daylight, r, roughness * roughness).as_vec3();
        let error: Vec3 = prefiltered(&cube, r, &samples) / expected - 1.0;
        f64::from(error.abs().max_element()).powi(2)
    };
    ((0..COUNT).map(square).sum::<f64>() / f64::from(COUNT)).sqrt()
}

#[test]
fn prefiltered_skies_are_the_integral_over_the_lobe() {
    for (elevation, roughness) in [
        (50.0, 0.25),
        (50.0, 1.0),
        (10.0, 0.25),
        (10.0, 0.5),
        (10.0, 1.0),
    ] {
        let rms = rms_error(elevation, roughness);
        println!(
            "sun {elevation}, roughness {roughness}: {:.2} % rms",
            100.0 * rms
        );
        assert!(rms < 4e-3, "{elevation} {roughness} {rms}");
    }
}

#[test]
fn the_roughest_metal_reflects_the_irradiance() {
    // D of α = 1 is uniform, so that L(r, 1) is E(r)/π.
    let daylight = daylight(25.0);
    let map = CubeMap::from_fn(128, |d| daylight.radiance(d));
    let exact = ExactIrradiance::new(&map);
    let cube = CubePyramid::new(map);
    let samples = filtered_samples(1.0, SAMPLES);
    for k in 0..20 {
        let r = uniform_sphere(hammersley(k, 20));
        let expected = exact.at(r) / std::f64::consts::PI;
        let error = prefiltered(&cube, r, &samples).as_dvec3() / expected - 1.0;
        assert!(error.abs().max_element() < 5e-3, "{r} {error}");
    }
}
