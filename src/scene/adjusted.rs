//! Other panes and surfaces in a model than its file has.

use crate::scene::{Material, Scene};

impl Scene {
    /// Gives panes of glass these transmittances at normal incidence, by the names of their materials; an empty name is every pane.
    /// `tinted` gives glass of the tint of a pane with a transmittance, if there is such glass.
    ///
    /// # Errors
    /// A name that no material has, a material that is no pane, or a tint too deep for that much light.
    pub fn set_glass(
        &mut self,
        asked: &[(String, f64)],
        tinted: impl Fn([f32; 3], f64) -> Option<[f32; 3]>,
    ) -> Result<(), String> {
        for (name, transmittance) in asked {
            let mut is_found = false;
            for material in self.named(name)? {
                let Some(glass) = &mut material.glass else {
                    if name.is_empty() {
                        continue;
                    }
                    return Err(format!(
                        "\"{name}\" is no pane of glass: its material needs an opacity below 1 (d, Tf) or a transmission"
                    ));
                };
                *glass = tinted(*glass, *transmittance).ok_or_else(|| {
                    format!(
                        "the tint of \"{}\" is too deep to let {transmittance} through",
                        material.name
                    )
                })?;
                is_found = true;
            }
            if !is_found {
                return Err("the model has no panes of glass".to_owned());
            }
        }
        Ok(())
    }

    /// Makes materials grey and matt, with these reflectances, 0..=1, by their names.
    ///
    /// # Errors
    /// A name that no material has, or a material that is no plain surface.
    pub fn set_reflectance(&mut self, asked: &[(String, f64)]) -> Result<(), String> {
        for (name, reflectance) in asked {
            let coloured = self.parts.iter().filter(|part| part.has_colours);
            let mut coloured = coloured.map(|part| &self.materials[part.material as usize].name);
            if coloured.any(|known| known == name) {
                return Err(format!(
                    "\"{name}\" has colours at its vertices, which no reflectance replaces; take them out of the model"
                ));
            }
            for material in self.named(name)? {
                if material.glass.is_some() {
                    return Err(format!("\"{name}\" is a pane of glass; use --glass"));
                }
                if material.alpha_cutoff.is_some() {
                    return Err(format!(
                        "\"{name}\" is a cut-out, whose texture no reflectance replaces"
                    ));
                }
                *material = Material {
                    diffuse: [*reflectance as f32; 3],
                    diffuse_texture: None,
                    specular: [0.0; 3],
                    specular_texture: None,
                    microfacet: None,
                    ..material.clone()
                };
            }
        }
        Ok(())
    }

    /// The materials of this name, of any if it is empty.
    fn named(&mut self, name: &str) -> Result<impl Iterator<Item = &mut Material>, String> {
        let is_it = move |material: &Material| name.is_empty() || material.name == name;
        if !name.is_empty() && !self.materials.iter().any(is_it) {
            let known: Vec<&str> = self.materials.iter().map(|m| m.name.as_str()).collect();
            let known = known.join(", ");
            return Err(format!("no material \"{name}\"; the model has {known}"));
        }
        Ok(self.materials.iter_mut().filter(move |m| is_it(m)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Glass whose green is the transmittance; none has more than 0.9 of a colour.
    fn tinted(glass: [f32; 3], transmittance: f64) -> Option<[f32; 3]> {
        let tinted = glass.map(|v| v * transmittance as f32 / glass[1]);
        tinted.iter().all(|v| *v <= 0.9).then_some(tinted)
    }

    fn scene() -> Scene {
        let material = |name: &str, glass| Material {
            name: name.to_owned(),
            glass,
            diffuse_texture: Some(0),
            ..Material::default()
        };
        Scene {
            materials: vec![
                material("floor", None),
                material("clear", Some([0.88; 3])),
                material("blue", Some([0.2, 0.4, 0.8])),
            ],
            ..Scene::default()
        }
    }

    #[test]
    fn panes_let_through_what_is_asked_and_keep_their_tint() {
        let mut scene = scene();
        let asked = [(String::new(), 0.4), ("blue".to_owned(), 0.3)];
        scene.set_glass(&asked, tinted).expect("panes");
        let [floor, clear, blue] = &scene.materials[..] else {
            panic!("three");
        };
        assert!(floor.glass.is_none());
        assert!(
            clear
                .glass
                .is_some_and(|g| g.iter().all(|v| (v - 0.4).abs() < 1e-6))
        );
        let glass = blue.glass.expect("a pane");
        assert!((glass[1] - 0.3).abs() < 1e-6);
        assert!((glass[2] / glass[0] - 4.0).abs() < 1e-5);
    }

    #[test]
    fn surfaces_become_grey() {
        let mut scene = scene();
        let asked = [("floor".to_owned(), 0.35)];
        scene.set_reflectance(&asked).expect("a floor");
        let floor = &scene.materials[0];
        assert_eq!((floor.diffuse, floor.diffuse_texture), ([0.35; 3], None));
        assert_eq!(scene.materials[1].diffuse_texture, Some(0));
    }

    #[test]
    fn what_the_model_lacks_is_named() {
        let glass = |name: &str, value| scene().set_glass(&[(name.to_owned(), value)], tinted);
        for (error, part) in [
            (glass("flor", 0.5), "the model has floor, clear, blue"),
            (glass("floor", 0.5), "\"floor\" is no pane of glass"),
            (glass("blue", 0.9), "the tint of \"blue\" is too deep"),
            (
                Scene::default().set_glass(&[(String::new(), 0.5)], tinted),
                "no panes",
            ),
            (
                scene().set_reflectance(&[("clear".to_owned(), 0.5)]),
                "use --glass",
            ),
        ] {
            let error = error.expect_err(part);
            assert!(error.contains(part), "{error}");
        }
    }
}
