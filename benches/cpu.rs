//! CPU benchmarks: sky, irradiance, model loading, tone curves. Run with `cargo bench`.

use std::hint::black_box;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use skylight::daylight::cube::{CubeMap, texel_direction, texels};
use skylight::daylight::irradiance::ExactIrradiance;
use skylight::daylight::tone_curve::ToneCurve;
use skylight::daylight::{Conditions, Daylight, SkyModel};
use skylight::scene::{LoadOptions, load};

fn daylight(model: SkyModel) -> Daylight {
    Daylight::new(&Conditions {
        model,
        ..Conditions::default()
    })
}

/// Directions over the full sphere.
fn directions() -> Vec<DVec3> {
    texels(16)
        .map(|(face, i, j)| texel_direction(face, i, j, 16))
        .collect()
}

/// Sky radiance in one direction.
fn sky(c: &mut Criterion) {
    let directions = directions();
    let mut group = c.benchmark_group("sky radiance");
    group.throughput(Throughput::Elements(directions.len() as u64));
    for model in [SkyModel::Preetham, SkyModel::Hosek] {
        let day = daylight(model);
        group.bench_function(BenchmarkId::from_parameter(format!("{model:?}")), |b| {
            b.iter(|| {
                let sum: DVec3 = directions.iter().map(|d| day.radiance(*d)).sum();
                black_box(sum)
            });
        });
    }
    group.finish();
    c.bench_function("a new daylight", |b| {
        b.iter(|| black_box(daylight(SkyModel::Preetham)));
    });
}

/// Exact irradiance sum over all texels of a sky cube with 32² faces.
fn irradiance(c: &mut Criterion) {
    let day = daylight(SkyModel::Preetham);
    let sky = CubeMap::from_fn(32, |d| day.radiance(d));
    let mut group = c.benchmark_group("exact irradiance");
    group.bench_function("prepare a 32² cube", |b| {
        b.iter(|| black_box(ExactIrradiance::new(black_box(&sky))));
    });
    let exact = ExactIrradiance::new(&sky);
    group.bench_function("one normal of a 32² cube", |b| {
        b.iter(|| black_box(exact.at(black_box(DVec3::new(0.6, 0.64, 0.48)))));
    });
    // 6144 normals times 6144 texels: one map takes almost a second.
    group.sample_size(10);
    group.bench_function("a whole 32² cube", |b| {
        b.iter(|| black_box(CubeMap::from_fn(32, |n| exact.at(n))));
    });
    group.finish();
}

/// Loads the bundled model.
fn obj(c: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/colonnade.obj");
    let options = LoadOptions::default();
    let triangles = load(&path, &options)
        .expect("the bundled model")
        .scene
        .triangles();
    let mut group = c.benchmark_group("load an OBJ");
    group.throughput(Throughput::Elements(triangles as u64));
    group.sample_size(10);
    group.bench_function("colonnade.obj", |b| {
        b.iter(|| black_box(load(&path, &options).expect("the bundled model")));
    });
    group.finish();
}

/// Applies the tone curves to single colours.
fn tone(c: &mut Criterion) {
    let colours: Vec<DVec3> = (0..1024)
        .map(|i| DVec3::new(0.004, 0.003, 0.002) * f64::from(i))
        .collect();
    let mut group = c.benchmark_group("tone curve");
    group.throughput(Throughput::Elements(colours.len() as u64));
    for curve in [
        ToneCurve::Linear,
        ToneCurve::Exponential,
        ToneCurve::Reinhard,
        ToneCurve::Neutral,
        ToneCurve::Agx,
        ToneCurve::Aces,
    ] {
        group.bench_function(BenchmarkId::from_parameter(format!("{curve:?}")), |b| {
            b.iter(|| {
                let sum: DVec3 = colours.iter().map(|rgb| curve.apply(*rgb)).sum();
                black_box(sum)
            });
        });
    }
    group.finish();
}

criterion_group!(cpu, sky, irradiance, obj, tone);
criterion_main!(cpu);
