//! Normal maps and vertex colours: the vertex streams reach the pixels, and normals tilt as the maps say.

use crate::common::Worst;
use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, pixel_ray, settings, showing};
use glam::{DVec3, Vec3};
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, Encoding, Material, Scene, Texture};

/// Half a step of the normal map's 8 bits in each of two components, plus the error of the octahedral encoding.
const STEP: f64 = 1.0 / 127.5;

/// A normal map with the same direction in every texel.
fn map_of(direction: Vec3) -> Texture {
    let byte = |v: f32| (127.5 * v + 127.5).round() as u8;
    let [x, y, z] = direction.to_array().map(byte);
    Texture {
        name: "tilt".into(),
        width: 2,
        height: 2,
        rgba8: [x, y, z, 255].repeat(4),
        encoding: Encoding::Linear,
        wrap: Default::default(),
    }
}

/// Applies the normal map to a scene, with the tangent along u at every vertex.
fn with_map(mut scene: Scene, direction: Vec3, tangent: impl Fn(Vec3) -> Vec3) -> Scene {
    scene.textures.push(map_of(direction));
    for material in &mut scene.materials {
        material.normal_texture = Some(0);
    }
    let snorm = |v: f32| (v * 32_767.0).round() as i16;
    let of = |n: &[f32; 3]| {
        let [x, y, z] = tangent(Vec3::from(*n)).to_array().map(snorm);
        [x, y, z, i16::MAX]
    };
    scene.tangents = scene.normals.iter().map(of).collect();
    scene
}

/// Unit tangent toward the east on a sphere.
fn east(n: Vec3) -> Vec3 {
    Vec3::Y.cross(n).normalize_or(Vec3::X)
}

fn ball() -> Scene {
    Model::default()
        .sphere([0.0; 3], 1.0, 64, &matt(0.5))
        .build()
}

fn shown(device: &mut Device, scene: &Scene, camera: &Camera, show: Show) -> Picture {
    let day = clear_day(200.0, 40.0);
    device.picture(scene, showing(show, settings(240, 180)), &day, camera)
}

/// The sphere's normal at a pixel; `None` off the sphere, at its silhouette and at its poles.
fn on_ball(camera: &Camera, size: [usize; 2], pixel: [usize; 2]) -> Option<DVec3> {
    let (eye, ray) = (camera.eye.as_dvec3(), pixel_ray(camera, size, pixel));
    let (along, away) = (-eye.dot(ray), eye.length_squared());
    let half = (along * along - away + 1.0).sqrt();
    let n = eye + ray * (along - half);
    (half.is_finite() && n.dot(ray) < -0.25 && n.y.abs() < 0.9).then_some(n)
}

#[test]
fn a_map_tilts_the_normals_of_a_ball_as_it_says() {
    let mut device = Device::new();
    let camera = camera([1.2, 0.9, 2.4], [0.0; 3]);
    for tilt in [
        Vec3::Z,
        Vec3::new(0.6, 0.0, 0.8),
        Vec3::new(0.0, -0.48, 0.877),
    ] {
        let picture = shown(
            &mut device,
            &with_map(ball(), tilt, east),
            &camera,
            Show::Normal,
        );
        // Facets of a sphere with 64 rings are within 1e-3 of the sphere.
        let mut worst = Worst::new(
            "normal under a map against the tilted normal of a ball",
            STEP + 2e-3,
        );
        let mut seen = 0;
        for (pixel, drawn) in picture.pixels() {
            let Some(n) = on_ball(&camera, picture.size, pixel) else {
                continue;
            };
            let u = east(n.as_vec3()).as_dvec3();
            let v = n.cross(u);
            let [x, y, z] = tilt.as_dvec3().to_array();
            let expected = (u * x + v * y + n * z).normalize();
            worst.see((drawn - expected).length(), format!("{tilt} {pixel:?}"));
            seen += 1;
        }
        worst.finish();
        assert!(seen > 4000, "{seen}");
    }
}

#[test]
fn colours_at_vertices_reach_the_pixels() {
    let mut device = Device::new();
    let mut scene = ball();
    // Red follows x, green y and blue z.
    let unorm = |v: f32| ((0.5 * v + 0.5) * 65_535.0).round() as u16;
    let colour = |p: &[f32; 3]| {
        let [r, g, b] = p.map(unorm);
        [r, g, b, u16::MAX]
    };
    scene.colours = scene.positions.iter().map(colour).collect();
    scene.parts[0].has_colours = true;
    let camera = camera([1.2, 0.9, 2.4], [0.0; 3]);
    let picture = shown(&mut device, &scene, &camera, Show::Albedo);
    // The albedo is stored in 8 bits.
    let mut worst = Worst::new("rho_d by the colours of vertices", 0.5 / 255.0 + 2e-3);
    for (pixel, drawn) in picture.pixels() {
        if let Some(n) = on_ball(&camera, picture.size, pixel) {
            let expected = 0.5 * (0.5 * n + 0.5);
            worst.see((drawn - expected).abs().max_element(), format!("{pixel:?}"));
        }
    }
    worst.finish();
}

#[test]
fn a_map_never_mirrors_the_view_into_the_surface() {
    let mut device = Device::new();
    // A wave that leans away from a viewer at a grazing angle: its reflection vector points below the horizon.
    let lean = Vec3::new(0.0, 0.3, 0.954);
    let camera = camera([0.0, 1.5, 30.0], [0.0, 1.0, 0.0]);
    let east = |_: Vec3| Vec3::X;
    let water = |specular: f32| {
        let material = Material {
            specular: [specular; 3],
            ..matt(0.1)
        };
        with_map(Model::default().ground(25.0, &material).build(), lean, east)
    };
    let matt = shown(&mut device, &water(0.0), &camera, Show::Normal);
    let mirror = shown(&mut device, &water(0.02), &camera, Show::Normal);
    let (mut below, mut seen) = (0, 0);
    let mut lowest = Worst::new("how far below the horizon a map mirrors the view", 2e-3);
    let mut kept = Worst::new("normal under a map of what does not mirror", STEP);
    for ((pixel, n), (_, plain)) in mirror.pixels().zip(matt.pixels()) {
        let ray = pixel_ray(&camera, mirror.size, pixel);
        if n == DVec3::ZERO || ray.y > -0.01 {
            continue;
        }
        let r = |n: DVec3| ray - 2.0 * ray.dot(n) * n;
        lowest.see((-r(n).y).max(0.0), format!("{pixel:?}: {n}"));
        let expected = DVec3::new(0.0, 0.954, -0.3);
        kept.see((plain - expected).length(), format!("{pixel:?}"));
        below += usize::from(r(expected).y < 0.0);
        seen += 1;
    }
    lowest.finish();
    kept.finish();
    println!("{below} of {seen} pixels would mirror what is below the horizon");
    assert!(below > 500, "{below} of {seen}");
}
