//! Which route of full-screen passes ([`Route`]) is faster on a device: a tone map of one picture by both.

use std::sync::Arc;

use glam::UVec2;

use crate::gpu::{Context, Format, Image, ImageDesc, Recorder, Result, Route, RouteTimes};
use crate::passes::picture::tone_map::{ToneMap, ToneSettings};

/// Edge of the picture, pixels.
const EDGE: u32 = 1024;
/// Runs, of which the fastest counts: the clocks of cards rise with the work.
const RUNS: u32 = 8;

/// Settles the route of a device that has none yet, see [`Context::settle_route`]. No other thread may submit work meanwhile.
///
/// # Errors
/// Fails when the device cannot create the resources or is lost.
pub fn settle_route(context: &Arc<Context>) -> Result<()> {
    if !context.is_route_settled() {
        context.settle_route(measured(context)?);
    }
    Ok(())
}

/// Times of a picture's tone map by both routes.
///
/// # Errors
/// Fails when the device cannot create the resources or is lost.
pub fn measured(context: &Arc<Context>) -> Result<RouteTimes> {
    let mut recorder = Recorder::new(context, context.summary().timing())?;
    let format = Format::R16G16B16A16_SFLOAT;
    let picture = Image::new(context, &ImageDesc::flat("radiance", format, [EDGE; 2]))?;
    let average = Image::new(context, &ImageDesc::flat("average", format, [1; 2]))?;
    let mut time = |route| {
        let pass = ToneMap::by(route, context, [EDGE; 2], ToneSettings::default())?;
        recorder.begin()?;
        recorder.clear(&picture, [3.0, 2.0, 1.0, 1.0]);
        recorder.clear(&average, [2.0; 4]);
        for _ in 0..RUNS {
            pass.record(&mut recorder, &picture, &average, UVec2::ZERO);
        }
        recorder.finish()?;
        let runs = recorder.timings().passes().iter().map(|pass| pass.ms);
        Ok(runs.fold(f64::INFINITY, f64::min))
    };
    Ok(RouteTimes {
        fragment: time(Route::Fragment)?,
        compute: time(Route::Compute)?,
    })
}
