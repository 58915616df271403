//! The nodes of a tree.

use super::compact::CompactNode;
use super::node::{Child, Node, WIDTH, WideNode};
use crate::boxes::Box32;
use arrayvec::ArrayVec;

/// The nodes of a tree, in one of two sizes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Nodes {
    Full(Vec<Node>),
    Compact(Vec<CompactNode>),
}

impl Nodes {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Full(nodes) => nodes.len(),
            Self::Compact(nodes) => nodes.len(),
        }
    }

    /// Bytes they occupy.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Full(nodes) => size_of_val(nodes.as_slice()),
            Self::Compact(nodes) => size_of_val(nodes.as_slice()),
        }
    }

    /// The children of a node with their boxes, if there is a node of that number.
    pub(super) fn children(&self, number: usize) -> Option<ArrayVec<(Child, Box32), WIDTH>> {
        match self {
            Self::Full(nodes) => nodes.get(number).map(|n| n.children().collect()),
            Self::Compact(nodes) => nodes.get(number).map(|n| n.children().collect()),
        }
    }

    /// The same nodes in compact form; their boxes may be larger.
    pub(super) fn compacted(&self) -> Self {
        match self {
            Self::Full(nodes) => Self::Compact(nodes.iter().map(CompactNode::of).collect()),
            Self::Compact(_) => self.clone(),
        }
    }
}
