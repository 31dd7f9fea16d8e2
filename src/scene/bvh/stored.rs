//! A hierarchy as the cache stores it: nodes, and the numbers of the triangles in the order of the leaves. The triangles themselves
//! follow from the scene.

use super::{Bvh, LEAF_TRIANGLES, MAX_DEPTH, Node, triangle};
use crate::scene::Scene;

/// A hierarchy as arrays of plain numbers.
pub struct FlatBvh<'b> {
    pub nodes: &'b [Node],
    /// Number of each triangle in the scene.
    pub order: Vec<u32>,
}

impl<'b> FlatBvh<'b> {
    pub fn of(bvh: &'b Bvh) -> Self {
        Self {
            nodes: &bvh.nodes,
            order: bvh.triangles.iter().map(|t| t.number).collect(),
        }
    }
}

impl Bvh {
    /// The hierarchy of a valid scene from its arrays. `None` if they are of another scene or no tree: any arrays may be given.
    pub(in crate::scene) fn from_stored(
        nodes: Vec<Node>,
        order: &[u32],
        scene: &Scene,
    ) -> Option<Self> {
        let is_sound = is_permutation(order, scene.triangles()) && is_tree(&nodes, order.len());
        is_sound.then(|| Self {
            nodes,
            triangles: order.iter().map(|n| triangle(scene, *n)).collect(),
        })
    }
}

/// Whether each number below `count` occurs once.
fn is_permutation(order: &[u32], count: usize) -> bool {
    let mut seen = vec![false; count];
    let is_new = |n: &u32| {
        let place = seen.get_mut(*n as usize);
        place.is_some_and(|seen| !std::mem::replace(seen, true))
    };
    order.len() == count && order.iter().all(is_new)
}

/// An inner node whose subtree has not ended yet.
struct Open {
    /// The node after its subtree.
    end: usize,
    /// Whether its first child has ended.
    has_first: bool,
}

/// Whether the nodes are a binary tree that is no deeper than the stack of a ray, stored depth-first with the right skips, whose
/// leaves have all `triangles` in order, no more of them than a built one has.
fn is_tree(nodes: &[Node], triangles: usize) -> bool {
    let mut open: Vec<Open> = Vec::with_capacity(MAX_DEPTH);
    let mut count = 0;
    for (at, node) in nodes.iter().enumerate() {
        let skip = node.skip as usize;
        // Nothing may follow the root's subtree.
        if at > 0 && open.is_empty() {
            return false;
        }
        if node.triangle_count == 0 {
            if open.len() >= MAX_DEPTH || skip > nodes.len() {
                return false;
            }
            open.push(Open {
                end: skip,
                has_first: false,
            });
            continue;
        }
        let is_large = node.triangle_count as usize > LEAF_TRIANGLES;
        if is_large || node.first_triangle as usize != count || skip != at + 1 {
            return false;
        }
        count += node.triangle_count as usize;
        if !close(&mut open, skip) {
            return false;
        }
    }
    open.is_empty() && count == triangles && nodes.is_empty() == (triangles == 0)
}

/// Ends all subtrees whose last leaf is before node `at`. Whether the ends are where the nodes say.
fn close(open: &mut Vec<Open>, at: usize) -> bool {
    while let Some(parent) = open.last_mut() {
        if !parent.has_first {
            parent.has_first = true;
            return at < parent.end;
        }
        if parent.end != at {
            return false;
        }
        open.pop();
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::hills;

    fn stored() -> (Scene, Bvh, Vec<u32>) {
        let scene = hills(300);
        let bvh = Bvh::of(&scene, |_| true);
        let order = FlatBvh::of(&bvh).order;
        (scene, bvh, order)
    }

    #[test]
    fn a_stored_hierarchy_is_the_same_again() {
        let (scene, bvh, order) = stored();
        let again = Bvh::from_stored(bvh.nodes.clone(), &order, &scene);
        assert_eq!(again, Some(bvh));
        let none = Scene::default();
        let empty = Bvh::of(&none, |_| true);
        assert_eq!(Bvh::from_stored(Vec::new(), &[], &none), Some(empty));
    }

    #[test]
    fn any_wrong_link_count_or_number_is_refused() {
        let (scene, bvh, order) = stored();
        let mut tried = 0;
        let values = [0, 1, 2, 3, 7, 40, 299, 300, 301, u32::MAX];
        let fields: [fn(&mut Node) -> &mut u32; 3] = [
            |node| &mut node.skip,
            |node| &mut node.first_triangle,
            |node| &mut node.triangle_count,
        ];
        for at in 0..bvh.nodes.len() {
            for (field, value) in fields.iter().flat_map(|f| values.map(|v| (f, v))) {
                let mut nodes = bvh.nodes.clone();
                *field(&mut nodes[at]) = value;
                // Inner nodes do not use their first triangle.
                let is_unused = nodes[at].triangle_count == 0 && bvh.nodes[at].triangle_count == 0;
                let is_used = nodes[at].skip != bvh.nodes[at].skip || !is_unused;
                if nodes == bvh.nodes || !is_used {
                    continue;
                }
                tried += 1;
                let read = Bvh::from_stored(nodes, &order, &scene);
                assert!(read.is_none(), "node {at}: {value}");
            }
        }
        assert!(tried > 5000, "{tried}");
        for (at, value) in [(0, order[1]), (7, 300), (8, u32::MAX)] {
            let mut wrong = order.clone();
            wrong[at] = value;
            assert_eq!(Bvh::from_stored(bvh.nodes.clone(), &wrong, &scene), None);
        }
        let mut more = bvh.nodes.clone();
        more.push(more[0]);
        for nodes in [more, bvh.nodes[..bvh.nodes.len() - 1].to_vec(), Vec::new()] {
            assert_eq!(Bvh::from_stored(nodes, &order, &scene), None);
        }
        assert_eq!(Bvh::from_stored(bvh.nodes, &order[1..], &scene), None);
    }

    #[test]
    fn a_tree_deeper_than_the_stack_or_with_large_leaves_is_refused() {
        // Each inner node has a leaf and the next inner node.
        let chain = |depth: u32| {
            let leaf = |at: u32, first: u32| Node {
                first_triangle: first,
                triangle_count: 1,
                skip: at + 1,
                ..bytemuck::Zeroable::zeroed()
            };
            let inner = Node {
                skip: 2 * depth + 1,
                ..bytemuck::Zeroable::zeroed()
            };
            let mut nodes: Vec<Node> = (0..depth)
                .flat_map(|i| [inner, leaf(2 * i + 1, i)])
                .collect();
            nodes.push(leaf(2 * depth, depth));
            nodes
        };
        assert!(is_tree(&chain(MAX_DEPTH as u32), MAX_DEPTH + 1));
        let mut large = chain(1);
        large[2].triangle_count = LEAF_TRIANGLES as u32 + 1;
        assert!(!is_tree(&large, LEAF_TRIANGLES + 2));
        assert!(!is_tree(&chain(MAX_DEPTH as u32 + 1), MAX_DEPTH + 2));
    }
}
