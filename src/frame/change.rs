//! A change of a frame's settings: the passes that depend on them are made, by any thread, and then swapped in all together.

use std::mem::swap;
use std::sync::Arc;

use super::ambient::{AmbientNeed, AmbientPasses};
use super::average::Average;
use super::smooth::Smooth;
use super::{Frame, FrameSettings};
use crate::gpu::{Context, Recorder, Result};
use crate::passes::bounces::cells::Cells;
use crate::passes::bounces::tree::TreeFacts;
use crate::passes::light::background::Background;
use crate::passes::light::lighting::{Lighting, Show};
use crate::passes::light::lobes::Lobes;
use crate::passes::light::panes::Panes;
use crate::passes::picture::tone_map::ToneMap;
use crate::passes::sky::air::Air;
use crate::passes::sky::cube::SkyCube;
use crate::passes::sky::irradiance::Irradiance;
use crate::passes::sun_shadow::map::Shadow;
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::gbuffer::Gbuffer;

/// A change of settings that another thread can prepare while the frame is drawn.
#[derive(Clone)]
pub struct Change {
    context: Arc<Context>,
    facts: Arc<Facts>,
    tree: TreeFacts,
    old: FrameSettings,
    new: FrameSettings,
}

/// The passes of a change that differ, ready to take the place of a frame's; after [`Frame::swap`] those that were replaced. `None`: the
/// frame keeps its own, with its contents.
pub struct Replacement {
    settings: FrameSettings,
    sky_cube: Option<SkyCube>,
    irradiance: Option<Irradiance>,
    air: Option<Option<Air>>,
    gbuffer: Option<Gbuffer>,
    panes: Option<Option<Panes>>,
    lobes: Option<Option<Lobes>>,
    ambient: Option<AmbientPasses>,
    shadow: Option<Shadow>,
    lighting: Option<Lighting>,
    background: Option<Background>,
    average: Option<Average>,
    cells: Option<Option<Cells>>,
    tone_map: Option<ToneMap>,
    smooth: Option<Smooth>,
}

impl Change {
    /// Whether the frame has these settings already.
    pub fn is_none(&self) -> bool {
        self.new == self.old
    }

    /// Makes the passes. `recorder` must be recording; what it records must be done before they are drawn with.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources. The recorded commands must then not be submitted.
    pub fn make(&self, recorder: &mut Recorder) -> Result<Replacement> {
        let wanted = self.new.irradiance;
        let differs = wanted != self.old.irradiance;
        let irradiance = remade(differs, || Irradiance::new(recorder, wanted))?;
        self.passes(irradiance)
    }

    /// Makes the passes with a recorder that is not recording, and waits for what it uploads.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources, or is lost.
    pub fn prepare(&self, recorder: &mut Recorder) -> Result<Replacement> {
        if self.new.irradiance == self.old.irradiance {
            return self.passes(None);
        }
        recorder.begin()?;
        let made = self.make(recorder);
        match made {
            Ok(_) => recorder.finish()?,
            Err(_) => recorder.abandon()?,
        }
        made
    }

    fn passes(&self, irradiance: Option<Irradiance>) -> Result<Replacement> {
        let (old, new, device, facts) = (&self.old, &self.new, &self.context, &*self.facts);
        let is_resized = new.size != old.size;
        let is_lit = is_resized || new.lighting != old.lighting;
        let is_new_gbuffer = is_resized
            || (new.has_faces(), new.keeps_depth()) != (old.has_faces(), old.keeps_depth());
        let is_other_mirror = is_resized || new.lighting.panes != old.lighting.panes;
        let is_other_lobes = is_resized || new.lobes_need() != old.lobes_need();
        let is_new_ambient = is_resized || AmbientNeed::of(new) != AmbientNeed::of(old);
        Ok(Replacement {
            settings: *new,
            sky_cube: remade(new.sky_edge != old.sky_edge, || {
                SkyCube::new(device, new.sky_edge)
            })?,
            irradiance,
            air: remade(new.air_need() != old.air_need(), || new.air(device, facts))?,
            gbuffer: remade(is_new_gbuffer, || new.gbuffer(device, facts))?,
            panes: remade(is_other_mirror, || new.panes(device, &self.tree))?,
            lobes: remade(is_other_lobes, || new.lobes(device, &self.tree))?,
            ambient: remade(is_new_ambient, || AmbientPasses::new(device, new))?,
            shadow: remade(new.shadow_map() != old.shadow_map(), || {
                new.shadow(device, facts)
            })?,
            lighting: remade(is_lit, || new.lighting(device, self.tree.constants()))?,
            background: remade(new.lighting != old.lighting, || new.background(device))?,
            average: remade(Average::is_changed(old, new), || {
                Average::new(device, facts, &self.tree, new)
            })?,
            cells: remade(new.cells_need() != old.cells_need(), || {
                new.cells(device, &self.tree, facts)
            })?,
            tone_map: remade(is_resized || new.tone != old.tone, || new.tone_map(device))?,
            smooth: remade(new.smooth_need() != old.smooth_need(), || {
                Smooth::new(device, new)
            })?,
        })
    }
}

impl Frame {
    /// The change to these settings, which any thread may prepare.
    pub fn change(&self, settings: FrameSettings) -> Change {
        Change {
            context: self.context.clone(),
            facts: self.geometry.facts().clone(),
            tree: *self.tree.facts(),
            old: self.settings,
            new: settings.for_scene(&self.context, self.geometry.facts()),
        }
    }

    /// Puts the passes of a change of this frame's present settings in, and those whose place they take out. Frames in flight may still use
    /// these.
    pub fn swap(&mut self, with: &mut Replacement) {
        exchange(&mut self.sky_cube, &mut with.sky_cube);
        exchange(&mut self.irradiance, &mut with.irradiance);
        exchange(&mut self.air, &mut with.air);
        exchange(&mut self.gbuffer, &mut with.gbuffer);
        exchange(&mut self.panes, &mut with.panes);
        exchange(&mut self.lobes, &mut with.lobes);
        exchange(&mut self.ambient, &mut with.ambient);
        exchange(&mut self.preview.shadow, &mut with.shadow);
        exchange(&mut self.preview.lighting, &mut with.lighting);
        exchange(&mut self.background, &mut with.background);
        exchange(&mut self.average, &mut with.average);
        exchange(&mut self.cells, &mut with.cells);
        exchange(&mut self.tone_map, &mut with.tone_map);
        exchange(&mut self.smooth, &mut with.smooth);
        swap(&mut self.settings, &mut with.settings);
        self.smooth.forget();
        self.drawn = None;
    }

    /// Applies new settings: recreates the passes that depend on a changed setting and keeps the others with their contents.
    /// `recorder` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources. The frame is then unchanged, and the recorded commands must not be
    /// submitted.
    pub fn apply(&mut self, recorder: &mut Recorder, settings: FrameSettings) -> Result<()> {
        let mut made = self.change(settings).make(recorder)?;
        self.swap(&mut made);
        Ok(())
    }

    /// Sets the quantity shown from the next frame on. No frame may be in flight.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources. The frame is then unchanged.
    pub fn show(&mut self, show: Show) -> Result<()> {
        let mut made = self.change(self.settings.showing(show)).passes(None)?;
        self.swap(&mut made);
        Ok(())
    }
}

/// Makes a pass if its settings differ.
fn remade<T>(differs: bool, make: impl FnOnce() -> Result<T>) -> Result<Option<T>> {
    differs.then(make).transpose()
}

/// Exchanges a pass for the other one, if any.
fn exchange<T>(pass: &mut T, other: &mut Option<T>) {
    if let Some(other) = other {
        swap(pass, other);
    }
}
