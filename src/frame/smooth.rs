//! Anti-aliasing of the displayed picture: which passes smooth it, and the pictures that they keep from frame to frame.
//!
//! Only display values are smoothed. The picture in cd/m² keeps the values of the single samples, and quantities and false colours are
//! shown as they are.

use std::sync::Arc;

use glam::Vec2;

use super::FrameSettings;
use super::sample::Sample;
use crate::daylight::colour::luminance;
use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Image, ImageDesc, Recorder, Result};
use crate::passes::picture::fade;
use crate::passes::picture::hand_over::HandOver;
use crate::passes::picture::morphological::Morphological;
use crate::passes::picture::temporal::{Inputs, Temporal};
use crate::passes::picture::tone_map::ToneMap;
use crate::passes::surfaces::gbuffer::Gbuffer;
use crate::passes::view::{Reprojection, View};

/// How the edges of a moving view, or of a single frame, are smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AntiAliasing {
    /// Not at all: one sample a pixel.
    #[default]
    Off,
    /// By the shapes of its edges.
    Smaa,
    /// By the samples of the frames before, moved along with the camera.
    Taa,
}

/// Largest turn of the sun (or moon), radians, and change of an illuminance in which the picture before counts at all.
const MOST_TURN: f64 = 0.035;
const MOST_CHANGE: f64 = 1.25;

/// Largest turn of the camera from one frame to the next, of its field of view; and change of the latter.
const MOST_SWING: f32 = 0.5;
const MOST_ZOOM: f32 = 1.25;

/// The light of a picture.
#[derive(Clone, Copy, PartialEq)]
struct LightOf {
    direction: glam::DVec3,
    /// Of sun or moon at normal incidence, of the sky, of the ground.
    levels: [f64; 3],
}

impl LightOf {
    fn of(daylight: &Daylight) -> Self {
        let direct = daylight.direct_light();
        Self {
            direction: direct.direction,
            levels: [
                direct.illuminance,
                daylight.sky_irradiance_up,
                daylight.ground_luminance,
            ]
            .map(luminance),
        }
    }

    /// Whether a picture in the other light may still tell something of this one.
    fn is_near(&self, other: &Self) -> bool {
        let near = |(a, b): (&f64, &f64)| a.max(*b) <= MOST_CHANGE * a.min(*b);
        self.direction.angle_between(other.direction) <= MOST_TURN
            && self.levels.iter().zip(&other.levels).all(near)
    }
}

/// The motion from the picture before, unless the view has jumped.
fn motion(now: &View, before: &View) -> Option<Reprojection> {
    let (a, b) = (&now.camera, &before.camera);
    let turn = a.forward().angle_between(b.forward());
    let zoom = a.fov_deg.max(b.fov_deg) / a.fov_deg.min(b.fov_deg);
    let is_continued =
        turn <= MOST_SWING * a.fov_deg.to_radians() && zoom <= MOST_ZOOM && now.size == before.size;
    is_continued.then(|| now.reprojection(before))
}

/// The pass that smooths a frame of a moving view.
enum Moving {
    Morphological(Box<Morphological>),
    Temporal(Box<Temporal>),
}

/// The passes and the pictures that they keep.
struct Passes {
    moving: Moving,
    hand_over: HandOver,
    pictures: [Image; 2],
}

/// What the picture before was of.
#[derive(Clone, Copy)]
struct Before {
    view: View,
    light: LightOf,
    /// Which of the kept pictures it is; `None`: the tone-mapped one.
    kept: Option<usize>,
}

/// Anti-aliasing.
pub(super) struct Smooth {
    passes: Option<Passes>,
    /// The picture before, if it may be continued.
    before: Option<Before>,
    /// Which of the kept pictures fades away at rest.
    held: Option<usize>,
    /// Which of the kept pictures is shown; `None`: the tone-mapped one.
    shown: Option<usize>,
    /// Number of frames of moving views so far.
    number: u32,
}

/// What is smoothed.
pub(super) struct Drawn<'a> {
    /// Display values of this frame.
    pub display: &'a Image,
    pub gbuffer: &'a Gbuffer,
    pub view: &'a View,
    pub daylight: &'a Daylight,
}

impl Smooth {
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, settings: &FrameSettings) -> Result<Self> {
        let is_linear = settings.tone.peak.is_some();
        let format = ToneMap::format(&settings.tone);
        let size = settings.size.to_array();
        let picture = |name| {
            let desc = ImageDesc::flat(name, format, size);
            Image::new(context, &desc.target_by(context.route()))
        };
        let moving = || {
            Ok(match settings.anti_aliasing() {
                AntiAliasing::Off => None,
                AntiAliasing::Smaa => {
                    let pass = Morphological::new(context, size, format, is_linear)?;
                    Some(Moving::Morphological(Box::new(pass)))
                }
                AntiAliasing::Taa => {
                    let pass = Temporal::new(context, format, is_linear)?;
                    Some(Moving::Temporal(Box::new(pass)))
                }
            })
        };
        let with = |moving| {
            Ok(Passes {
                moving,
                hand_over: HandOver::new(context, format, is_linear)?,
                pictures: [picture("smooth picture 0")?, picture("smooth picture 1")?],
            })
        };
        Ok(Self {
            passes: moving()?.map(with).transpose()?,
            before: None,
            held: None,
            shown: None,
            number: 0,
        })
    }

    /// The sample of the next frame: of frames outside of any average, each takes another point of the pixels.
    pub fn sample(
        &self,
        settings: &FrameSettings,
        daylight: &Daylight,
        index: Option<u32>,
    ) -> Sample {
        if index.is_none() && settings.anti_aliasing() == AntiAliasing::Taa {
            return Sample::moving(daylight, self.number);
        }
        Sample::of(settings, daylight, index)
    }

    /// Keeps the tone-mapped picture, if the next frame, outside of any average, continues it.
    pub fn keep(&mut self, rec: &mut Recorder, display: &Image) {
        let (Some(passes), Some(before)) = (&self.passes, &mut self.before) else {
            return;
        };
        if before.kept.is_none() && matches!(passes.moving, Moving::Temporal(_)) {
            let [kept, other] = &passes.pictures;
            passes.hand_over.record(rec, (display, other, kept), 0.0, 0);
            before.kept = Some(0);
        }
    }

    /// Starts anew with the next frame.
    pub fn forget(&mut self) {
        (self.before, self.held, self.shown) = (None, None, None);
    }

    /// Shows the tone-mapped picture until the next frame.
    pub fn show_plain(&mut self) {
        self.shown = None;
    }

    /// Smooths a frame: number `index` of an average of `frames`, or outside of any.
    pub fn record(&mut self, rec: &mut Recorder, drawn: &Drawn<'_>, average: Option<(u32, u32)>) {
        self.shown = None;
        let light = LightOf::of(drawn.daylight);
        if self.passes.is_some() {
            self.shown = match average {
                Some((index, frames)) => self.rest(rec, drawn.display, index, frames),
                None => self.moved(rec, drawn, &light),
            };
            self.before = Some(Before {
                view: *drawn.view,
                light,
                kept: self.shown,
            });
        }
        self.number = self.number.wrapping_add(1);
    }

    /// Continues the picture before.
    fn moved(&mut self, rec: &mut Recorder, drawn: &Drawn<'_>, light: &LightOf) -> Option<usize> {
        let passes = self.passes.as_ref()?;
        let temporal = match &passes.moving {
            Moving::Temporal(temporal) => temporal,
            Moving::Morphological(pass) => {
                pass.record(rec, drawn.display, &passes.pictures[0]);
                return Some(0);
            }
        };
        let before = self.before.filter(|before| before.light.is_near(light));
        let motion = before.and_then(|before| motion(drawn.view, &before.view));
        let old = before.and_then(|before| before.kept).unwrap_or(0);
        let depth = &drawn.gbuffer.surfaces().depth;
        let inputs = Inputs {
            display: drawn.display,
            depths: [depth, drawn.gbuffer.depth_before().unwrap_or(depth)],
            before: &passes.pictures[old],
            motion,
            jitter: before.map_or(Vec2::ZERO, |before| before.view.jitter),
            is_lit_alike: before.is_some_and(|before| before.light == *light),
            number: self.number,
        };
        temporal.record(rec, &inputs, &passes.pictures[1 - old]);
        Some(1 - old)
    }

    /// Fades from the moving view's picture to that of the average.
    fn rest(
        &mut self,
        rec: &mut Recorder,
        display: &Image,
        index: u32,
        frames: u32,
    ) -> Option<usize> {
        let passes = self.passes.as_ref()?;
        if index == 0 {
            self.held = self.before.and_then(|before| before.kept);
        }
        let (held, share) = (self.held?, fade::share(index, frames));
        if share == 0.0 {
            return None;
        }
        let pictures = (display, &passes.pictures[held], &passes.pictures[1 - held]);
        passes.hand_over.record(rec, pictures, share, self.number);
        Some(1 - held)
    }

    /// The smoothed picture, if one is shown.
    pub fn image(&self) -> Option<&Image> {
        let passes = self.passes.as_ref()?;
        Some(&passes.pictures[self.shown?])
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, UVec2, Vec2, Vec3};

    use super::*;
    use crate::scene::Camera;

    fn view(target: Vec3, fov_deg: f32) -> View {
        View {
            camera: Camera {
                eye: Vec3::ZERO,
                target,
                fov_deg,
                near: 0.1,
            },
            size: UVec2::new(64, 36),
            jitter: Vec2::ZERO,
            sharpen: 0.0,
            window: None,
        }
    }

    #[test]
    fn a_view_that_jumps_is_not_continued() {
        let before = view(Vec3::NEG_Z, 50.0);
        let turned = |degrees: f32| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            view(Vec3::new(sin, 0.0, -cos), 50.0)
        };
        assert!(motion(&turned(20.0), &before).is_some());
        assert!(motion(&turned(30.0), &before).is_none());
        assert!(motion(&view(Vec3::NEG_Z, 60.0), &before).is_some());
        assert!(motion(&view(Vec3::NEG_Z, 80.0), &before).is_none());
        let mut grown = before;
        grown.size.x += 1;
        assert!(motion(&grown, &before).is_none());
    }

    #[test]
    fn a_light_that_jumps_is_not_continued() {
        let light = |degrees: f64, lux: f64| LightOf {
            direction: DVec3::new(degrees.to_radians().sin(), degrees.to_radians().cos(), 0.0),
            levels: [lux, 0.2 * lux, 0.0],
        };
        let noon = light(0.0, 1e5);
        assert!(noon.is_near(&noon) && noon.is_near(&light(1.0, 0.9e5)));
        assert!(!noon.is_near(&light(3.0, 1e5)) && !noon.is_near(&light(0.0, 0.5e5)));
    }
}
