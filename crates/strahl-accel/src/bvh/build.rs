use super::{Bvh2, Child, MAX_DEPTH, Node};
use crate::boxes::Box32;
use strahl_math::Aabb;

/// Bins per axis.
const BINS: usize = 32;
/// Cost of looking at a pair of children, in units of a primitive test.
const TRAVERSAL_COST: f64 = 1.2;
/// A leaf never holds more, unless all its primitives are in one point.
const MAX_LEAF: usize = 8;
/// Subtrees with more primitives are built in parallel.
const PARALLEL: usize = 4096;
/// From this depth on nodes are split in the middle of their list, so that 2³¹ primitives fit below it.
const MEDIAN_DEPTH: usize = MAX_DEPTH - 32;

/// A primitive while the tree is built.
#[derive(Clone, Copy)]
struct Ref {
    bounds: Box32,
    id: u32,
}

impl Ref {
    /// Twice the centre along an axis.
    #[inline]
    fn center(&self, axis: usize) -> f32 {
        self.bounds.lo[axis] + self.bounds.hi[axis]
    }
}

impl Bvh2 {
    /// Builds the hierarchy over boxes `0..n`; the result does not depend on the number of threads.
    ///
    /// I. Wald, "On fast construction of SAH-based bounding volume hierarchies" (2007).
    pub fn build(bounds: &[Aabb]) -> Self {
        let mut refs = Vec::with_capacity(bounds.len());
        let mut unbounded = Vec::new();
        for (id, b) in bounds.iter().enumerate() {
            let bounds = Box32::new(b);
            let id = id as u32;
            if b.is_bounded() && bounds.max_abs() < f64::from(f32::MAX) {
                refs.push(Ref { bounds, id });
            } else if !b.is_empty() {
                unbounded.push(id);
            }
        }
        let tree = (!refs.is_empty())
            .then(|| Subtree::build(&mut refs, 0))
            .unwrap_or_default();
        let bvh = Self {
            root: (!refs.is_empty()).then_some(tree.root),
            nodes: tree.nodes,
            ids: tree.ids,
            unbounded,
            bounds: if refs.is_empty() {
                Aabb::EMPTY
            } else {
                tree.bounds.to_f64()
            },
            max_abs: if refs.is_empty() {
                0.0
            } else {
                tree.bounds.max_abs()
            },
        };
        debug_assert_eq!(bvh.validate(bounds), Ok(()));
        bvh
    }
}

/// A tree with indices of its own; if it has nodes, its root is the first.
struct Subtree {
    bounds: Box32,
    root: Child,
    nodes: Vec<Node>,
    ids: Vec<u32>,
}

impl Default for Subtree {
    fn default() -> Self {
        Self {
            bounds: Box32::EMPTY,
            root: Child::default(),
            nodes: vec![],
            ids: vec![],
        }
    }
}

impl Subtree {
    fn build(refs: &mut [Ref], depth: usize) -> Self {
        let mut bounds = Box32::EMPTY;
        for r in refs.iter() {
            bounds.grow(&r.bounds);
        }
        let Some(middle) = split(refs, &bounds, depth) else {
            return Self::leaf(refs, bounds);
        };
        let parallel = refs.len() >= PARALLEL;
        let (left, right) = refs.split_at_mut(middle);
        let (left, right) = if parallel {
            rayon::join(
                || Self::build(left, depth + 1),
                || Self::build(right, depth + 1),
            )
        } else {
            (Self::build(left, depth + 1), Self::build(right, depth + 1))
        };
        Self::join(bounds, left, right)
    }

    fn leaf(refs: &[Ref], bounds: Box32) -> Self {
        let mut ids: Vec<u32> = refs.iter().map(|r| r.id).collect();
        ids.sort_unstable();
        Self {
            bounds,
            root: Child {
                first: 0,
                count: ids.len() as u32,
            },
            nodes: vec![],
            ids,
        }
    }

    /// The root first, then the left subtree, then the right one: depth first, as rays that go left walk it.
    fn join(bounds: Box32, left: Self, right: Self) -> Self {
        let right_node = 1 + left.nodes.len() as u32;
        let right_id = left.ids.len() as u32;
        let moved = |child: Child, nodes_by: u32, ids_by: u32| Child {
            first: child.first + if child.count == 0 { nodes_by } else { ids_by },
            ..child
        };
        let mut nodes = Vec::with_capacity(1 + left.nodes.len() + right.nodes.len());
        nodes.push(Node {
            boxes: Box32::pair(&left.bounds, &right.bounds),
            children: [
                moved(left.root, 1, 0),
                moved(right.root, right_node, right_id),
            ],
        });
        let shifted = |node: &Node, nodes_by: u32, ids_by: u32| Node {
            children: node.children.map(|c| moved(c, nodes_by, ids_by)),
            ..*node
        };
        nodes.extend(left.nodes.iter().map(|n| shifted(n, 1, 0)));
        nodes.extend(right.nodes.iter().map(|n| shifted(n, right_node, right_id)));
        let mut ids = left.ids;
        ids.extend(right.ids);
        Self {
            bounds,
            root: Child { first: 0, count: 0 },
            nodes,
            ids,
        }
    }
}

/// Reorders the list so that the left child's primitives come first, and returns their number; `None` makes a leaf.
fn split(refs: &mut [Ref], bounds: &Box32, depth: usize) -> Option<usize> {
    if refs.len() <= 1 {
        return None;
    }
    let small = refs.len() <= MAX_LEAF;
    if depth >= MEDIAN_DEPTH {
        return (!small).then_some(refs.len() / 2);
    }
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for r in refs.iter() {
        for axis in 0..3 {
            let c = r.center(axis);
            lo[axis] = if c < lo[axis] { c } else { lo[axis] };
            hi[axis] = if c > hi[axis] { c } else { hi[axis] };
        }
    }
    let best = (0..3)
        .filter_map(|axis| best_plane(refs, axis, lo[axis], hi[axis]))
        .reduce(|a, b| if b.cost < a.cost { b } else { a });
    let Some(best) = best else {
        // All centres in one point: nothing to choose by.
        return (!small).then_some(refs.len() / 2);
    };
    let area = bounds.half_area();
    let leaf_cost = refs.len() as f64 * area;
    if small && leaf_cost <= TRAVERSAL_COST * area + best.cost {
        return None;
    }
    let bin = Binning::new(lo[best.axis], hi[best.axis]);
    // Stable, so that the order of a leaf does not depend on how the memory was used.
    let (left, right): (Vec<Ref>, Vec<Ref>) = refs
        .iter()
        .partition(|r| bin.of(r.center(best.axis)) <= best.bin);
    let middle = left.len();
    refs[..middle].copy_from_slice(&left);
    refs[middle..].copy_from_slice(&right);
    Some(middle)
}

/// A way to split: everything up to and including a bin goes left.
struct Plane {
    axis: usize,
    bin: usize,
    /// Area times number of both sides.
    cost: f64,
}

struct Binning {
    lo: f32,
    scale: f32,
}

impl Binning {
    fn new(lo: f32, hi: f32) -> Self {
        Self {
            lo,
            scale: BINS as f32 * (1.0 - 1e-6) / (hi - lo),
        }
    }

    #[inline]
    fn of(&self, center: f32) -> usize {
        (((center - self.lo) * self.scale) as usize).min(BINS - 1)
    }
}

fn best_plane(refs: &[Ref], axis: usize, lo: f32, hi: f32) -> Option<Plane> {
    let binning = Binning::new(lo, hi);
    if !(hi > lo) || !binning.scale.is_finite() {
        return None;
    }
    let mut boxes = [Box32::EMPTY; BINS];
    let mut counts = [0usize; BINS];
    for r in refs {
        let bin = binning.of(r.center(axis));
        boxes[bin].grow(&r.bounds);
        counts[bin] += 1;
    }
    // Sweep from the right for the costs of all right sides, then from the left for the sums.
    let mut right_costs = [0.0; BINS];
    let (mut right, mut count) = (Box32::EMPTY, 0);
    for bin in (1..BINS).rev() {
        right.grow(&boxes[bin]);
        count += counts[bin];
        right_costs[bin - 1] = right.half_area() * count as f64;
    }
    let mut best: Option<Plane> = None;
    let (mut left, mut count) = (Box32::EMPTY, 0);
    for bin in 0..BINS - 1 {
        left.grow(&boxes[bin]);
        count += counts[bin];
        if count == 0 || count == refs.len() {
            continue;
        }
        let cost = left.half_area() * count as f64 + right_costs[bin];
        if best.as_ref().is_none_or(|b| cost < b.cost) {
            best = Some(Plane { axis, bin, cost });
        }
    }
    best
}
