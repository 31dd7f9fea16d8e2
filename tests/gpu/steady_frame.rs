//! CPU cost of a frame: recording allocates no memory in the steady state, and each material is one draw call.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

use crate::gpu::Device;
use glam::Vec3;
use skylight::daylight::sky::Daylight;
use skylight::frame::Frame;
use skylight::gpu::{Context, ContextOptions, Recorder, Route, Timing};
use skylight::scene::{Bounds, Camera, Material, Part, Scene};

/// The system's allocator, counting the allocations of the current thread.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call is forwarded unchanged to the system's allocator; the counter is a thread-local cell that does not
// allocate and has no destructor.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller upholds the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the memory came from `alloc` above.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A wall of `parts` separate squares, each with its own material.
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

/// A frame and its inputs.
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

    /// Moves the camera a little and draws a frame. Returns the number of allocations made while recording.
    fn step(&mut self) -> u64 {
        self.camera.eye.x += 1e-3;
        self.recorder.begin().expect("begun");
        let before = ALLOCATIONS.get();
        self.frame
            .preview(&mut self.recorder, &self.daylight, &self.camera);
        let allocations = ALLOCATIONS.get() - before;
        self.recorder.finish().expect("finished");
        allocations
    }

    /// Allocations per frame, from the third to the twentieth.
    fn steady_allocations(&mut self) -> Vec<u64> {
        let all: Vec<u64> = (0..20).map(|_| self.step()).collect();
        println!("allocations of each frame: {all:?}");
        assert!(ALLOCATIONS.get() > 0, "the allocator counts");
        all[2..].to_vec()
    }
}

#[test]
fn a_steady_frame_allocates_nothing() {
    let device = Device::new();
    let bundled = skylight::scene::bundled(&skylight::scene::LoadOptions::default());
    let scene = bundled.expect("the bundled scene").scene;
    let mut shown = Shown::new(&device.context, &scene);
    assert_eq!(shown.steady_allocations(), [0; 18]);
}

#[test]
fn each_of_a_thousand_materials_is_one_draw_and_allocates_nothing() {
    const MATERIALS: u32 = 1000;
    // Numbers of triangles need no materials.
    let device = Device::with(&ContextOptions {
        route: Some(Route::Fragment),
        ..ContextOptions::default()
    });
    let mut shown = Shown::new(&device.context, &wall(MATERIALS));
    assert_eq!(shown.steady_allocations(), [0; 18]);
    shown.recorder = Recorder::new(&device.context, Timing::Work).expect("a recorder");
    shown.step();
    let passes = shown.recorder.work().iter();
    let surfaces = passes.filter(|pass| pass.name.starts_with("G-buffer"));
    let draws: u64 = surfaces.map(|pass| pass.draws).sum();
    assert_eq!(draws, u64::from(MATERIALS));
}
