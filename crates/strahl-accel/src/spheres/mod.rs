//! The hierarchy of bounding spheres: a cheap test, a loose fit.
//!
//! `ball` has the geometry, `topology` decides the grouping, `build` makes the tree, `traverse` searches it.

mod ball;
mod build;
mod topology;
mod traverse;

use crate::List;
use crate::cull::CullBounds;
use crate::parameters::{Parameter, Parameters, choice};

choice! {
    /// How primitives are grouped into spheres.
    Grouping {
        /// Top-down, as a hierarchy of boxes.
        "bvh" Boxes,
        /// Bottom-up: neighbours with the smallest common sphere first.
        "agglomerative" Agglomerative,
    }
}

/// The parameters of [`Spheres`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpheresParameters {
    /// How primitives are grouped.
    pub build: Grouping,
}

impl Parameters for SpheresParameters {
    const DEFAULT: Self = Self {
        build: Grouping::Boxes,
    };
    const ALL: &'static [Parameter] = &[Parameter {
        name: "build",
        values: "bvh|agglomerative",
        about: "top-down, with the groups of a hierarchy of boxes, or bottom-up, joining neighbours with the smallest common sphere",
    }];

    fn set(&mut self, _: &str, value: &str) -> Option<()> {
        self.build = Grouping::of_name(value)?;
        Some(())
    }

    fn value(&self, _: &str) -> Option<String> {
        Some(self.build.name().to_owned())
    }
}

/// A hierarchy of bounding spheres, eight to a node.
///
/// Spheres are f32, rounded outwards, in units of a power of two that fits the scene. Primitives without bounds are kept in a
/// list beside the tree and always visited.
#[derive(Clone, Debug, PartialEq)]
pub struct Spheres {
    tree: Option<Tree>,
    unbounded: List,
}

/// The tree of all bounded primitives, at least one.
#[derive(Clone, Debug, PartialEq)]
struct Tree {
    /// Node 0 is the root.
    nodes: Vec<Node>,
    /// The primitives of the leaves, leaf by leaf.
    ids: Vec<u32>,
    bounds: CullBounds,
    /// Coordinates are divided by this power of two, so that squares neither overflow nor underflow f32.
    unit: f64,
}

/// Children of a node.
const WIDTH: usize = 8;

/// Eight spheres with their contents; the radius of unused ones is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
struct Node {
    center: [[f32; WIDTH]; 3],
    radius: [f32; WIDTH],
    /// Leaf: index of its first id. Otherwise: index of the node.
    first: [u32; WIDTH],
    /// Leaf: number of its ids, at least 1. Otherwise 0.
    count: [u32; WIDTH],
}
