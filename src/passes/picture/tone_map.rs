//! Tone mapping from radiance to display values: exposure, tone curve, encoding.
//!
//! The shader encodes, by the sRGB curve or by a power law (the lecture's (s R)^(1/γ)): a device that encodes for a format may be off by 0.6 steps of 8 bits,
//! more than the dither leaves. Light is dithered by a step of 8 bits after the tone curve; false colours and other quantities are not.
//!
//! Alpha tells the temporal anti-aliasing whether the exposure is nearly that of the picture before.
//!
//! For an HDR screen the display values stay linear, and no curve bends them: up to the screen's peak they are the exposed picture
//! ([`crate::daylight::hdr`]).

use std::sync::Arc;

use glam::UVec2;

use crate::daylight::exposure::KEY;
use crate::daylight::false_colour::{ColourMap, Colours, Range};
use crate::daylight::tone_curve::{REINHARD_WHITE, ToneCurve};
use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Route, Sampler,
    shaders,
};
use crate::gpu_struct;

use crate::passes::light::lighting::Show;
use crate::passes::{Screen, screen_by};

gpu_struct! {
    /// Parameters of the tone map.
    pub struct Push: push of TONE_MAP_FRAG, TONE_MAP_COMP, TONE_MAP_COMP_HALF {
        exposure: f32,
        offset: f32,
        white: f32,
        inverse_gamma: f32,
        least: f32,
        peak: f32,
        origin: UVec2,
    }
}

/// Exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// Factor from cd/m² to display values.
    Fixed(f64),
    /// Automatic, from the picture's average luminance, see [`crate::daylight::exposure`].
    Average {
        /// Display value of the average.
        key: f64,
        /// The lowest average that is exposed for, cd/m²; darker pictures stay dark.
        least: f64,
    },
}

/// Settings of the tone map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToneSettings {
    /// Quantity shown; only luminance and illuminance are exposed.
    pub show: Show,
    /// Tone curve.
    pub curve: ToneCurve,
    /// Exposure.
    pub scale: Scale,
    /// Luminance that Reinhard's curve maps to white, in display values before the curve.
    pub white: f64,
    /// Gamma of a power-law encoding; `None`: sRGB.
    pub gamma: Option<f64>,
    /// Depth shown as mid-grey, metres.
    pub depth_scale: f64,
    /// False colours, with their range in cd/m² (lux for irradiance). They replace exposure and tone curve and are always
    /// sRGB-encoded.
    pub false_colour: Option<Colours>,
    /// What a value of 1 of [`Show::SunHours`] stands for, hours.
    pub hours: f64,
    /// Highest display value of an HDR screen: the display values are linear then, without tone curve, gamma and dither. `None`: encoded, 0..=1.
    pub peak: Option<f64>,
}

/// Of light, exposed by its average.
impl Default for ToneSettings {
    fn default() -> Self {
        Self {
            show: Show::Beauty,
            curve: ToneCurve::default(),
            scale: Scale::Average {
                key: KEY,
                least: 0.0,
            },
            white: REINHARD_WHITE,
            gamma: None,
            depth_scale: 1.0,
            false_colour: None,
            hours: 1.0,
            peak: None,
        }
    }
}

/// The tone mapping pass and its picture.
pub struct ToneMap {
    settings: ToneSettings,
    pipeline: Pipeline,
    display: Image,
}

/// Format of display values, encoded, and linear for an HDR screen.
const ENCODED: Format = Format::R8G8B8A8_UNORM;
const LINEAR: Format = Format::R16G16B16A16_SFLOAT;

/// Whether the display values of this image are linear ([`ToneSettings::peak`]).
pub fn is_linear(display: &Image) -> bool {
    display.format() == LINEAR
}

/// Whether a quantity is light, which is exposed and tone mapped.
pub fn is_light(show: Show) -> bool {
    show.file_unit() != 1.0
}

/// The number of a map in the shader.
fn colour_map(colours: Option<Colours>) -> u32 {
    match colours.map_or(ColourMap::default(), |colours| colours.map) {
        ColourMap::Turbo => 0,
        ColourMap::Viridis => 1,
        ColourMap::Cividis => 2,
    }
}

impl ToneSettings {
    /// Whether false colours are on a linear scale.
    fn is_even(&self) -> bool {
        self.false_colour.is_some_and(|c| c.range.is_linear())
    }

    /// Scale and offset to the position 0..1 in a range: of what the device has, or of its log2.
    fn on_scale(&self, range: Range) -> (f64, f64) {
        let unit = match self.show {
            Show::SunHours => self.hours,
            shown => f64::from(shown.file_unit()),
        };
        if range.is_linear() {
            return (unit / range.max, 0.0);
        }
        let (scale, offset) = range.log2_scale();
        (scale, offset + scale * unit.log2())
    }
}

impl ToneMap {
    /// Format of the display values.
    pub fn format(settings: &ToneSettings) -> Format {
        if settings.peak.is_some() {
            LINEAR
        } else {
            ENCODED
        }
    }

    /// Creates the pass for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, size: [u32; 2], settings: ToneSettings) -> Result<Self> {
        Self::by(context.route(), context, size, settings)
    }

    /// The same, by this route.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub(in crate::passes) fn by(
        route: Route,
        context: &Arc<Context>,
        size: [u32; 2],
        settings: ToneSettings,
    ) -> Result<Self> {
        let false_colour = settings.false_colour.is_some();
        let light = is_light(settings.show) && !false_colour;
        let hdr = settings.peak.is_some();
        let curve = |c: ToneCurve| u32::from(light && !hdr && settings.curve == c);
        let average = light && matches!(settings.scale, Scale::Average { .. });
        let gamma = settings.gamma.is_some() && !false_colour;
        let format = Self::format(&settings);
        let pipeline = screen_by(
            route,
            context,
            "tone map",
            Screen {
                fragment: &shaders::TONE_MAP_FRAG,
                compute: if hdr {
                    &shaders::TONE_MAP_COMP_HALF
                } else {
                    &shaders::TONE_MAP_COMP
                },
            },
            &[format],
            Depth::Off,
            &[
                ("EXPONENTIAL", curve(ToneCurve::Exponential)),
                (
                    "EXPONENTIAL_LUMINANCE",
                    curve(ToneCurve::ExponentialLuminance),
                ),
                ("REINHARD", curve(ToneCurve::Reinhard)),
                ("AGX", curve(ToneCurve::Agx)),
                ("NEUTRAL", curve(ToneCurve::Neutral)),
                ("ACES", curve(ToneCurve::Aces)),
                ("GAMMA", (gamma && !hdr).into()),
                ("SRGB", (!gamma && !hdr).into()),
                ("AUTO", average.into()),
                ("GREY", (settings.show == Show::Luminance).into()),
                ("FALSE_COLOUR", false_colour.into()),
                ("EVEN", settings.is_even().into()),
                ("COLOUR_MAP", colour_map(settings.false_colour)),
                ("DITHER", (light && !hdr).into()),
                ("HDR", (light && hdr).into()),
            ],
        )?;
        let desc = ImageDesc::flat("display", format, size);
        let display = Image::new(context, &desc.target_by(route))?;
        Ok(Self {
            settings,
            pipeline,
            display,
        })
    }

    /// Tone maps a picture, or a tile whose upper left corner in the picture is `origin`, pixels. `average_luminance` (one texel, kcd/m²) is read
    /// only for automatic exposure.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        radiance: &Image,
        average_luminance: &Image,
        origin: UVec2,
    ) -> &Image {
        recorder
            .pass("tone map", &self.pipeline)
            .sample("radiance", radiance, Sampler::Nearest)
            .sample("average_luminance", average_luminance, Sampler::Nearest)
            .push(&self.push(origin))
            .output("display", &self.display, Load::Discard)
            .fill();
        &self.display
    }

    fn push(&self, origin: UVec2) -> Push {
        let s = &self.settings;
        let (exposure, offset) = s
            .false_colour
            .map_or_else(|| self.exposure(), |colours| s.on_scale(colours.range));
        Push {
            exposure: exposure as f32,
            offset: offset as f32,
            white: s.white as f32,
            inverse_gamma: s.gamma.map_or(1.0, f64::recip) as f32,
            least: match s.scale {
                Scale::Average { least, .. } => (least * 1e-3) as f32,
                Scale::Fixed(_) => 0.0,
            },
            peak: s.peak.unwrap_or(1.0) as f32,
            origin,
        }
    }

    /// Scale (from kcd/m² to display values) and offset applied before the tone curve.
    fn exposure(&self) -> (f64, f64) {
        let s = &self.settings;
        match s.show {
            Show::Normal => (0.5, 0.5),
            Show::Depth => (0.5 / s.depth_scale, 0.0),
            Show::Visibility | Show::Occlusion | Show::Albedo | Show::SunHours => (1.0, 0.0),
            shown => {
                // Irradiance is shown as the radiance of a white diffuser.
                let paper = if shown == Show::Irradiance {
                    std::f64::consts::FRAC_1_PI
                } else {
                    1.0
                };
                match s.scale {
                    Scale::Fixed(per_candela) => (paper * per_candela * 1e3, 0.0),
                    Scale::Average { key, .. } => (key, 0.0),
                }
            }
        }
    }

    /// The picture in display values.
    pub fn image(&self) -> &Image {
        &self.display
    }
}
