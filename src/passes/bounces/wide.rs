//! Wide nodes of the hierarchy for the device: four children each, their boxes in bytes.
//!
//! Compressed wide nodes: Ylitie, Karras and Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs";
//! here with four children in 48 bytes.

use glam::Vec3;

use crate::scene::{Bounds, Bvh, LEAF_TRIANGLES, Node};

/// Children of a node.
const CHILDREN: usize = 4;

/// Steps of the grid that a node's box spans; one more on each side covers rounding errors.
const STEPS: f32 = 252.0;

/// A node with up to four children, as the device reads it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WideNode {
    /// Origin of the grid, metres.
    origin: Vec3,
    /// Exponents of the steps of the grid, biased as those of `f32`.
    exponents: [u8; 3],
    /// Numbers of triangles of the children; 0 for nodes.
    counts: [u8; CHILDREN],
    /// Lower and upper corners of the children, steps.
    low: [[u8; CHILDREN]; 3],
    high: [[u8; CHILDREN]; 3],
    /// The first child that is a node, and the first triangle of the others.
    first_node: u32,
    first_triangle: u32,
}

impl WideNode {
    /// The words of its texels.
    pub(super) fn words(&self) -> [[u32; 4]; 3] {
        let [x, y, z] = self.origin.to_array().map(f32::to_bits);
        let counts = self
            .counts
            .iter()
            .rev()
            .fold(0u32, |word, c| word << 2 | u32::from(*c));
        let [ex, ey, ez] = self.exponents.map(u32::from);
        let low = self.low.map(u32::from_le_bytes);
        let high = self.high.map(u32::from_le_bytes);
        [
            [x, y, z, ex | ey << 8 | ez << 16 | counts << 24],
            [low[0], low[1], low[2], high[0]],
            [high[1], high[2], self.first_node, self.first_triangle],
        ]
    }
}

/// A hierarchy of wide nodes.
pub(super) struct Wide {
    /// The root first; there is always one.
    pub nodes: Vec<WideNode>,
    /// The triangles in their order, as positions in [`Bvh::triangles`].
    pub triangles: Vec<u32>,
}

impl Wide {
    /// Joins the nodes of a hierarchy four by four.
    pub(super) fn of(bvh: &Bvh) -> Self {
        let mut wide = Self {
            nodes: Vec::with_capacity(bvh.nodes().len() / 2 + 1),
            triangles: Vec::with_capacity(bvh.triangles().len()),
        };
        // Nodes to be made, in order, by the binary nodes that they stand for.
        let mut sources: Vec<usize> = vec![0];
        let mut made = 0;
        while made < sources.len() {
            let children = children(bvh.nodes(), sources[made]);
            let first_node = sources.len() as u32;
            let first_triangle = wide.triangles.len() as u32;
            for child in &children {
                let node = &bvh.nodes()[*child];
                if node.triangle_count == 0 {
                    sources.push(*child);
                }
                let end = node.first_triangle + node.triangle_count;
                wide.triangles.extend(node.first_triangle..end);
            }
            let children: Vec<&Node> = children.iter().map(|c| &bvh.nodes()[*c]).collect();
            wide.nodes
                .push(joined(&children, first_node, first_triangle));
            made += 1;
        }
        wide
    }
}

/// Up to four nodes that cover what a node covers: the largest ones are opened first.
fn children(nodes: &[Node], of: usize) -> Vec<usize> {
    let Some(root) = nodes.get(of) else {
        return Vec::new();
    };
    if root.triangle_count > 0 {
        return vec![of];
    }
    let opened = |node: usize| [node + 1, nodes[node + 1].skip as usize];
    let mut list = opened(of).to_vec();
    while list.len() < CHILDREN {
        let inner = list.iter().enumerate();
        let inner = inner.filter(|(_, node)| nodes[**node].triangle_count == 0);
        let area = |node: usize| half_area(&nodes[node]);
        let Some((at, _)) = inner.max_by(|a, b| area(*a.1).total_cmp(&area(*b.1))) else {
            break;
        };
        let node = list.remove(at);
        list.extend(opened(node));
    }
    list
}

fn half_area(node: &Node) -> f32 {
    let e = node.max - node.min;
    e.x * e.y + e.y * e.z + e.z * e.x
}

/// A node with these children.
fn joined(children: &[&Node], first_node: u32, first_triangle: u32) -> WideNode {
    let bounds = children.iter().fold(Bounds::EMPTY, |all, child| {
        all.union(Bounds {
            min: child.min,
            max: child.max,
        })
    });
    let mut node = WideNode {
        origin: Vec3::ZERO,
        exponents: [127; 3],
        counts: [0; CHILDREN],
        // Inside out: never met.
        low: [[255; CHILDREN]; 3],
        high: [[0; CHILDREN]; 3],
        first_node,
        first_triangle,
    };
    if children.is_empty() {
        return node;
    }
    for axis in 0..3 {
        let (low, high) = (bounds.min[axis], bounds.max[axis]);
        // A flat box still gets steps that change its coordinates.
        let least = f32::MIN_POSITIVE.max(low.abs().max(high.abs()) * f32::EPSILON);
        let exponent = exponent((high - low) / STEPS).max(exponent(least));
        let step = f32::from_bits(u32::from(exponent) << 23);
        node.origin[axis] = low - step;
        node.exponents[axis] = exponent;
        for (i, child) in children.iter().enumerate() {
            // One step of margin on each side.
            let steps = |v: f32| (v - node.origin[axis]) / step;
            node.low[axis][i] = (steps(child.min[axis]).floor() - 1.0).clamp(0.0, 255.0) as u8;
            node.high[axis][i] = (steps(child.max[axis]).ceil() + 1.0).clamp(0.0, 255.0) as u8;
        }
    }
    for (i, child) in children.iter().enumerate() {
        debug_assert!(child.triangle_count as usize <= LEAF_TRIANGLES);
        node.counts[i] = child.triangle_count as u8;
    }
    node
}

/// Biased exponent of the smallest power of two that is not less than a positive `value`.
fn exponent(value: f32) -> u8 {
    let bits = value.max(f32::MIN_POSITIVE).to_bits();
    let is_power = bits & 0x007f_ffff == 0;
    (bits >> 23) as u8 + u8::from(!is_power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::hills;

    /// Checks that each node's boxes hold those of its children, and returns the depth of the tree and its number of triangles.
    fn visit(wide: &Wide, bvh: &Bvh, at: usize, depth: usize) -> (usize, usize) {
        let node = &wide.nodes[at];
        let (mut deepest, mut triangles) = (depth, 0);
        let (mut next_node, mut next_triangle) = (node.first_node, node.first_triangle);
        for i in 0..CHILDREN {
            if node.low[0][i] > node.high[0][i] {
                continue;
            }
            let corner = |steps: &[[u8; CHILDREN]; 3]| {
                let at = |axis: usize| {
                    let step = f32::from_bits(u32::from(node.exponents[axis]) << 23);
                    node.origin[axis] + f32::from(steps[axis][i]) * step
                };
                Vec3::new(at(0), at(1), at(2))
            };
            let (low, high) = (corner(&node.low), corner(&node.high));
            for position in next_triangle..next_triangle + u32::from(node.counts[i]) {
                let t = &bvh.triangles()[wide.triangles[position as usize] as usize];
                for v in [t.corner, t.corner + t.edge1, t.corner + t.edge2] {
                    assert!(
                        low.cmple(v).all() && v.cmple(high).all(),
                        "{low} {v} {high}"
                    );
                }
                triangles += 1;
            }
            next_triangle += u32::from(node.counts[i]);
            if node.counts[i] == 0 {
                let below = visit(wide, bvh, next_node as usize, depth + 1);
                deepest = deepest.max(below.0);
                triangles += below.1;
                next_node += 1;
            }
        }
        (deepest, triangles)
    }

    #[test]
    fn boxes_hold_their_triangles_and_no_triangle_is_lost() {
        let scene = hills(20_000);
        let bvh = Bvh::of(&scene, |_| true);
        let wide = Wide::of(&bvh);
        let (depth, triangles) = visit(&wide, &bvh, 0, 1);
        let bytes = 48 * wide.nodes.len() + 48 * triangles;
        println!(
            "{} nodes, depth {depth}, {} bytes a triangle",
            wide.nodes.len(),
            bytes / triangles
        );
        assert_eq!(triangles, scene.triangles());
        assert!(bytes <= 100 * triangles);
        // Three of four children wait at each level: the stack of include/bvh.glsl holds them.
        assert!(3 * depth < 64);
    }
}
