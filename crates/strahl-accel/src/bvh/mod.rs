//! The binary bounding volume hierarchy: scalar and readable, the reference of the wide ones to come.
//!
//! Split by phase: `build` makes it, `traverse` walks it, `validate` proves that it is what the walk relies on.

mod build;
mod traverse;
mod validate;

use crate::boxes::{Box32, BoxPair};
use strahl_math::Aabb;

/// A node: two children with their boxes, one cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Node {
    pub(crate) boxes: BoxPair,
    pub(crate) children: [Child; 2],
}

/// What is in a box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Child {
    /// Leaf: index of its first id. Otherwise: index of the node.
    pub(crate) first: u32,
    /// Leaf: number of its ids, at least 1. Otherwise 0.
    pub(crate) count: u32,
}

impl Node {
    pub(crate) fn bounds(&self, child: usize) -> Box32 {
        Box32 {
            lo: self.boxes.map(|planes| planes[child]),
            hi: self.boxes.map(|planes| planes[child + 2]),
        }
    }
}

/// A binary bounding volume hierarchy built by the surface area heuristic.
///
/// Boxes are f32, rounded outwards. Primitives without bounds are kept in a list beside the tree and always visited.
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh2 {
    /// What holds all bounded primitives; `None` if there are none.
    root: Option<Child>,
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
