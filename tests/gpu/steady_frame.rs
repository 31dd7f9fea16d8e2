//! What the CPU does for a frame: no memory is taken once the passes run, and a thousand draws are recorded in a moment.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use std::time::Instant;

use crate::gpu::Device;
use glam::Vec3;
use skylight::daylight::sky::Daylight;
use skylight::frame::Frame;
use skylight::gpu::{Context, ContextOptions, Recorder, Timing};
use skylight::scene::{Bounds, Camera, Material, Part, Scene};

/// The system's allocator, which counts what this thread asks of it.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call is passed on to the system's allocator as it is; counting touches a cell of this thread that needs no
// memory and has no destructor.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the memory came from `alloc` above.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A wall of `parts` separate squares, each of a material of its own.
fn wall(parts: u32) -> Scene {
    let mut scene = Scene::default();
    let columns = f64::from(parts).sqrt().ceil() as u32;
    for i in 0..parts {
        let corner = Vec3::new((i % columns) as f32, (i / columns) as f32, 0.0);
        let first = scene.positions.len() as u32;
        for (x, y) in [(0.0, 0.0), (0.9, 0.0), (0.9, 0.9), (0.0, 0.9)] {
            scene.positions.push((corner + Vec3::new(x, y, 0.0)).into());
            scene.normals.push([0.0, 0.0, 1.0]);
            scene.texcoords.push([0.0; 2]);
        }
        scene.parts.push(Part {
            first_index: scene.indices.len() as u32,
            index_count: 6,
            material: i,
            has_colours: false,
            bounds: Bounds::of([corner, corner + Vec3::new(0.9, 0.9, 0.0)]),
        });
        scene.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
        scene.materials.push(Material {
            diffuse: [0.2 + 0.6 * i as f32 / parts as f32; 3],
            ..Material::default()
        });
    }
    scene.bounds = Bounds::of(scene.positions.iter().copied().map(Vec3::from));
    scene
}

/// A frame and what it shows.
struct Shown {
    recorder: Recorder,
    frame: Frame,
    daylight: Daylight,
    camera: Camera,
}

impl Shown {
    fn new(context: &Arc<Context>, scene: &Scene) -> Self {
        let mut recorder = Recorder::new(context, Timing::Off).expect("a recorder");
        let mut settings = crate::gpu::settings(320, 180);
        settings.ssao.radius = 5.0;
        recorder.begin().expect("begun");
        let frame = Frame::new(&mut recorder, scene, settings).expect("a frame");
        recorder.finish().expect("finished");
        Self {
            recorder,
            frame,
            daylight: crate::gpu::clear_day(200.0, 40.0),
            camera: Camera::framing(&scene.bounds, 40.0, 16.0 / 9.0),
        }
    }

    /// Draws a frame with the camera a little farther on; what recording it asked for: blocks of memory, and milliseconds.
    fn step(&mut self) -> (u64, f64) {
        self.camera.eye.x += 1e-3;
        self.recorder.begin().expect("begun");
        let (before, start) = (ALLOCATIONS.get(), Instant::now());
        self.frame
            .preview(&mut self.recorder, &self.daylight, &self.camera);
        let (taken, ms) = (
            ALLOCATIONS.get() - before,
            start.elapsed().as_secs_f64() * 1e3,
        );
        self.recorder.finish().expect("finished");
        (taken, ms)
    }
}

#[test]
fn a_steady_frame_takes_no_memory() {
    let device = Device::new();
    let bundled = skylight::scene::bundled(&skylight::scene::LoadOptions::default());
    let mut shown = Shown::new(&device.context, &bundled.expect("the bundled scene").scene);
    let first = shown.step().0;
    let taken: Vec<u64> = (0..20).map(|_| shown.step().0).collect();
    println!("blocks taken: {first} by the first frame, then {taken:?}");
    assert_eq!(taken[2..], [0; 18], "frames 3 to 20");
    assert!(ALLOCATIONS.get() > 0, "the allocator counts");
}

#[test]
fn a_thousand_draws_are_recorded() {
    // The validation layer records too: the figure is without it, after a run with it.
    let wall = wall(1000);
    Shown::new(&Device::new().context, &wall).step();
    let context = Context::new(&ContextOptions {
        device: std::env::var("SKYLIGHT_TEST_DEVICE").ok(),
        ..ContextOptions::default()
    });
    let mut shown = Shown::new(&context.expect("a device"), &wall);
    let mut ms: Vec<f64> = (0..60).map(|_| shown.step().1).collect();
    ms.sort_by(f64::total_cmp);
    let kind = if cfg!(debug_assertions) {
        "debug"
    } else {
        "release"
    };
    println!(
        "1000 draws of 1000 materials: recorded in {:.3} ms (median, {kind} build)",
        ms[ms.len() / 2]
    );
}
