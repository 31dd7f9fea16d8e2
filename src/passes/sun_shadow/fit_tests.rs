use glam::UVec2;

use super::*;
use crate::scene::Camera;

fn scene() -> Bounds {
    Bounds {
        min: Vec3::new(-10.0, 0.0, -12.0),
        max: Vec3::new(14.0, 6.0, 9.0),
    }
}

fn view(eye: Vec3, target: Vec3) -> View {
    let camera = Camera {
        eye,
        target,
        fov_deg: 45.0,
        near: 0.01,
    };
    View {
        camera,
        size: UVec2::new(640, 360),
        jitter: Vec2::ZERO,
        sharpen: 0.0,
        window: None,
    }
}

fn suns() -> [Vec3; 4] {
    [
        Vec3::Y,
        Vec3::new(0.3, 0.5, 0.8).normalize(),
        Vec3::new(-0.9, 0.05, 0.1).normalize(),
        Vec3::new(0.01, 0.995, 0.0).normalize(),
    ]
}

#[test]
fn what_is_seen_lies_in_the_map() {
    let view = view(Vec3::new(6.0, 3.0, 5.0), Vec3::new(-4.0, 1.0, -6.0));
    let clip_from_world = view.clip_from_world();
    for sun in suns() {
        let map = fit(sun, &scene(), &scene(), &view, 2048);
        let mut seen = 0;
        for i in 0..4096u32 {
            let unit = Vec3::new(
                (i % 16) as f32 / 15.0,
                (i / 16 % 16) as f32 / 15.0,
                (i / 256) as f32 / 15.0,
            );
            let p = scene().min + unit * (scene().max - scene().min);
            let clip = clip_from_world * p.extend(1.0);
            let s = map.shadow_from_world.transform_point3(p);
            assert!((0.0..=1.0).contains(&s.z), "{p} has depth {}", s.z);
            if clip.w > 0.0 && clip.x.abs() < clip.w && clip.y.abs() < clip.w {
                seen += 1;
                assert!(s.x.abs() <= 1.0 && s.y.abs() <= 1.0, "{p} seen but at {s}");
            }
        }
        assert!(seen > 50, "{seen}");
    }
}

#[test]
fn depth_grows_toward_the_sun() {
    let view = view(Vec3::new(30.0, 10.0, 30.0), Vec3::ZERO);
    for sun in suns() {
        let map = fit(sun, &scene(), &scene(), &view, 512).shadow_from_world;
        let p = Vec3::new(1.0, 2.0, 1.0);
        let (low, high) = (map.transform_point3(p), map.transform_point3(p + sun));
        assert!(high.z > low.z);
        assert!((high - low).truncate().length() < 1e-4);
    }
}

#[test]
fn the_centre_moves_in_whole_texels() {
    let sun = suns()[1];
    let at = |x: f32| {
        let view = view(Vec3::new(6.0 + x, 3.0, 5.0), Vec3::new(-4.0 + x, 1.0, -6.0));
        fit(sun, &scene(), &scene(), &view, 1024)
    };
    let (a, b) = (at(0.0), at(0.013));
    if a.texel == b.texel {
        let p = Vec3::new(1.0, 0.5, -2.0);
        let texels = |v: &ShadowView| v.shadow_from_world.transform_point3(p).truncate() * 512.0;
        let moved = texels(&a) - texels(&b);
        assert!((moved - moved.round()).length() < 0.02, "{moved}");
    }
}

#[test]
fn a_slow_walk_seldom_needs_a_new_map() {
    for (eye, target) in [
        (Vec3::new(6.0, 3.0, 5.0), Vec3::new(-4.0, 1.0, -6.0)),
        (Vec3::new(1.0, 0.5, 1.0), Vec3::new(0.0, 0.0, 0.5)),
    ] {
        let maps: Vec<ShadowView> = (0..200)
            .map(|i| {
                let along = Vec3::X * (i as f32 * 0.002);
                fit(
                    suns()[1],
                    &scene(),
                    &scene(),
                    &view(eye + along, target + along),
                    1024,
                )
            })
            .collect();
        let changes = maps.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes < 10, "{changes} maps on 0.4 m");
    }
}

#[test]
fn a_close_view_gets_finer_texels() {
    let far = fit(
        suns()[1],
        &scene(),
        &scene(),
        &view(Vec3::splat(40.0), Vec3::ZERO),
        1024,
    );
    let near = fit(
        suns()[1],
        &scene(),
        &scene(),
        &view(Vec3::new(1.0, 0.5, 1.0), Vec3::new(0.0, 0.0, 0.5)),
        1024,
    );
    assert!(near.texel < far.texel, "{} {}", near.texel, far.texel);
}
