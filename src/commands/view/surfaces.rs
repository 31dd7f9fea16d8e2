//! Reflectances and transmittances of the materials, changed in the window. Another thread makes the scene with them and uploads it, and the
//! window goes on with the one before.

use std::sync::Arc;

use super::background::{Background, Wake};
use crate::daylight::colour::luminance;
use crate::error::Result;
use crate::frame::{Frame, FrameSettings};
use crate::gpu::{Context, Recorder, Timing};
use crate::scene::{Material, Scene};

/// Largest reflectance or transmittance that is set.
pub(super) const MOST: f32 = 0.95;

/// What a scene is drawn with.
type Made = Result<(Arc<Scene>, Frame)>;

/// Changes of the materials of a scene.
pub(super) struct Surfaces {
    context: Arc<Context>,
    wake: Wake,
    /// The materials of the model.
    own: Vec<Material>,
    /// Value of each material that is wanted, if it is changed.
    wanted: Vec<Option<f32>>,
    /// Those of the scene that is drawn.
    drawn: Vec<Option<f32>>,
    making: Option<(Vec<Option<f32>>, Background<Made>)>,
}

impl Surfaces {
    /// Of a scene that is drawn as it is.
    pub(super) fn new(context: &Arc<Context>, wake: &Wake, scene: &Scene) -> Self {
        let none = vec![None; scene.materials.len()];
        Self {
            context: context.clone(),
            wake: wake.clone(),
            own: scene.materials.clone(),
            drawn: none.clone(),
            wanted: none,
            making: None,
        }
    }

    /// Each material: its name, whether it is glass, and its reflectance or transmittance, 0..1.
    pub(super) fn list(&self) -> impl Iterator<Item = (&str, bool, f32)> {
        let pairs = self.own.iter().zip(&self.wanted);
        pairs.map(|(own, wanted)| {
            let value = wanted.unwrap_or_else(|| value(own));
            (own.name.as_str(), own.glass.is_some(), value)
        })
    }

    /// Sets the value of a material; `None`: that of the model.
    pub(super) fn set(&mut self, material: usize, value: Option<f32>) {
        if let Some(wanted) = self.wanted.get_mut(material) {
            *wanted = value.map(|value| value.clamp(0.0, MOST));
        }
    }

    /// Gives all materials their own values back.
    pub(super) fn reset(&mut self) {
        self.wanted.fill(None);
    }

    /// What is changed: names and values.
    pub(super) fn changes(&self) -> impl Iterator<Item = (&str, f32)> {
        let pairs = self.own.iter().zip(&self.drawn);
        pairs.filter_map(|(own, drawn)| Some((own.name.as_str(), (*drawn)?)))
    }

    /// Whether the scene that is drawn lacks a change.
    pub(super) fn is_behind(&self) -> bool {
        self.wanted != self.drawn
    }

    /// The scene with the changes, once, when it is ready; starts making it if that is needed.
    ///
    /// # Errors
    /// Not enough device memory, or a lost device; the changes are then taken back.
    pub(super) fn follow(
        &mut self,
        scene: &Arc<Scene>,
        settings: FrameSettings,
    ) -> Result<Option<(Arc<Scene>, Frame)>> {
        if let Some((values, mut work)) = self.making.take() {
            match work.result() {
                None => self.making = Some((values, work)),
                Some(Ok(made)) => {
                    self.drawn = values;
                    return Ok(Some(made));
                }
                Some(Err(error)) => {
                    self.wanted.clone_from(&self.drawn);
                    return Err(error);
                }
            }
        }
        if self.making.is_none() && self.is_behind() {
            let (values, own) = (self.wanted.clone(), self.own.clone());
            let (scene, context) = (scene.clone(), self.context.clone());
            let wanted = values.clone();
            let work = move || {
                let scene = Arc::new(changed(&scene, &own, &wanted));
                let mut recorder = Recorder::new(&context, Timing::Off)?;
                recorder.begin()?;
                let frame = Frame::new(&mut recorder, &scene, settings);
                match frame {
                    Ok(_) => recorder.finish()?,
                    Err(_) => recorder.abandon()?,
                }
                Ok((scene, frame?))
            };
            self.making = Some((values, Background::start(&self.wake, work)));
        }
        Ok(None)
    }
}

impl Drop for Surfaces {
    /// No thread uses the device any more.
    fn drop(&mut self) {
        if let Some((_, work)) = self.making.take() {
            drop(work.wait());
        }
    }
}

fn grey([r, g, b]: [f32; 3]) -> f32 {
    luminance(glam::Vec3::new(r, g, b).as_dvec3()) as f32
}

/// Reflectance of a material, without its map, or transmittance of glass.
fn value(material: &Material) -> f32 {
    let colour = material.glass.or(material.microfacet.map(|m| m.base));
    grey(colour.unwrap_or(material.diffuse))
}

/// A colour of this luminance; grey where it is black, and where a channel would be above 1.
fn with_luminance(colour: [f32; 3], value: f32) -> [f32; 3] {
    let factor = value / grey(colour).max(1e-6);
    let scaled = colour.map(|channel| channel * factor);
    let fits = scaled.iter().all(|channel| *channel <= 1.0);
    if fits && grey(colour) > 1e-6 {
        scaled
    } else {
        [value; 3]
    }
}

/// A scene whose materials have these values.
fn changed(scene: &Scene, own: &[Material], values: &[Option<f32>]) -> Scene {
    let mut scene = scene.clone();
    scene.materials = own.to_vec();
    for (material, value) in scene.materials.iter_mut().zip(values) {
        let Some(value) = *value else { continue };
        if let Some(glass) = &mut material.glass {
            *glass = with_luminance(*glass, value);
        } else if let Some(facets) = &mut material.microfacet {
            facets.base = with_luminance(facets.base, value);
        } else {
            material.diffuse = with_luminance(material.diffuse, value);
        }
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_keeps_its_hue_as_long_as_it_can() {
        let colour = with_luminance([0.4, 0.2, 0.1], 0.5);
        assert!((grey(colour) - 0.5).abs() < 1e-6);
        assert!((colour[0] / colour[1] - 2.0).abs() < 1e-5);
        assert_eq!(with_luminance([0.4, 0.2, 0.1], 0.9), [0.9; 3]);
        assert_eq!(with_luminance([0.0; 3], 0.3), [0.3; 3]);
    }

    #[test]
    fn materials_are_changed_and_come_back() {
        let glass = Material {
            glass: Some([0.8; 3]),
            ..Material::default()
        };
        let scene = Scene {
            materials: vec![Material::default(), glass],
            ..Scene::default()
        };
        let own = scene.materials.clone();
        let other = changed(&scene, &own, &[Some(0.2), Some(0.4)]);
        assert_eq!(other.materials[0].diffuse, [0.2; 3]);
        assert_eq!(other.materials[1].glass, Some([0.4; 3]));
        assert_eq!(changed(&other, &own, &[None, None]).materials, own);
    }
}
