//! The part of the G-buffer that needs more than plain surfaces do: holes, normal maps, colours at vertices.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::gpu::{Context, Draws, Format, Load, Pipeline, Recorder, Result, Sampler, shaders};

use crate::passes::surfaces::culling::Cull;
use crate::passes::surfaces::gbuffer::{Push, Surfaces, VERTEX, surface_pipeline};
use crate::passes::surfaces::geometry::{Bound, Geometry, Kind};
use crate::passes::view::View;

/// The pipelines of the kinds that a scene has.
pub struct Details {
    pipelines: BTreeMap<Kind, Pipeline>,
}

fn pipeline(
    context: &Arc<Context>,
    formats: &[Format],
    faces: bool,
    kind: Kind,
) -> Result<Pipeline> {
    let [position, normal, texcoord] = VERTEX;
    surface_pipeline(
        context,
        "G-buffer, details",
        [
            &shaders::GBUFFER_DETAILED_VERT,
            &shaders::GBUFFER_DETAILED_FRAG,
        ],
        &[
            position,
            normal,
            texcoord,
            Format::R16G16B16A16_UNORM,
            Format::R16G16B16A16_SNORM,
        ],
        formats,
        &[
            ("DIFFUSE_MAP", kind.diffuse_map.into()),
            ("SPECULAR_MAP", kind.specular_map.into()),
            ("NORMAL_MAP", kind.normal_map.into()),
            ("CUT_OUT", kind.cut_out.into()),
            ("FACES", faces.into()),
        ],
    )
}

impl Details {
    /// Pipelines for the detailed parts of `geometry` and colour targets of these formats; `faces` as of [`crate::passes::surfaces::gbuffer::Gbuffer`].
    ///
    /// # Errors
    /// When the device refuses.
    pub fn new(
        context: &Arc<Context>,
        geometry: &Geometry,
        formats: &[Format],
        faces: bool,
    ) -> Result<Self> {
        let kinds = geometry.kinds().filter(Kind::is_detailed);
        let pipelines = kinds.map(|kind| Ok((kind, pipeline(context, formats, faces, kind)?)));
        Ok(Self {
            pipelines: pipelines.collect::<Result<_>>()?,
        })
    }

    /// Draws over what is in the images already.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        geometry: &Geometry,
        surfaces: &Surfaces,
        view: &View,
        cull: &Cull,
    ) {
        let Some((first, pipeline)) = self.pipelines.first_key_value() else {
            return;
        };
        let (clip_from_world, eye) = (view.clip_from_world().to_cols_array_2d(), view.camera.eye);
        surfaces
            .colors(recorder.pass("G-buffer, details", pipeline), Load::Keep)
            .depth(&surfaces.depth, Load::Keep)
            .draws(|draws| {
                let mut current = *first;
                geometry.draw_detailed(draws, cull, |draws, bound| {
                    if bound.kind != current {
                        current = bound.kind;
                        draws.pipeline(&self.pipelines[&current]);
                    }
                    bind_maps(draws, bound);
                    draws.push(&Push::of(clip_from_world, eye, view.sharpen, bound));
                });
            });
    }
}

fn bind_maps(draws: &mut Draws<'_, '_>, bound: &Bound<'_>) {
    let maps = [
        ("diffuse_map", bound.diffuse_map),
        ("specular_map", bound.specular_map),
        ("normal_map", bound.normal_map),
    ];
    for (name, map) in maps {
        draws.texture(name, map.unwrap_or(bound.white), Sampler::Repeat);
    }
}
