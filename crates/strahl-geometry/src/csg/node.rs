//! The nodes of a compiled tree.

use super::half_spaces::HalfSpaces;
use super::sweep::Rule;
use strahl_accel::Bvh2;
use strahl_math::Aabb;

/// The kind of a compiled node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The leaf of this index.
    Leaf(u32),
    /// An operation on operands.
    Operation(Rule),
}

/// The parent of the root.
pub(super) const NO_PARENT: u32 = u32::MAX;

/// A compiled node.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) kind: Kind,
    /// The operation whose operand it is.
    pub(super) parent: u32,
    /// Whether it is a shape that is intersected as fast as its box.
    pub(super) quick: bool,
    /// Holds all surfaces of the node ...
    pub(super) bounds: Aabb,
    /// ... and whether everything outside of it is inside of the node.
    pub(super) far: bool,
    /// Operands: `first..core` decide the result where a ray misses their boxes (the positive ones of an intersection),
    /// `core..end` don't matter there (the subtracted ones).
    pub(super) first: u32,
    pub(super) core: u32,
    pub(super) end: u32,
    /// The last ones of `first..core`, if they are half-spaces.
    pub(super) half_spaces: Option<Box<HalfSpaces>>,
    /// Over the boxes of `core..end`, numbered from 0, if they are many.
    pub(super) hierarchy: Option<Box<Bvh2>>,
}

impl Node {
    /// Whether it is a leaf, a union or a merge: whatever is in an operand is in the whole.
    pub(super) fn only_adds(&self) -> bool {
        !matches!(self.kind, Kind::Operation(Rule::Intersection))
    }
}
