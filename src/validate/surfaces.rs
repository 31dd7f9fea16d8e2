//! Light between surfaces and through glass, against closed forms.

use glam::{DVec3, Vec3};

use super::check::Check;
use super::device::{Device, Picture, camera, from_cells, settings};
use super::model::{Model, clear_day, closed_box, constant_sky, glass, glowing, matt};
use crate::daylight::colour::luminance;
use crate::daylight::glass::{internal_transmittance, pane};
use crate::frame::{Frame, FrameSettings};
use crate::gpu::Result;
use crate::passes::bounces::cells::Bounces;
use crate::passes::light::lighting::Show;
use crate::scene::{Camera, Material, Scene};

/// Transmittance at normal incidence of the panes: the luminance is 0.5.
pub const TINT: [f32; 3] = [0.4, 0.52, 0.596];

/// Mean luminance of a picture.
pub fn mean(picture: &Picture) -> f64 {
    picture.pixels().map(|(_, l)| luminance(l)).sum::<f64>() / picture.texels.len() as f64
}

/// A picture after `previews` frames that each add paths to the cells, under a black sky.
///
/// # Errors
/// The device fails.
pub fn previewed(
    device: &mut Device,
    scene: &Scene,
    settings: FrameSettings,
    view: &Camera,
    previews: u32,
) -> Result<Picture> {
    let day = constant_sky(0.0);
    let mut frame = device.run(|rec| Frame::new(rec, scene, settings))??;
    for _ in 0..previews {
        device.run(|rec| frame.preview(rec, &day, view))?;
    }
    device.picture_of(&frame)
}

/// A view within [`closed_box`] of half an edge of 2 m.
pub fn within_the_box() -> Camera {
    Camera {
        fov_deg: 80.0,
        ..camera([1.2, 0.3, 1.5], [-1.0, -0.4, -1.0])
    }
}

/// A closed box whose walls emit L and reflect ρ of what they get is L (1 − ρ^(N+1))/(1 − ρ) bright everywhere after N bounces.
///
/// # Errors
/// The device fails.
pub fn cells(device: &mut Device) -> Result<Vec<Check>> {
    let mut check = Check::relative("cells, a box that glows", "Σ ρⁿ", "kcd/m²", 0.02);
    for (reflectance, bounces, most) in [(0.5, Bounces::All, 64), (0.5, Bounces::UpTo(2), 2)] {
        let scene = closed_box(2.0, &glowing(reflectance, 1000.0));
        let mut settings = from_cells(12, 8);
        settings.bounces = bounces;
        let expected: f64 = (0..=most).map(|n| f64::from(reflectance).powi(n)).sum();
        let picture = previewed(device, &scene, settings, &within_the_box(), 24)?;
        for (pixel, value) in picture.pixels() {
            let at = || format!("ρ {reflectance}, {bounces:?}, pixel {pixel:?}");
            check.see(luminance(value), expected, expected, at);
        }
    }
    Ok(vec![check])
}

/// A wide pane 2 m above a floor, if there is one.
pub fn roofed(material: Option<&Material>) -> Scene {
    let model = Model::default().ground(3.0, &matt(0.5));
    let model = match material {
        Some(material) => model.square([0.0, 2.0, 0.0], 400.0, material),
        None => model,
    };
    model.build()
}

/// Looks down at the floor from below the pane.
pub fn below() -> Camera {
    camera([0.0, 1.5, 0.01], [0.0, 0.0, 0.0])
}

/// The part of the light of the sun at `elevation`, degrees, that a pane of [`TINT`] lets through, and what it is by Fresnel's formulas.
///
/// # Errors
/// The device fails.
pub fn sun_through(
    device: &mut Device,
    settings: FrameSettings,
    elevation: f64,
) -> Result<[DVec3; 2]> {
    let day = clear_day(160.0, elevation);
    let settings = settings.showing(Show::Sun);
    let mut lit = |scene: &Scene| -> Result<DVec3> {
        let picture = device.picture(scene, settings, &day, &below())?;
        Ok(picture.pixels().map(|(_, v)| v).sum())
    };
    let ratio = lit(&roofed(Some(&glass(TINT))))? / lit(&roofed(None))?;
    let expected = TINT.map(|t| {
        let internal = internal_transmittance(t.into());
        pane(internal, elevation.to_radians().sin())[0]
    });
    Ok([ratio, DVec3::from(expected)])
}

/// What a view through a pane shows of a uniform sky of 1 kcd/m² at `degrees` from the normal, and what the pane mirrors of it before a
/// black floor; each with its value by Fresnel's formulas.
///
/// # Errors
/// The device fails.
pub fn seen_through(
    device: &mut Device,
    settings: FrameSettings,
    degrees: f64,
) -> Result<[[DVec3; 2]; 2]> {
    let day = constant_sky(1000.0);
    let scene = Model::default()
        .ground(4000.0, &matt(0.0))
        .square([0.0, 2.0, 0.0], 400.0, &glass(TINT))
        .build();
    let (sin, cos) = degrees.to_radians().sin_cos();
    let eye = Vec3::new(0.0, 1.0, 0.0);
    let target = eye + Vec3::new(sin as f32, cos as f32, 1e-3);
    // From above, the pane mirrors the sky before what is seen through it: the black floor.
    let up = (eye.to_array(), target.to_array());
    let down = ([0.0, 3.0, 0.0], [sin as f32, 3.0 - cos as f32, 1e-3]);
    let internal = TINT.map(|t| internal_transmittance(t.into()));
    let mut seen = |(eye, target): ([f32; 3], [f32; 3]), part: usize| -> Result<[DVec3; 2]> {
        let view = Camera {
            fov_deg: 1.0,
            ..camera(eye, target)
        };
        let picture = device.picture(&scene, settings, &day, &view)?;
        let expected = internal.map(|internal| pane(internal, cos)[part]);
        let centre = picture.size.map(|edge| edge / 2);
        Ok([picture.at(centre[0], centre[1]), DVec3::from(expected)])
    };
    Ok([seen(up, 0)?, seen(down, 1)?])
}

/// Panes of glass in single frames.
///
/// # Errors
/// The device fails.
pub fn panes(device: &mut Device) -> Result<Vec<Check>> {
    let mut sun = Check::relative("glass, the sun through it", "Fresnel, Beer", "", 3e-3);
    for elevation in [70.0, 15.0] {
        let [found, expected] = sun_through(device, settings(24, 16), elevation)?;
        let at = || format!("sun at {elevation}°");
        sun.see_colour(found, expected, expected.min_element(), at);
    }
    let mut view = Check::relative("glass, the view and its mirror", "Fresnel, Beer", "", 5e-3);
    for degrees in [0.0, 50.0] {
        let both = seen_through(device, settings(24, 16), degrees)?;
        for (what, [found, expected]) in ["through", "mirrored"].into_iter().zip(both) {
            let at = || format!("{what}, {degrees}° from the normal");
            view.see_colour(found, expected, expected.min_element(), at);
        }
    }
    Ok(vec![sun, view])
}
