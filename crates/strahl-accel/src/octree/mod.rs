//! The octree, with four traversal methods.
//!
//! `build` divides space, `exit` finds the face by which a ray leaves a cell, `step` walks from leaf to leaf, `parametric` from
//! the root downwards.

mod build;
mod exit;
mod parametric;
mod step;
mod traverse;

use crate::cells::Base;
use crate::parameters::{Parameter, Parameters, choice};
use strahl_math::{Aabb, DVec3};

choice! {
    /// Where a cell is divided.
    Split {
        /// In its centre.
        "centre" Centre,
        /// Along each axis where rays are expected to cost the least.
        "cost" Cost,
    }
}

choice! {
    /// The traversal method.
    Traversal {
        /// Top-down: the order of a cell's children follows from the crossings of its planes.
        "parametric" Parametric,
        /// From leaf to leaf: the first of the three faces ahead is the exit, the next leaf is searched from the root.
        "exit-face" ExitFace,
        /// The same, but one face is tried first; the intersection with its plane decides the exit.
        "trial-plane" TrialPlane,
        /// The exit by three faces; the next leaf is found from the nearest common ancestor.
        "neighbours" Neighbours,
    }
}

/// The parameters of [`Octree`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OctreeParameters {
    /// Levels below the root, at most 20.
    pub depth: u32,
    /// Where cells are divided.
    pub split: Split,
    /// Cells with no more primitives are not divided.
    pub leaf: u32,
    /// The traversal method.
    pub traversal: Traversal,
    /// The construction of V. Havran's published figures: boxes decide which primitives a cell lists, every cell with too many
    /// primitives is divided, primitives may be tested repeatedly.
    pub havran: bool,
}

impl Parameters for OctreeParameters {
    const DEFAULT: Self = Self {
        depth: 10,
        split: Split::Cost,
        leaf: 2,
        traversal: Traversal::Parametric,
        havran: false,
    };
    const ALL: &'static [Parameter] = &[
        Parameter {
            name: "depth",
            values: "0..20",
            about: "levels below the root [10]",
        },
        Parameter {
            name: "split",
            values: "cost|centre",
            about: "the planes that divide cells [cost]",
        },
        Parameter {
            name: "leaf",
            values: "NUMBER",
            about: "cells with no more primitives are not divided [2]",
        },
        Parameter {
            name: "traversal",
            values: "parametric|exit-face|trial-plane|neighbours",
            about: "method of traversal [parametric]",
        },
        Parameter {
            name: "havran",
            values: "",
            about: "build and count as for V. Havran's published figures (centre, leaf=1, exit-face): by boxes, without mailboxes; give a depth of 7 or less with it, because each level can take 8 times the memory",
        },
    ];

    fn set(&mut self, name: &str, value: &str) -> Option<()> {
        match name {
            "depth" => self.depth = value.parse().ok().filter(|d| *d <= MOST_LEVELS)?,
            "leaf" => self.leaf = value.parse().ok().filter(|n| *n > 0)?,
            "split" => self.split = Split::of_name(value)?,
            "traversal" => self.traversal = Traversal::of_name(value)?,
            _ => {
                *self = Self {
                    depth: self.depth,
                    split: Split::Centre,
                    leaf: 1,
                    traversal: Traversal::ExitFace,
                    havran: true,
                };
            }
        }
        Some(())
    }

    fn value(&self, name: &str) -> Option<String> {
        match name {
            "depth" => Some(self.depth.to_string()),
            "leaf" => Some(self.leaf.to_string()),
            "split" => Some(self.split.name().to_owned()),
            "traversal" => Some(self.traversal.name().to_owned()),
            _ => self.havran.then(String::new),
        }
    }
}

/// An octree over the scene: cells that hold many primitives are divided into eight.
///
/// Primitives without bounds are kept in a list beside the tree and always visited.
#[derive(Clone, Debug, PartialEq)]
pub struct Octree {
    base: Base,
    root: Cell,
    blocks: Vec<Block>,
    ids: Vec<u32>,
    traversal: Traversal,
}

/// Levels below the root that a path can store.
const MOST_LEVELS: u32 = 20;

/// A cell: divided, or a leaf with primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cell {
    /// Leaf: index of its first id. Otherwise: index of the block of its children.
    first: u32,
    /// Leaf: number of its ids. Otherwise [`Cell::DIVIDED`].
    count: u32,
}

impl Cell {
    const DIVIDED: u32 = u32::MAX;

    #[inline(always)]
    fn is_leaf(self) -> bool {
        self.count != Self::DIVIDED
    }
}

/// Eight children: bit 0, 1, 2 of their number says whether they are the upper ones along x, y, z.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Block {
    /// Where the parent is divided.
    split: DVec3,
    children: [Cell; 8],
}

/// The box of a child.
#[inline(always)]
fn child_box(parent: &Aabb, split: DVec3, child: usize) -> Aabb {
    let mut b = *parent;
    for axis in 0..3 {
        if child >> axis & 1 == 1 {
            b.min[axis] = split[axis];
        } else {
            b.max[axis] = split[axis];
        }
    }
    b
}
