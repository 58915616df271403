use crate::boxes::{Box32, BoxPair};

/// A node: two children with their boxes, in one cache line.
///
/// Both boxes are tested together in four lanes, so they are stored in their parent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub(super) boxes: BoxPair,
    pub(super) children: [Child; 2],
}

/// A child: a node or a leaf.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Child {
    /// Leaf: index of its first id. Otherwise: index of the node.
    pub(super) first: u32,
    /// Leaf: number of its ids, at least 1. Otherwise 0.
    pub(super) count: u32,
}

impl Child {
    pub(super) const fn inner(node: usize) -> Self {
        Self {
            first: node as u32,
            count: 0,
        }
    }

    #[inline(always)]
    pub(super) const fn is_leaf(self) -> bool {
        self.count > 0
    }

    /// The same child after `nodes` nodes and `ids` ids were inserted in front of those it refers to.
    pub(super) fn moved(self, nodes: usize, ids: usize) -> Self {
        let by = if self.is_leaf() { ids } else { nodes };
        Self {
            first: self.first + by as u32,
            ..self
        }
    }
}

impl Node {
    /// The box of a child (0 or 1).
    pub(super) fn bounds(&self, child: usize) -> Box32 {
        Box32::of_pair(&self.boxes, child)
    }
}
