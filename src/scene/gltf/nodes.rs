//! The node graph: which nodes are drawn, and where. Transforms are read and multiplied in `f64`.

use glam::{DAffine3, DMat4, DQuat, DVec3};

use crate::scene::gltf::item::Item;
use crate::scene::losses::Losses;

/// Scenes that are looked at until one draws something.
const MOST_SCENES: usize = 16;

/// All nodes of a file.
#[derive(Debug)]
pub struct Graph {
    /// The nodes that are drawn, each once, in the order of the scene.
    pub drawn: Vec<usize>,
    /// Transform of every node to the root; `None` if it is not valid.
    world: Vec<Option<DAffine3>>,
}

impl Graph {
    /// The default scene of a file; without one, or if that draws nothing, the first that does, and without any scene all nodes.
    pub fn read(root: Item<'_>, losses: &mut Losses) -> Self {
        let nodes = root.get("nodes");
        let count = nodes.items().len();
        let scenes = root.get("scenes");
        let chosen = root.get("scene").index().unwrap_or(0);
        let others = (0..scenes.items().len().min(MOST_SCENES)).filter(|i| *i != chosen);
        let mut walk = Walk::new(nodes, count);
        for scene in std::iter::once(chosen).chain(others) {
            let roots = indices(scenes.at(scene).get("nodes"));
            let mut own = Losses::default();
            walk.from(&roots, &mut own);
            if walk.draws() {
                if scene != chosen && scenes.at(chosen).exists() {
                    losses.add("scenes without anything to draw passed over", || {
                        format!("scenes[{chosen}]; drawn instead: scenes[{scene}]")
                    });
                }
                losses.append(own);
                return walk.finish();
            }
            walk = Walk::new(nodes, count);
        }
        let mut own = Losses::default();
        walk.from(&walk.roots(), &mut own);
        if !walk.draws() {
            // All nodes lie on circles, or below such.
            walk.from(&(0..count).collect::<Vec<_>>(), &mut own);
        }
        losses.append(own);
        walk.finish()
    }

    /// The transform from a node to the file's space, metres; `None` if it is not valid.
    pub fn file_from_node(&self, node: usize) -> Option<DAffine3> {
        self.world.get(node).copied().flatten()
    }
}

/// Whole numbers of a list.
fn indices(list: Item<'_>) -> Vec<usize> {
    list.items().filter_map(Item::index).collect()
}

/// A walk over the graph that visits each node once.
struct Walk<'j> {
    nodes: Item<'j>,
    seen: Vec<bool>,
    world: Vec<Option<DAffine3>>,
    visited: Vec<usize>,
}

impl<'j> Walk<'j> {
    fn new(nodes: Item<'j>, count: usize) -> Self {
        Self {
            nodes,
            seen: vec![false; count],
            world: vec![None; count],
            visited: Vec::new(),
        }
    }

    /// The nodes that are no child of another.
    fn roots(&self) -> Vec<usize> {
        let mut is_child = vec![false; self.seen.len()];
        for child in self
            .nodes
            .items()
            .flat_map(|node| indices(node.get("children")))
        {
            if let Some(flag) = is_child.get_mut(child) {
                *flag = true;
            }
        }
        (0..is_child.len()).filter(|i| !is_child[*i]).collect()
    }

    fn from(&mut self, roots: &[usize], losses: &mut Losses) {
        let mut open: Vec<(usize, Option<DAffine3>, Option<usize>)> = Vec::new();
        for root in roots.iter().rev() {
            open.push((*root, Some(DAffine3::IDENTITY), None));
        }
        while let Some((node, parent, parent_node)) = open.pop() {
            let whose = || parent_node.map_or("the scene".to_owned(), |p| format!("nodes[{p}]"));
            match self.seen.get_mut(node) {
                None => {
                    let place = || format!("nodes[{node}] of {}", whose());
                    losses.add("nodes that do not exist left out", place);
                    continue;
                }
                Some(true) => {
                    let place = || format!("nodes[{node}] below {}", whose());
                    losses.add("nodes listed twice or in a circle, each drawn once", place);
                    continue;
                }
                Some(seen) => *seen = true,
            }
            let item = self.nodes.at(node);
            if item.extension("KHR_node_visibility").get("visible").flag() == Some(false) {
                continue;
            }
            let local = local(item).filter(DAffine3::is_finite);
            if local.is_none() {
                let place = || format!("nodes[{node}]");
                losses.add("nodes with a transform that is not valid not drawn", place);
            }
            let world = parent.zip(local).map(|(parent, local)| parent * local);
            self.world[node] = world;
            self.visited.push(node);
            let children = indices(item.get("children"));
            open.extend(
                children
                    .into_iter()
                    .rev()
                    .map(|child| (child, world, Some(node))),
            );
        }
    }

    fn draws(&self) -> bool {
        let mut visited = self.visited.iter();
        visited.any(|node| self.nodes.at(*node).get("mesh").exists())
    }

    /// Joints may lie outside of the scene: the other nodes are placed, too.
    fn finish(mut self) -> Graph {
        let drawn = self.visited.clone();
        let mut ignored = Losses::default();
        self.from(&self.roots(), &mut ignored);
        Graph {
            drawn,
            world: self.world,
        }
    }
}

/// The transform of a node to its parent.
fn local(node: Item<'_>) -> Option<DAffine3> {
    let matrix = node.get("matrix");
    if matrix.exists() {
        let matrix = DMat4::from_cols_array(&matrix.numbers()?);
        return Some(DAffine3::from_mat4(matrix));
    }
    fn given<const N: usize>(item: Item<'_>, default: [f64; N]) -> Option<[f64; N]> {
        if item.exists() {
            item.numbers()
        } else {
            Some(default)
        }
    }
    let rotation = DQuat::from_array(given(node.get("rotation"), [0.0, 0.0, 0.0, 1.0])?);
    let length = rotation.length();
    let unit = if length > 0.0 {
        rotation / length
    } else {
        DQuat::IDENTITY
    };
    Some(DAffine3::from_scale_rotation_translation(
        DVec3::from(given(node.get("scale"), [1.0; 3])?),
        unit,
        DVec3::from(given(node.get("translation"), [0.0; 3])?),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn read(json: &Value) -> (Vec<usize>, Vec<String>) {
        let mut losses = Losses::default();
        let graph = Graph::read(Item::of(json), &mut losses);
        (graph.drawn, losses.lines().collect())
    }

    #[test]
    fn circles_and_nodes_that_do_not_exist_are_told_of() {
        let circle = json!({"scenes": [{"nodes": [0, 9]}],
            "nodes": [{"children": [1]}, {"mesh": 0, "children": [0]}]});
        let (drawn, told) = read(&circle);
        assert_eq!(drawn, [0, 1]);
        assert!(
            told.iter()
                .any(|t| t.contains("in a circle") && t.contains("nodes[0] below nodes[1]"))
        );
        assert!(
            told.iter().any(|t| t.contains("nodes[9] of the scene")),
            "{told:?}"
        );
        let closed = json!({"nodes": [{"children": [1]}, {"mesh": 0, "children": [0]}]});
        assert_eq!(read(&closed).0, [0, 1], "without a way in");
    }

    #[test]
    fn a_scene_that_draws_nothing_is_passed_over() {
        let json = json!({"scene": 0, "scenes": [{"name": "empty"}, {"nodes": [1]}],
            "nodes": [{"mesh": 1}, {"mesh": 0}]});
        let (drawn, told) = read(&json);
        assert_eq!(drawn, [1]);
        assert!(
            told[0].contains("scenes[0]") && told[0].contains("scenes[1]"),
            "{told:?}"
        );
        let without = json!({"nodes": [{"children": [1]}, {"mesh": 0}]});
        assert_eq!(read(&without), (vec![0, 1], vec![]));
    }

    #[test]
    fn transforms_multiply_in_f64() {
        let json = json!({"scenes": [{"nodes": [0]}], "nodes": [
            {"children": [1], "translation": [6_100_000.25, 0, 0]},
            {"mesh": 0, "translation": [0.001, 0, 0], "rotation": [0, 0, 0, 2], "scale": [2, 2, 2]},
            {"rotation": [0, 0, 0]}]});
        let graph = Graph::read(Item::of(&json), &mut Losses::default());
        let world = graph.file_from_node(1).expect("a transform");
        assert_eq!(world.translation.x, 6_100_000.251);
        assert_eq!(world.matrix3.x_axis.x, 2.0);
        assert!(graph.file_from_node(2).is_none() && graph.file_from_node(7).is_none());
    }
}
