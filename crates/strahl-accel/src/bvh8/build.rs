//! Builds the tree from the top: the largest child is split until there are eight; the same tree for any number of threads.

use super::node::{Child, Node, Nodes, WIDTH, WideNode};
use super::{BLOCK, Bvh8, NO_PRIMITIVE, Tree};
use crate::bvh::bins::Bins;
use crate::bvh::refs::{Ref, gather};
use crate::bvh::split::{LeafModel, Set};
use crate::cull::CullBounds;
use crate::shapes::all_bounds;
use crate::{List, Shapes};
use arrayvec::ArrayVec;
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

/// Boxes with classes.
struct Classed<'b, F> {
    bounds: &'b [Aabb],
    class: F,
}

impl<F: Fn(u32) -> u8 + Sync> Shapes for Classed<'_, F> {
    fn count(&self) -> usize {
        self.bounds.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.bounds[id as usize]
    }

    fn class(&self, id: u32) -> u8 {
        (self.class)(id)
    }
}

impl Bvh8 {
    /// Builds the hierarchy over boxes `0..n`, n at most [`Bvh8::MAX_PRIMITIVES`]; `class` tells the class of each.
    pub fn build(bounds: &[Aabb], class: impl Fn(u32) -> u8 + Sync) -> Self {
        Self::build_from(&Classed { bounds, class })
    }

    /// Builds the hierarchy over primitives `0..n`, n at most [`Bvh8::MAX_PRIMITIVES`].
    pub(crate) fn build_from(shapes: &dyn Shapes) -> Self {
        let primitive = |id| (shapes.bounds(id), shapes.class(id) & 3);
        let (refs, unbounded) = gather(shapes.count(), primitive);
        let bvh = Self {
            tree: (!refs.is_empty()).then(|| Tree::build(refs)),
            unbounded: List::of(unbounded),
            simd: Simd::detect(),
        };
        debug_assert_eq!(bvh.validate(&all_bounds(shapes)), Ok(()));
        bvh
    }
}

impl Tree {
    fn build(mut refs: Vec<Ref>) -> Self {
        let mut spare = refs.clone();
        let mut parts = Parts::new();
        parts.reserve(refs.len());
        let all = Set::all(&mut refs, &mut spare);
        let bounds = CullBounds::new(all.extent.bounds.to_aabb());
        let root = parts.add(all);
        parts.nodes.shrink_to_fit();
        parts.slots.shrink_to_fit();
        Self {
            root,
            nodes: Nodes::Full(parts.nodes),
            slots: parts.slots,
            bounds,
        }
    }
}

/// A set on its way to be a child, with half its surface area.
struct Open<'a> {
    set: Set<'a>,
    area: f64,
    /// Whether it can't be split.
    leaf: bool,
}

impl<'a> Open<'a> {
    fn new(set: Set<'a>, leaf: bool) -> Self {
        let area = set.extent.bounds.half_area();
        Self { set, area, leaf }
    }
}

/// A tree that grows. Depth first, the children with the largest boxes first, as rays are likely to walk it.
struct Parts {
    nodes: Vec<Node>,
    slots: Vec<u32>,
    bins: Bins,
}

impl Parts {
    fn new() -> Self {
        Self {
            nodes: Vec::new(),
            slots: Vec::new(),
            bins: Bins::new(),
        }
    }

    /// Expects so many primitives: memory that is not used in the end was never touched.
    fn reserve(&mut self, refs: usize) {
        self.nodes.reserve(refs / 8);
        self.slots.reserve(2 * refs);
    }

    /// Adds the subtree of a set.
    fn add(&mut self, set: Set<'_>) -> Child {
        match set.split(&LEAF, &mut self.bins) {
            Err(leaf) => self.add_leaf(&leaf),
            Ok(halves) => self.add_node(halves),
        }
    }

    fn add_node(&mut self, halves: [Set<'_>; 2]) -> Child {
        let total: usize = halves.iter().map(|s| s.refs.len()).sum();
        let mut open: ArrayVec<Open<'_>, WIDTH> =
            halves.into_iter().map(|s| Open::new(s, false)).collect();
        while open.len() < WIDTH {
            // Of equal ones the first, so that the choice is unique.
            let inner = (0..open.len()).filter(|i| !open[*i].leaf);
            let largest = inner.reduce(|a, b| if open[b].area > open[a].area { b } else { a });
            let Some(largest) = largest else { break };
            match open.swap_remove(largest).set.split(&LEAF, &mut self.bins) {
                Ok([left, right]) => {
                    open.push(Open::new(left, false));
                    open.push(Open::new(right, false));
                }
                Err(set) => open.push(Open::new(set, true)),
            }
        }
        // Large ones first: rays that look for anything at all are likely to find it there. The sort is stable.
        let mut order: ArrayVec<usize, WIDTH> = (0..open.len()).collect();
        order.sort_by(|a, b| open[*b].area.total_cmp(&open[*a].area));
        let number = self.nodes.len();
        let mut node = Node::EMPTY;
        for (place, which) in order.iter().enumerate() {
            node.set(place, &open[*which].set.extent.bounds, Child::default());
        }
        self.nodes.push(node);
        let mut open: ArrayVec<Option<Open<'_>>, WIDTH> = open.into_iter().map(Some).collect();
        let mut sets = order.into_iter().filter_map(|which| open[which].take());
        if total > PARALLEL && rayon::current_num_threads() > 1 {
            let children = self.add_parallel(sets.collect());
            for (place, child) in children.into_iter().enumerate() {
                self.nodes[number].children[place] = child;
            }
        } else {
            for place in 0..WIDTH {
                let Some(set) = sets.next() else { break };
                self.nodes[number].children[place] = self.add_open(set);
            }
        }
        Child::inner(number)
    }

    fn add_open(&mut self, open: Open<'_>) -> Child {
        if open.leaf {
            self.add_leaf(&open.set)
        } else {
            self.add(open.set)
        }
    }

    /// Adds several subtrees, each as if the ones before had been added first.
    fn add_parallel(&mut self, mut sets: Vec<Open<'_>>) -> Vec<Child> {
        if sets.len() == 1 {
            return sets.into_iter().map(|set| self.add_open(set)).collect();
        }
        let later = sets.split_off(sets.len() / 2);
        let mut other = Self::new();
        let (mut children, more) =
            rayon::join(|| self.add_parallel(sets), || other.add_parallel(later));
        let (nodes, blocks) = (self.nodes.len(), self.slots.len() / BLOCK);
        self.nodes.extend(other.nodes.into_iter().map(|mut node| {
            // Not those of empty places, so that the tree is the one that a single thread makes.
            let used = node.children().count();
            for child in &mut node.children[..used] {
                *child = child.moved(nodes, blocks);
            }
            node
        }));
        self.slots.extend(other.slots);
        children.extend(more.into_iter().map(|c| c.moved(nodes, blocks)));
        children
    }

    fn add_leaf(&mut self, set: &Set<'_>) -> Child {
        let first = self.slots.len();
        self.slots.extend(set.refs.iter().map(Ref::id));
        self.slots[first..].sort_unstable();
        self.slots
            .resize(self.slots.len().next_multiple_of(BLOCK), NO_PRIMITIVE);
        let class = set.extent.classes.trailing_zeros() as u8;
        Child::leaf(first / BLOCK, class, set.refs.len())
    }
}
