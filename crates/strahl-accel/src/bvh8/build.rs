//! Builds the tree from the top: the largest child is split until there are eight; the same tree for any number of threads.

use super::node::{Child, Node, WIDTH};
use super::{BLOCK, Bvh8, NO_PRIMITIVE, Tree};
use crate::List;
use crate::boxes::Box32;
use crate::bvh::split::{Extent, LeafModel, Ref, Split};
use crate::cull::CullBounds;
use strahl_math::Aabb;
use strahl_simd::Simd;

/// Sets with more primitives are split among threads.
const PARALLEL: usize = 4096;

/// Leaves are up to four blocks; a block costs about as much as a node.
const LEAF: LeafModel = LeafModel {
    max_size: Child::MAX_LEAF,
    block_cost: 1.0,
    block_log: BLOCK.ilog2(),
};

impl Bvh8 {
    /// Builds the hierarchy over boxes `0..n`, n at most [`Bvh8::MAX_PRIMITIVES`]; `class` tells the class of each.
    pub fn build(bounds: &[Aabb], class: impl Fn(u32) -> u8) -> Self {
        let mut refs = Vec::with_capacity(bounds.len());
        let mut unbounded = Vec::new();
        for (id, b) in (0..).zip(bounds) {
            if let Some(bounds) = Box32::try_new(b) {
                let class = class(id) & 3;
                refs.push(Ref { bounds, id, class });
            } else if !b.is_empty() {
                unbounded.push(id);
            }
        }
        let bvh = Self {
            tree: (!refs.is_empty()).then(|| Tree::build(&mut refs)),
            unbounded: List::of(unbounded),
            simd: Simd::detect(),
        };
        debug_assert_eq!(bvh.validate(bounds), Ok(()));
        bvh
    }
}

impl Tree {
    fn build(refs: &mut [Ref]) -> Self {
        let extent = Extent::of(refs);
        let bounds = CullBounds::new(extent.bounds.to_aabb());
        let mut parts = Parts::default();
        let root = parts.add(Set {
            refs,
            extent,
            depth: 0,
        });
        Self {
            root,
            nodes: parts.nodes,
            slots: parts.slots,
            bounds,
        }
    }
}

/// Primitives that will be a child.
struct Set<'a> {
    refs: &'a mut [Ref],
    extent: Extent,
    /// How often the whole was split to get here.
    depth: usize,
}

impl Set<'_> {
    /// Splits it, or gives it back because it is a leaf.
    fn split(self) -> Result<[Self; 2], Self> {
        let Some(split) = Split::choose(self.refs, &self.extent, self.depth, &LEAF) else {
            return Err(self);
        };
        let (left, right) = self.refs.split_at_mut(split.middle);
        let half = |refs, extent| Self {
            refs,
            extent,
            depth: self.depth + 1,
        };
        Ok([half(left, split.left), half(right, split.right)])
    }
}

/// A tree that grows. Depth first, the children with the largest boxes first, as rays are likely to walk it.
#[derive(Default)]
struct Parts {
    nodes: Vec<Node>,
    slots: Vec<u32>,
}

impl Parts {
    /// Adds the subtree of a set that is not empty.
    fn add(&mut self, set: Set<'_>) -> Child {
        match set.split() {
            Err(leaf) => self.add_leaf(&leaf),
            Ok(halves) => self.add_node(halves),
        }
    }

    fn add_node(&mut self, halves: [Set<'_>; 2]) -> Child {
        let total: usize = halves.iter().map(|s| s.refs.len()).sum();
        let mut open: Vec<Set<'_>> = halves.into();
        let mut leaves: Vec<Set<'_>> = Vec::new();
        while open.len() + leaves.len() < WIDTH {
            let area = |s: &Set<'_>| s.extent.bounds.half_area();
            // Of equal ones the first, so that the choice is unique.
            let largest = (0..open.len()).reduce(|a, b| {
                if area(&open[b]) > area(&open[a]) {
                    b
                } else {
                    a
                }
            });
            let Some(largest) = largest else { break };
            match open.remove(largest).split() {
                Ok(halves) => open.extend(halves),
                Err(leaf) => leaves.push(leaf),
            }
        }
        open.extend(leaves);
        // Large ones first: rays that look for anything at all are likely to find it there. The sort is stable.
        open.sort_by(|a, b| {
            b.extent
                .bounds
                .half_area()
                .total_cmp(&a.extent.bounds.half_area())
        });
        let number = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut node = Node::EMPTY;
        let boxes: Vec<Box32> = open.iter().map(|s| s.extent.bounds).collect();
        let children = if total > PARALLEL {
            self.add_parallel(open)
        } else {
            open.into_iter().map(|set| self.add(set)).collect()
        };
        for (place, (bounds, child)) in boxes.iter().zip(children).enumerate() {
            node.set(place, bounds, child);
        }
        self.nodes[number] = node;
        Child::inner(number)
    }

    /// Adds several subtrees, each as if the ones before had been added first.
    fn add_parallel(&mut self, mut sets: Vec<Set<'_>>) -> Vec<Child> {
        if sets.len() == 1 {
            return sets.into_iter().map(|set| self.add(set)).collect();
        }
        let later = sets.split_off(sets.len() / 2);
        let mut other = Self::default();
        let (mut children, more) =
            rayon::join(|| self.add_parallel(sets), || other.add_parallel(later));
        let (nodes, blocks) = (self.nodes.len(), self.slots.len() / BLOCK);
        self.nodes.extend(other.nodes.into_iter().map(|n| Node {
            children: n.children.map(|c| c.moved(nodes, blocks)),
            ..n
        }));
        self.slots.extend(other.slots);
        children.extend(more.into_iter().map(|c| c.moved(nodes, blocks)));
        children
    }

    fn add_leaf(&mut self, set: &Set<'_>) -> Child {
        let first = self.slots.len();
        self.slots.extend(set.refs.iter().map(|r| r.id));
        self.slots[first..].sort_unstable();
        self.slots
            .resize(self.slots.len().next_multiple_of(BLOCK), NO_PRIMITIVE);
        let class = set.extent.classes.trailing_zeros() as u8;
        Child::leaf(first / BLOCK, class, set.refs.len())
    }
}
