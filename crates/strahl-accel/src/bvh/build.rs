//! Builds the tree top-down, splitting by the surface area heuristic; the same tree for any number of threads.

use super::bins::Bins;
use super::node::{Child, Node};
use super::refs::{Ref, gather};
use super::split::{LeafModel, Set};
use super::{Bvh2, Tree};
use crate::List;
use crate::boxes::Box32;
use crate::cull::CullBounds;
use strahl_math::Aabb;

/// Larger sets are split among threads.
const PARALLEL: usize = 4096;

/// How to build a [`Bvh2`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// Most primitives in a leaf, at least 1.
    pub max_leaf_size: usize,
    /// The cost of visiting a primitive, in units of visiting a node: the larger, the smaller the leaves.
    ///
    /// The default fits spheres and triangles; use more for solids that are costly to intersect.
    pub primitive_cost: f64,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            max_leaf_size: 8,
            primitive_cost: 1.0,
        }
    }
}

impl Bvh2 {
    /// Builds the hierarchy over boxes `0..n`, n at most 2³¹.
    pub fn build(bounds: &[Aabb]) -> Self {
        Self::build_with(bounds, &BuildOptions::default())
    }

    /// Builds the hierarchy over boxes `0..n`, n at most 2³¹, with options. They change the speed, never an answer.
    pub fn build_with(bounds: &[Aabb], options: &BuildOptions) -> Self {
        let (mut refs, unbounded) = gather(bounds.len(), |id| (bounds[id as usize], 0));
        let bvh = Self {
            tree: (!refs.is_empty()).then(|| Tree::build(&mut refs, options)),
            unbounded: List::of(unbounded),
        };
        debug_assert_eq!(bvh.validate(bounds), Ok(()));
        bvh
    }
}

impl Tree {
    fn build(refs: &mut [Ref], options: &BuildOptions) -> Self {
        let leaf = LeafModel {
            max_size: options.max_leaf_size,
            node_cost: 1.0,
            block_cost: options.primitive_cost,
            block_log: 0,
        };
        let mut spare = refs.to_vec();
        let mut parts = Parts::new();
        parts.ids.reserve_exact(refs.len());
        let all = Set::all(refs, &mut spare);
        let bounds = CullBounds::new(all.extent.bounds.to_aabb());
        let root = parts.add(all, &leaf);
        Self {
            root,
            nodes: parts.nodes,
            ids: parts.ids,
            bounds,
        }
    }
}

/// A tree under construction. Depth first, the left child after its parent, in the order in which rays that go left visit it.
struct Parts {
    nodes: Vec<Node>,
    ids: Vec<u32>,
    bins: Bins,
}

impl Parts {
    fn new() -> Self {
        Self {
            nodes: Vec::new(),
            ids: Vec::new(),
            bins: Bins::default(),
        }
    }

    /// Adds the subtree of a set.
    fn add(&mut self, set: Set<'_>, leaf: &LeafModel) -> Child {
        let parallel = set.refs.len() > PARALLEL && rayon::current_num_threads() > 1;
        let [left, right] = match set.split(leaf, &mut self.bins) {
            Ok(halves) => halves,
            Err(set) => return self.add_leaf(set.refs),
        };
        let node = self.nodes.len();
        self.nodes.push(Node::default());
        let boxes = Box32::pair(&left.extent.bounds, &right.extent.bounds);
        let children = if parallel {
            let mut other = Self::new();
            let (first, second) = rayon::join(|| self.add(left, leaf), || other.add(right, leaf));
            [first, self.append(other, second)]
        } else {
            [self.add(left, leaf), self.add(right, leaf)]
        };
        self.nodes[node] = Node { boxes, children };
        Child::inner(node)
    }

    fn add_leaf(&mut self, refs: &[Ref]) -> Child {
        let first = self.ids.len();
        self.ids.extend(refs.iter().map(Ref::id));
        self.ids[first..].sort_unstable();
        Child {
            first: first as u32,
            count: refs.len() as u32,
        }
    }

    /// Appends another tree so that it is the same as if it had been built here, and returns its root.
    fn append(&mut self, other: Self, root: Child) -> Child {
        let (nodes, ids) = (self.nodes.len(), self.ids.len());
        self.nodes.extend(other.nodes.into_iter().map(|n| Node {
            children: n.children.map(|c| c.moved(nodes, ids)),
            ..n
        }));
        self.ids.extend(other.ids);
        root.moved(nodes, ids)
    }
}

#[cfg(test)]
mod tests {
    use super::super::MAX_DEPTH;
    use super::*;
    use strahl_math::DVec3;

    fn depth(tree: &Tree, child: Child) -> usize {
        if child.is_leaf() {
            return 0;
        }
        let below = tree.nodes[child.first as usize].children;
        1 + below.map(|c| depth(tree, c)).into_iter().max().unwrap_or(0)
    }

    /// Points at growing distances from the origin on six sides: every split separates those of one distance only.
    #[test]
    fn a_tree_that_would_be_too_deep_is_halved() {
        let boxes: Vec<Aabb> = (0..2000)
            .map(|i| {
                let mut p = DVec3::ZERO;
                p[i % 3] = [1.0, -1.0][i / 3 % 2] * 2f64.powi(63 - 5 * (i / 6 % 42) as i32);
                Aabb::new(p, p)
            })
            .collect();
        let bvh = Bvh2::build(&boxes);
        let tree = bvh.tree.as_ref().expect("bounded boxes");
        // Without the limit it would overflow the stack.
        let depth = depth(tree, tree.root);
        assert!((55..MAX_DEPTH).contains(&depth), "{depth}");
        assert_eq!(bvh.validate(&boxes), Ok(()));
    }
}
