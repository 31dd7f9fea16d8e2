//! Draws a picture and reads its light: `cargo run --release --example picture`.

use glam::{UVec2, Vec3};
use skylight::daylight::sky::{Conditions, Daylight};
use skylight::frame::{Frame, FrameSettings};
use skylight::gpu::{Context, ContextOptions, Recorder, Timing, read_back};
use skylight::output::{Effort, Encoding, write_png};
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, LoadOptions, load};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = load("colonnade".as_ref(), &LoadOptions::default())?.scene;
    let camera = Camera::framing(&scene.bounds, 40.0, 16.0 / 9.0);
    let daylight = Daylight::new(&Conditions::default()); // sun in the south at 45°, clear air
    let size = UVec2::new(320, 180);

    let context = Context::new(&ContextOptions::default())?;
    let mut recorder = Recorder::new(&context, Timing::Off)?;
    recorder.begin()?;
    let settings = FrameSettings {
        size,
        ..FrameSettings::default()
    };
    let mut frame = Frame::new(&mut recorder, &scene, settings)?;
    frame.record(&mut recorder, &daylight, &camera, 0);
    recorder.finish()?;
    let picture = read_back(&mut recorder, frame.display())?;
    let how = (Encoding::Srgb, Effort::Small);
    write_png(
        "picture.png".as_ref(),
        size.to_array(),
        &picture.bytes,
        how,
        &Vec::new(),
    )?;

    frame.show(Show::Irradiance)?;
    recorder.begin()?;
    frame.record(&mut recorder, &daylight, &camera, 0);
    recorder.finish()?;
    let texels = read_back(&mut recorder, frame.radiance())?.rgba(); // klx
    let lux = |t: &[f32; 4]| 1e3 * Vec3::from_slice(t).dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let middle = (size.y / 2 * size.x + size.x / 2) as usize;
    println!(
        "picture.png; the surface in its middle has {:.0} lux",
        lux(&texels[middle])
    );
    Ok(())
}
