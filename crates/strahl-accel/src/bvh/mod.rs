//! The binary bounding volume hierarchy: scalar and readable, the reference of the wide ones to come.
//!
//! Split by phase: `build` makes it, `traverse` walks it, `validate` proves that it is what the walk relies on.

mod build;
mod traverse;
mod validate;

use crate::boxes::Box32;
use strahl_math::Aabb;

/// A node: an inner node with two children next to each other, or a leaf. 32 bytes, two to a cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) lo: [f32; 3],
    /// Inner node: index of the first child, the second follows. Leaf: index of the first id.
    pub(crate) first: u32,
    pub(crate) hi: [f32; 3],
    /// 0 for an inner node, else the number of ids.
    pub(crate) count: u32,
}

/// A binary bounding volume hierarchy built by the surface area heuristic.
///
/// Boxes are f32, rounded outwards. Primitives without bounds are kept in a list beside the tree and always visited.
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh2 {
    nodes: Vec<Node>,
    /// The primitives of the leaves, leaf by leaf.
    ids: Vec<u32>,
    unbounded: Vec<u32>,
    /// The box of the root, in f64.
    bounds: Aabb,
    /// Largest absolute coordinate of any box: the B of the culling test.
    max_abs: f64,
}

/// Levels of the tree: the depth of the traversal's stack.
pub(crate) const MAX_DEPTH: usize = 64;

impl Bvh2 {
    fn root_box(&self) -> Box32 {
        self.nodes
            .first()
            .map_or(Box32::EMPTY, |n| Box32 { lo: n.lo, hi: n.hi })
    }
}
