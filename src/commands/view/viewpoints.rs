//! Viewpoints: the scene's named cameras and those saved by the user.

use crate::scene::Camera;

/// A named view.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewpoint {
    /// Name of the scene file's camera, or a number.
    pub name: String,
    /// The camera.
    pub camera: Camera,
}

/// A list of viewpoints, one of which may be current.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Viewpoints {
    list: Vec<Viewpoint>,
    current: Option<usize>,
}

impl Viewpoints {
    /// Creates the list with no current viewpoint.
    pub fn new(list: Vec<Viewpoint>) -> Self {
        Self {
            list,
            current: None,
        }
    }

    /// All viewpoints in order.
    pub fn list(&self) -> &[Viewpoint] {
        &self.list
    }

    /// Saves `camera` under the next free number and makes it current; returns its name.
    pub fn save(&mut self, camera: Camera) -> &str {
        let mut number = self.list.len() + 1;
        while self.list.iter().any(|v| v.name == number.to_string()) {
            number += 1;
        }
        let name = number.to_string();
        self.current = Some(self.list.len());
        self.list.push(Viewpoint { name, camera });
        &self.list[self.list.len() - 1].name
    }

    /// Goes to the next viewpoint, cyclically; `None` when there are none.
    pub fn cycle(&mut self) -> Option<&Viewpoint> {
        let next = self.current.map_or(0, |at| at + 1);
        self.choose(next % self.list.len().max(1))
    }

    /// Goes to the previous viewpoint, cyclically; `None` when there are none.
    pub fn cycle_back(&mut self) -> Option<&Viewpoint> {
        let length = self.list.len().max(1);
        self.choose((self.current.unwrap_or(0) + length - 1) % length)
    }

    /// Goes to the viewpoint at `index`; `None` if there is none.
    pub fn choose(&mut self, index: usize) -> Option<&Viewpoint> {
        let chosen = self.list.get(index)?;
        self.current = Some(index);
        Some(chosen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Bounds;

    fn camera(fov_deg: f32) -> Camera {
        Camera::framing(&Bounds::EMPTY, fov_deg, 1.0)
    }

    fn named(name: &str) -> Viewpoint {
        Viewpoint {
            name: name.to_owned(),
            camera: camera(30.0),
        }
    }

    #[test]
    fn they_come_in_turn() {
        let mut views = Viewpoints::new(vec![named("porch"), named("garden")]);
        let name = |v: &mut Viewpoints| v.cycle().map(|v| v.name.clone());
        let names: Vec<_> = (0..3).map(|_| name(&mut views)).collect();
        assert_eq!(
            names,
            ["porch", "garden", "porch"].map(|n| Some(n.to_owned()))
        );
        assert_eq!(views.cycle_back().map(|v| v.name.as_str()), Some("garden"));
        assert_eq!(
            views.choose(0).map(|v| v.name.clone()).as_deref(),
            Some("porch")
        );
        assert_eq!(views.choose(2), None);
        let mut fresh = Viewpoints::new(vec![named("porch"), named("garden")]);
        assert_eq!(fresh.cycle_back().map(|v| v.name.as_str()), Some("garden"));
    }

    #[test]
    fn a_saved_one_is_kept_and_named_by_a_free_number() {
        let mut views = Viewpoints::default();
        assert_eq!(views.cycle(), None);
        assert_eq!(views.cycle_back(), None);
        assert_eq!(views.save(camera(50.0)), "1");
        let mut views = Viewpoints::new(vec![named("2")]);
        assert_eq!(views.save(camera(50.0)), "3");
        // The saved viewpoint is current, so the next one is the first again.
        assert_eq!(views.cycle().map(|v| v.name.as_str()), Some("2"));
        assert_eq!(views.cycle().map(|v| v.camera), Some(camera(50.0)));
    }
}
