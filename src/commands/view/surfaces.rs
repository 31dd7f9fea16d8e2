//! Reflectances of the materials and transmittances of the panes, changed in the window: sliders write the options `--reflectance` and
//! `--glass`. Another thread makes the scene with them and uploads it, and the window goes on with the one before.

use std::sync::Arc;

use super::background::{Background, Wake};
use crate::commands::job::set_materials;
use crate::daylight::colour::luminance;
use crate::error::Result;
use crate::frame::{Frame, FrameSettings};
use crate::gpu::{Context, Recorder, Timing};
use crate::options::{ByMaterial, Options};
use crate::scene::{Material, Scene};

/// The options that change materials.
#[derive(Debug, Clone, PartialEq)]
struct Asked {
    glass: Option<ByMaterial>,
    reflectance: Option<ByMaterial>,
}

impl Asked {
    fn of(options: &Options) -> Self {
        Self {
            glass: options.glass.clone(),
            reflectance: options.reflectance.clone(),
        }
    }
}

/// A material that can be changed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Surface {
    pub(super) name: String,
    /// Whether it is a pane of glass.
    pub(super) is_glass: bool,
    /// Diffuse reflectance without its texture, or transmittance at normal incidence, 0..=1.
    pub(super) value: f64,
}

impl Surface {
    /// With its value by these options.
    fn by(&self, options: &Options) -> Self {
        let asked = if self.is_glass {
            &options.glass
        } else {
            &options.reflectance
        };
        let entries = asked.iter().flat_map(|list| &list.0);
        let mut mine = entries.filter(|(name, _)| name.is_empty() || *name == self.name);
        Self {
            value: mine.next_back().map_or(self.value, |(_, value)| *value),
            ..self.clone()
        }
    }

    /// Writes its value into the options. A value of all panes becomes one of each of `panes`.
    fn write<'a>(&self, options: &mut Options, panes: impl Iterator<Item = &'a str>) {
        let asked = if self.is_glass {
            &mut options.glass
        } else {
            &mut options.reflectance
        };
        let mut entries = asked.take().map_or_else(Vec::new, |list| list.0);
        if let Some(all) = entries.iter().position(|(name, _)| name.is_empty()) {
            let (_, value) = entries.remove(all);
            entries.extend(panes.map(|pane| (pane.to_owned(), value)));
        }
        match entries.iter_mut().find(|(name, _)| *name == self.name) {
            Some(entry) => entry.1 = self.value,
            None => entries.push((self.name.clone(), self.value)),
        }
        *asked = Some(ByMaterial(entries));
    }
}

/// What a scene is drawn with.
type Made = Result<(Arc<Scene>, Frame)>;

/// The materials of a scene, and how they are changed.
pub(super) struct Surfaces {
    context: Arc<Context>,
    wake: Wake,
    /// The materials of the model.
    own: Vec<Material>,
    /// Those that can be changed, with their values in the model.
    list: Vec<Surface>,
    /// What the scene is drawn with.
    drawn: Asked,
    making: Option<(Asked, Background<Made>)>,
}

impl Surfaces {
    /// Of a scene that is drawn with these options; `own` are the materials of its model.
    pub(super) fn new(
        (context, wake): (&Arc<Context>, &Wake),
        scene: &Scene,
        own: Vec<Material>,
        options: &Options,
    ) -> Self {
        Self {
            context: context.clone(),
            wake: wake.clone(),
            list: changeable(scene, &own),
            own,
            drawn: Asked::of(options),
            making: None,
        }
    }

    /// The materials that can be changed, with their values by these options.
    pub(super) fn list(&self, options: &Options) -> Vec<Surface> {
        self.list.iter().map(|own| own.by(options)).collect()
    }

    /// Writes the value of a material into the options.
    pub(super) fn set(&self, options: &mut Options, surface: &Surface) {
        let panes = self.list.iter().filter(|own| own.is_glass);
        surface.write(options, panes.map(|own| own.name.as_str()));
    }

    /// Whether the scene that is drawn lacks a change.
    pub(super) fn is_behind(&self, options: &Options) -> bool {
        Asked::of(options) != self.drawn
    }

    /// Takes the changes that are not drawn yet out of the options.
    pub(super) fn take_back(&self, options: &mut Options) {
        options.glass.clone_from(&self.drawn.glass);
        options.reflectance.clone_from(&self.drawn.reflectance);
    }

    /// The scene with the changes, once, when it is ready; starts making it if that is needed.
    ///
    /// # Errors
    /// A tint that is too deep for a transmittance, not enough device memory, or a lost device.
    pub(super) fn follow(
        &mut self,
        scene: &Arc<Scene>,
        options: &Options,
        settings: FrameSettings,
    ) -> Result<Option<(Arc<Scene>, Frame)>> {
        if let Some((asked, mut work)) = self.making.take() {
            match work.result() {
                None => self.making = Some((asked, work)),
                Some(made) => {
                    let made = made?;
                    self.drawn = asked;
                    return Ok(Some(made));
                }
            }
        }
        if self.making.is_none() && self.is_behind(options) {
            let (own, options) = (self.own.clone(), options.clone());
            let (scene, context) = (scene.clone(), self.context.clone());
            let asked = Asked::of(&options);
            let work = move || {
                let mut scene = Scene::clone(&scene);
                scene.materials = own;
                set_materials(&mut scene, &options)?;
                let mut recorder = Recorder::new(&context, Timing::Off)?;
                recorder.begin()?;
                let frame = Frame::new(&mut recorder, &scene, settings);
                match frame {
                    Ok(_) => recorder.finish()?,
                    Err(_) => recorder.abandon()?,
                }
                Ok((Arc::new(scene), frame?))
            };
            self.making = Some((asked, Background::start(&self.wake, work)));
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

/// The materials of these that a reflectance or a transmittance can replace, each name once.
fn changeable(scene: &Scene, own: &[Material]) -> Vec<Surface> {
    let coloured = scene.parts.iter().filter(|part| part.has_colours);
    let coloured: Vec<&str> = coloured
        .filter_map(|part| own.get(part.material as usize))
        .map(|material| material.name.as_str())
        .collect();
    let mut list: Vec<Surface> = Vec::new();
    for material in own {
        let name = &material.name;
        let is_fixed = material.alpha_cutoff.is_some() || coloured.contains(&name.as_str());
        if name.is_empty() || is_fixed || list.iter().any(|known| known.name == *name) {
            continue;
        }
        let colour = material.glass.or(material.microfacet.map(|m| m.base));
        let colour = colour.unwrap_or(material.diffuse).map(f64::from);
        list.push(Surface {
            name: name.clone(),
            is_glass: material.glass.is_some(),
            value: luminance(colour.into()),
        });
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::OptionValues;
    use crate::options::tests::exposed_scene;

    fn model() -> Scene {
        let material = |name: &str, glass: Option<[f32; 3]>| Material {
            name: name.to_owned(),
            diffuse: [0.3; 3],
            glass,
            ..Material::default()
        };
        let leaf = Material {
            alpha_cutoff: Some(0.5),
            ..material("leaf", None)
        };
        let (east, west) = (
            material("east", Some([0.8; 3])),
            material("west", Some([0.8; 3])),
        );
        Scene {
            materials: vec![
                material("floor", None),
                east,
                west,
                leaf,
                material("", None),
            ],
            ..Scene::default()
        }
    }

    #[test]
    fn sliders_write_the_options_of_the_command() {
        let scene = model();
        let list = changeable(&scene, &scene.materials);
        let names: Vec<&str> = list.iter().map(|surface| surface.name.as_str()).collect();
        assert_eq!(names, ["floor", "east", "west"]);
        let given = OptionValues::from(vec![("glass".to_owned(), "0.6".to_owned())]);
        let mut options = Options::resolve(&given, &exposed_scene()).expect("options");
        assert_eq!(list[1].by(&options).value, 0.6);
        assert!((list[0].by(&options).value - 0.3).abs() < 1e-6);
        let set = |options: &mut Options, number: usize, value: f64| {
            let surface = Surface {
                value,
                ..list[number].clone()
            };
            surface.write(options, ["east", "west"].into_iter());
        };
        set(&mut options, 1, 0.5);
        set(&mut options, 0, 0.2);
        set(&mut options, 0, 0.4);
        let written = [&options.glass, &options.reflectance]
            .map(|list| list.as_ref().map(ToString::to_string).unwrap_or_default());
        assert_eq!(written, ["east=0.5,west=0.6", "floor=0.4"]);
        let values: Vec<f64> = list.iter().map(|own| own.by(&options).value).collect();
        assert_eq!(values, [0.4, 0.5, 0.6]);
        // The model takes what was written.
        let mut changed = model();
        set_materials(&mut changed, &options).expect("its materials");
        assert_eq!(changed.materials[0].diffuse, [0.4; 3]);
        assert!((changed.materials[2].glass.expect("a pane")[0] - 0.6).abs() < 1e-6);
    }
}
