//! Enums as option values: name and help line of each variant.

use std::ffi::OsStr;
use std::fmt;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, Command};

use super::{
    Ambient, AntiAliasing, Blinds, ColourMap, DomeBy, Filter, IrradianceMethod, Optional, Phong,
    Quantity, Reflections, Show, SkyModel, SunPositionMethod, ToneCurve, Unit, Up, Visibility,
};

/// An enum whose variants are values of an option.
pub trait Choice: Copy + PartialEq + Send + Sync + 'static {
    /// Each selectable variant with its name and help line.
    const VALUES: &'static [(Self, &'static str, &'static str)];

    /// Name of the variant on the command line and in files.
    fn option_name(self) -> &'static str;
}

/// Name of a value on the command line and in files.
pub fn name(value: impl Choice) -> &'static str {
    value.option_name()
}

/// The value parser of an option of this type.
pub(crate) fn choice<T: Choice>() -> impl TypedValueParser<Value = T> {
    let values = T::VALUES.iter();
    let values = values.map(|(_, name, help)| PossibleValue::new(*name).help(*help));
    PossibleValuesParser::new(values).try_map(|text| {
        let mut values = T::VALUES.iter();
        let found = values.find(|(_, name, _)| *name == text);
        found.map(|(value, ..)| *value).ok_or(fmt::Error)
    })
}

/// Parser of `--visibility`: what hides the sky. A number is the visibility of the air; [`is_visual_range`] makes it another option.
#[derive(Clone)]
pub(crate) struct VisibilityParser;

impl TypedValueParser for VisibilityParser {
    type Value = Visibility;

    fn parse_ref(
        &self,
        command: &Command,
        arg: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Visibility, clap::Error> {
        if value.to_str().is_some_and(is_number) {
            return Ok(Visibility::default());
        }
        choice::<Visibility>().parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let values = Visibility::VALUES.iter();
        Some(Box::new(values.map(|(_, name, help)| {
            PossibleValue::new(*name).help(*help)
        })))
    }
}

/// Whether this option and text are the visibility of the air in km (`--visual-range`) under the name that it shares with what hides the sky.
pub(super) fn is_visual_range(name: &str, text: &str) -> bool {
    name == "visibility" && is_number(text)
}

fn is_number(text: &str) -> bool {
    text.trim().parse::<f64>().is_ok()
}

/// Implements [`Choice`] and [`Display`](fmt::Display): `Variant | SynonymThatCannotBeSelected = "name": "help"`.
macro_rules! choices {
    ($($type:ident {
        $($variant:ident $(| $synonym:ident)* = $name:literal: $help:literal,)*
    })*) => {
        $(
            impl crate::options::Choice for $type {
                const VALUES: &'static [(Self, &'static str, &'static str)] =
                    &[$((Self::$variant, $name, $help),)*];

                fn option_name(self) -> &'static str {
                    match self {
                        $(Self::$variant $(| Self::$synonym)* => $name,)*
                    }
                }
            }

            impl std::fmt::Display for $type {
                fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                    f.write_str(crate::options::name(*self))
                }
            }
        )*
    };
}
pub(crate) use choices;

/// Defines an enum that only the command line knows, with [`choices!`]: the help line of a variant is its documentation.
macro_rules! choice_enum {
    (
        $(#[$attribute:meta])*
        pub enum $type:ident {
            $($(#[$variant_attribute:meta])* $variant:ident = $name:literal: $help:literal,)*
        }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $type {
            $(#[doc = concat!($help, ".")] $(#[$variant_attribute])* $variant,)*
        }

        crate::options::choices! {
            $type { $($variant = $name: $help,)* }
        }
    };
}
pub(crate) use choice_enum;

choices! {
    Up {
        Y = "y": "+Y, with +X east and −Z north, as in glTF",
        Z = "z": "+Z, with +X east and +Y north, as in GIS, BIM and CAD",
    }
    Unit {
        Mm = "mm": "Millimetre",
        Cm = "cm": "Centimetre",
        M = "m": "Metre",
        In = "in": "Inch, 25.4 mm",
        Ft = "ft": "Foot, 304.8 mm",
    }
    Blinds {
        None = "none": "No blinds",
        Lm83 = "lm83": "IES LM-83: those of a room are closed in hours in which more than 2 % of its sensors have 1000 lux of direct sun, and leave 5 % of all light; for da, cda, udi, sda",
    }
    Ambient {
        Cells = "cells": "Cells of irradiance in the scene: the true visibility of the sky, and bounces",
        Ssao = "ssao": "Screen-space ambient occlusion of the open sky, no bounces: the lecture's A",
    }
    AntiAliasing {
        Off = "off": "None: one sample a pixel",
        Smaa = "smaa": "By the shapes of its edges, from one frame alone",
        Taa = "taa": "By the samples of the frames before, moved along with the camera",
    }
    Filter {
        Box = "box": "Uniform over the pixel",
        BlackmanHarris = "blackman-harris": "By a Blackman-Harris window 3 pixels wide: smooth, little ringing of fine patterns",
    }
    IrradianceMethod {
        MonteCarlo = "monte-carlo": "Random cosine-weighted directions, as in the lecture",
        Quasi = "quasi": "Low-discrepancy cosine-weighted directions",
        Exact = "exact": "Sum over the sky cube's texels",
        Sh = "sh": "Spherical harmonics of order 2",
    }
    Optional {
        PushDescriptor = "push-descriptor": "The extension VK_KHR_push_descriptor; descriptor pools otherwise",
        GeometryShader = "geometry-shader": "The feature geometryShader; compute shaders write the cubes of sky and irradiance otherwise",
        PipelineStatistics = "pipeline-statistics": "The feature pipelineStatisticsQuery; the benchmark has no such columns otherwise",
        FloatFilter = "float-filter": "Linear filter of 32-bit floats; shaders filter the sky otherwise",
        FloatBlend = "float-blend": "Blending of 32-bit floats; pictures of 32-bit floats have no stars otherwise",
        StoredPictures = "stored-pictures": "Storage images of the formats of pictures; fragment shaders run full-screen passes otherwise",
        Timestamps = "timestamps": "Timestamps of the queue; each pass is submitted alone and timed by the wall clock otherwise",
        HdrMetadata = "hdr-metadata": "Extension VK_EXT_hdr_metadata; an HDR screen assumes how bright pictures get otherwise",
    }
    Phong {
        ByFormat = "by-format": "GGX and a sky hidden by what stands before it for glTF, the lecture's for MTL",
        Lecture = "lecture": "(r·l)^p for the sun, a perfect mirror for the sky",
        Normalized = "normalized": "Energy-conserving, ρ_s (p + 2)/(2π) (r·l)^p cos θ, for sun and sky alike",
    }
    ColourMap {
        Turbo = "turbo": "Many hues: fine steps can be told apart",
        Viridis = "viridis": "From dark violet to yellow, evenly lighter; also in grey and for the colour-blind",
        Cividis = "cividis": "From dark blue to yellow; the same to people with and without red-green deficiency",
    }
    Quantity {
        Luminance = "luminance": "Of the light toward the eye, cd/m²",
        Illuminance = "illuminance": "Of the surface under the pixel, lux",
        SunHours = "sun-hours": "In which the sun shines on the surface under the pixel, of --sun-dates",
    }
    DomeBy {
        Auto = "auto": "What costs less, by the numbers of triangles and pixels",
        Maps = "maps": "A shadow map of the scene for each direction: for scenes of few triangles",
        Rays = "rays": "A ray from each pixel in each direction: for scenes of many triangles",
    }
    Reflections {
        Open = "open": "Nothing occludes the sky in reflections, as in the lecture's illumination model",
        Hidden = "hidden": "What occludes the sky elsewhere does so in reflections, as in the lecture's rendering equation",
    }
    Show {
        Beauty = "beauty": "The whole picture, cd/m²",
        Sun = "sun": "ρ_d/π (n·l) V E_sun, cd/m²",
        Sky = "sky": "ρ_d/π A E_sky(n), the light of the visible sky, cd/m²",
        Bounces = "bounces": "ρ_d/π E_bounces, the light of other surfaces, cd/m²",
        Emission = "emission": "L_e, the light that surfaces emit, cd/m²",
        SunSpecular = "sun-specular": "ρ_s (r·l)^p V E_sun, or the sun in the lobe of GGX, cd/m²",
        SkySpecular = "sky-specular": "ρ_s L_sky(r), sky and surfaces in lobes of GGX, and what panes of glass mirror, cd/m²",
        Air = "air": "L_air, the light that the air scatters between surfaces and the eye, cd/m²",
        Background = "background": "Sky, ground and the sun's disc where no surface is, cd/m²",
        Visibility = "visibility": "V, 0..1",
        Occlusion = "occlusion": "A, the fraction of the sky's light that is visible, 0..1",
        Irradiance = "irradiance": "(n·l) V E_sun + A E_sky(n) + E_bounces, lux",
        Albedo = "albedo": "ρ_d, 0..1",
        Normal = "normal": "World normal on the viewer's side, -1..1",
        Depth = "depth": "Distance along the view axis, metres; 0 is background",
        Luminance = "luminance": "Luminance of the whole picture, cd/m², as grey",
        SunHours = "sun-hours": "Hours of --sun-dates in which the sun shines on the surface, clouds apart, in false colours",
    }
    SkyModel {
        Atmosphere = "atmosphere": "Clear sky of all orders of scattering in air, aerosol and ozone on the sphere, from noon to night: --aod, --ozone, --altitude ..",
        Preetham = "preetham": "Clear sky of Preetham, Shirley & Smits 1999 (the lecture's)",
        Hosek = "hosek": "Clear sky of Hošek & Wilkie 2012",
        Overcast = "overcast": "CIE standard overcast sky; no sun (cie-16)",
        CieClear = "cie-clear": "CIE standard clear sky, white (cie-12)",
        Perez = "perez": "Sky of measured irradiances, Perez et al. 1993, white: --dni and --dhi",
        Cie1 = "cie-1": "CIE general sky (ISO 15469): overcast, steep gradation; this and the following white",
        Cie2 = "cie-2": "Overcast, steep gradation, slightly brighter toward the sun",
        Cie3 = "cie-3": "Overcast, moderate gradation",
        Cie4 = "cie-4": "Overcast, moderate gradation, slightly brighter toward the sun",
        Cie5 = "cie-5": "Uniform luminance",
        Cie6 = "cie-6": "Partly cloudy, slightly brighter toward the sun",
        Cie7 = "cie-7": "Partly cloudy, brighter around the sun",
        Cie8 = "cie-8": "Partly cloudy, distinct corona of the sun",
        Cie9 = "cie-9": "Partly cloudy with gradation, the sun obscured",
        Cie10 = "cie-10": "Partly cloudy with gradation, brighter around the sun",
        Cie11 = "cie-11": "White-blue, distinct corona of the sun",
        Cie12 = "cie-12": "Clear, little turbidity",
        Cie13 = "cie-13": "Clear, polluted air",
        Cie14 = "cie-14": "Cloudless and turbid, broad corona of the sun",
        Cie15 = "cie-15": "White-blue and turbid, broad corona of the sun",
        Cie16 = "cie-16": "Traditional overcast; no sun",
    }
    SunPositionMethod {
        Spa = "spa": "NREL's Solar Position Algorithm (Reda & Andreas 2004): 0.0003°",
        Lecture = "lecture": "The lecture's formulas (Preetham et al. 1999, A.6), azimuth corrected: 0.3° typical, 1.2° worst",
    }
    ToneCurve {
        Linear = "linear": "Clamp to 0..=1 (the lecture's, scale 1)",
        Exponential = "exponential": "Ferschin's exponential per channel (the lecture's other curve)",
        ExponentialLuminance = "exponential-luminance": "The same on luminance, which keeps the colour",
        Reinhard = "reinhard": "Reinhard et al. 2002, global operator with white at 4, on luminance",
        Agx = "agx": "AgX, base look",
        Neutral = "neutral": "Khronos PBR Neutral: colours up to 0.8 are unchanged",
        Aces = "aces": "ACES RRT + ODT, Hill's fit",
    }
    Visibility {
        Ssao = "ssao": "Single frames: at once; if given, --ambient is ssao too",
        Dome | Progressive = "dome": "Shadow maps or rays in directions of the sky: converges to the truth over the samples",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_unique_and_read_as_its_value() {
        fn check<T: Choice + std::fmt::Debug>() {
            for (value, text, help) in T::VALUES {
                assert_eq!(name(*value), *text);
                assert!(!help.is_empty(), "{text}");
                let same = T::VALUES.iter().filter(|(_, other, _)| other == text);
                assert_eq!(same.count(), 1, "{text}");
            }
        }
        check::<Show>();
        check::<ToneCurve>();
        check::<IrradianceMethod>();
        assert_eq!(name(Visibility::Progressive), "dome");
        assert_eq!(Show::VALUES.len(), 17);
    }
}
