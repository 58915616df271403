//! The binary bounding volume hierarchy: scalar and readable, the reference of the wide one.
//!
//! Split by phase: `build` makes it, `traverse` searches it, `validate` checks everything that the traversal relies on.

pub(crate) mod bins;
mod build;
mod fold;
mod node;
pub(crate) mod refs;
pub(crate) mod split;
mod traverse;
pub(crate) mod validate;
pub(crate) mod watch;

use crate::List;
use crate::cull::CullBounds;
use node::{Child, Node};

pub use build::BuildOptions;

/// A binary bounding volume hierarchy built by the surface area heuristic.
///
/// Boxes are f32, rounded outwards. Primitives without bounds are kept in a list beside the tree and always visited.
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh2 {
    tree: Option<Tree>,
    /// The primitives that are not in the tree: without bounds, or too far away for f32.
    unbounded: List,
}

/// The tree of all bounded primitives, at least one.
#[derive(Clone, Debug, PartialEq)]
struct Tree {
    root: Child,
    nodes: Vec<Node>,
    /// The primitives of the leaves, leaf by leaf.
    ids: Vec<u32>,
    bounds: CullBounds,
}

/// Levels of the tree, and so the depth of the traversal's stack.
///
/// The builder ensures it by halving sets that the surface area heuristic would split too unevenly (see `build`).
pub(crate) const MAX_DEPTH: usize = 64;
