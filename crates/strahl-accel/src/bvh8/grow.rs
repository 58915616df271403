//! Builds the tree of nodes of eight from any set that can be split in two: the largest child is split until there are eight.
//! The same tree for any number of threads.

use super::Tree;
use super::node::{Child, Node, WIDTH, WideNode};
use super::nodes::Nodes;
use crate::boxes::Box32;
use crate::bvh::split::LeafModel;
use crate::cull::CullBounds;
use crate::leaf::{BLOCK, NO_PRIMITIVE};
use arrayvec::ArrayVec;

/// Larger sets are split among threads.
const PARALLEL: usize = 4096;

/// Leaves are up to four blocks; a block costs about as much as a node.
pub(super) const LEAF: LeafModel = LeafModel {
    max_size: Child::MAX_LEAF,
    node_cost: 1.0,
    block_cost: 1.0,
    block_log: BLOCK.ilog2(),
};

/// The same in a node with free places, where further boxes cost nothing.
const WITHIN: LeafModel = LeafModel {
    node_cost: 0.0,
    ..LEAF
};

/// Primitives that will become a child; at least one.
pub(super) trait Subtree: Sized + Send {
    /// Working memory of one thread.
    type Scratch: Default + Send;

    /// The bounds of their boxes.
    fn bounds(&self) -> &Box32;

    /// The number of primitives.
    fn count(&self) -> usize;

    /// Splits them, or returns them if they are a leaf by this model.
    ///
    /// The number of splits on the way from the root must not exceed the levels of the traversal's stack.
    fn split(self, leaf: &LeafModel, scratch: &mut Self::Scratch) -> Result<[Self; 2], Self>;

    /// The class of the primitives of a leaf.
    fn class(&self) -> u8;

    /// Adds the numbers of the primitives to a list.
    fn ids(&self, into: &mut Vec<u32>);
}

impl Tree {
    /// The tree over a set.
    pub(super) fn grow<S: Subtree>(all: S) -> Self {
        let bounds = CullBounds::new(all.bounds().to_aabb());
        let mut parts = Parts::<S>::new();
        // Memory that is reserved but never used costs nothing.
        parts.nodes.reserve(all.count() / 8);
        parts.slots.reserve(2 * all.count());
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

/// A set that will become a child, with half its surface area.
struct Open<S> {
    set: S,
    area: f64,
    /// Whether it can't be split.
    leaf: bool,
}

impl<S: Subtree> Open<S> {
    fn new(set: S, leaf: bool) -> Self {
        let area = set.bounds().half_area();
        Self { set, area, leaf }
    }
}

/// A tree under construction. Depth first, the children with the largest boxes first, the order in which rays probably visit
/// it.
struct Parts<S: Subtree> {
    nodes: Vec<Node>,
    slots: Vec<u32>,
    scratch: S::Scratch,
}

impl<S: Subtree> Parts<S> {
    fn new() -> Self {
        Self {
            nodes: Vec::new(),
            slots: Vec::new(),
            scratch: S::Scratch::default(),
        }
    }

    /// Adds the subtree of a set.
    fn add(&mut self, set: S) -> Child {
        match set.split(&LEAF, &mut self.scratch) {
            Err(leaf) => self.add_leaf(&leaf),
            Ok(halves) => self.add_node(halves),
        }
    }

    fn add_node(&mut self, halves: [S; 2]) -> Child {
        let total: usize = halves.iter().map(S::count).sum();
        let mut open: ArrayVec<Open<S>, WIDTH> =
            halves.into_iter().map(|s| Open::new(s, false)).collect();
        while open.len() < WIDTH {
            // The first of equal ones, so that the choice is unique.
            let inner = (0..open.len()).filter(|i| !open[*i].leaf);
            let largest = inner.reduce(|a, b| if open[b].area > open[a].area { b } else { a });
            let Some(largest) = largest else { break };
            match open
                .swap_remove(largest)
                .set
                .split(&WITHIN, &mut self.scratch)
            {
                Ok([left, right]) => {
                    open.push(Open::new(left, false));
                    open.push(Open::new(right, false));
                }
                Err(set) => open.push(Open::new(set, true)),
            }
        }
        // Large ones first: any-hit rays probably find a hit there. The sort is stable.
        let mut order: ArrayVec<usize, WIDTH> = (0..open.len()).collect();
        order.sort_by(|a, b| open[*b].area.total_cmp(&open[*a].area));
        let number = self.nodes.len();
        let mut node = Node::EMPTY;
        for (place, which) in order.iter().enumerate() {
            node.set(place, open[*which].set.bounds(), Child::default());
        }
        self.nodes.push(node);
        let mut open: ArrayVec<Option<Open<S>>, WIDTH> = open.into_iter().map(Some).collect();
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

    fn add_open(&mut self, open: Open<S>) -> Child {
        if open.leaf {
            self.add_leaf(&open.set)
        } else {
            self.add(open.set)
        }
    }

    /// Adds several subtrees in parallel, with the same result as one after the other.
    fn add_parallel(&mut self, mut sets: Vec<Open<S>>) -> Vec<Child> {
        if sets.len() == 1 {
            return sets.into_iter().map(|set| self.add_open(set)).collect();
        }
        let later = sets.split_off(sets.len() / 2);
        let mut other = Self::new();
        let (mut children, more) =
            rayon::join(|| self.add_parallel(sets), || other.add_parallel(later));
        let (nodes, blocks) = (self.nodes.len(), self.slots.len() / BLOCK);
        self.nodes.extend(other.nodes.into_iter().map(|mut node| {
            // Empty places are not counted, so that the tree is the one that a single thread builds.
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

    fn add_leaf(&mut self, set: &S) -> Child {
        let first = self.slots.len();
        set.ids(&mut self.slots);
        self.slots[first..].sort_unstable();
        // Several parts of the same primitive count once.
        let mut count = 1;
        for i in first + 1..self.slots.len() {
            if self.slots[i] != self.slots[first + count - 1] {
                self.slots[first + count] = self.slots[i];
                count += 1;
            }
        }
        self.slots.truncate(first + count);
        self.slots
            .resize(self.slots.len().next_multiple_of(BLOCK), NO_PRIMITIVE);
        Child::leaf(first / BLOCK, set.class(), count)
    }
}
