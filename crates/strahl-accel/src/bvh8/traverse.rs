use super::compact::CompactNode;
use super::node::{Child, WIDTH, WideNode};
use super::nodes::Nodes;
use super::{Bvh8, Tree};
use crate::bvh::MAX_DEPTH;
use crate::bvh::watch::BoxTree;
use crate::cull::{CullClock, CullLanes, QuickLanes};
use crate::leaf::Leaf;
use crate::list::visit_all;
use crate::{Accelerator, Beam, Packet, PacketVisitor, TraversalStats, Visitor};
use arrayvec::ArrayVec;
use strahl_math::{Interval, Ray};
use strahl_simd::{Isa, Portable, dispatch};

/// Children still to visit: of each level at most all but one.
type Stack = ArrayVec<Waiting, { MAX_DEPTH * (WIDTH - 1) }>;

/// A child to visit, with the parameter at which the ray enters it in the upper half: smaller numbers come first. A single
/// number can be compared and moved without a branch.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting(i64);

impl Waiting {
    /// `near` is at least 0, or negative and so close to it that the order does not matter.
    #[inline(always)]
    fn new(child: Child, near: f32) -> Self {
        Self((i64::from(near.to_bits()) << 32) | i64::from(child.bits()))
    }

    #[inline(always)]
    fn near(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child::from_bits(self.0 as u32)
    }
}

impl Accelerator for Bvh8 {
    fn name(&self) -> &'static str {
        "bvh"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let t_max = visit_all(self.apart.ids(), range.max, visitor, stats);
        if t_max > f64::NEG_INFINITY
            && let Some(tree) = &self.tree
        {
            let range = range.with_max(t_max);
            if V::WATCHES {
                // Whoever watches every step doesn't need them fast.
                tree.walk(Portable, ray, range, visitor, stats);
                return;
            }
            dispatch!(self.simd, isa => tree.walk(isa, ray, range, visitor, stats));
        }
    }

    fn traverse_packet<V: PacketVisitor>(
        &self,
        packet: &mut Packet<'_>,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) -> bool {
        self.walk_packet(packet, visitor, stats)
    }

    fn misses(&self, beam: &Beam) -> bool {
        self.beam_misses(beam)
    }

    fn slots(&self) -> &[u32] {
        self.tree.as_ref().map_or(&[], |t| &t.slots)
    }

    fn bytes(&self) -> usize {
        let tree = self
            .tree
            .as_ref()
            .map_or(0, |t| t.nodes.bytes() + size_of_val(t.slots.as_slice()));
        tree + self.apart.bytes()
    }

    fn nodes(&self) -> usize {
        self.tree.as_ref().map_or(0, |t| t.nodes.len())
    }

    fn references(&self) -> usize {
        let used = self.slots().iter().filter(|id| **id != crate::NO_PRIMITIVE);
        used.count() + self.apart.references()
    }
}

impl Bvh8 {
    /// [`Accelerator::traverse`] for callers that are already inside of [`Isa::call`] with the instructions of [`Bvh8::simd`].
    /// Primitives that are in no leaf (see [`Bvh8::has_leaves_only`]) are not visited.
    #[inline(always)]
    pub fn traverse_leaves<I: Isa, V: Visitor>(
        &self,
        isa: I,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        if let Some(tree) = &self.tree {
            tree.walk_tree(isa, ray, range, visitor, stats);
        }
    }
}

/// The constants of the culling test in vectors.
pub(super) struct Slabs<I: Isa> {
    rd: [I::F32x8; 3],
    minus_near: [I::F32x8; 3],
    minus_far: [I::F32x8; 3],
    /// Per axis which of the two planes the ray crosses first.
    first: [usize; 3],
    t_min: I::F32x8,
}

/// The first three lanes, each in a vector of its own.
#[inline(always)]
fn spread<I: Isa>(isa: I, v: I::F32x8) -> [I::F32x8; 3] {
    [isa.spread::<0>(v), isa.spread::<1>(v), isa.spread::<2>(v)]
}

/// Three numbers, each in a vector of its own.
#[inline(always)]
fn splats<I: Isa>(isa: I, [x, y, z, _]: [f32; 4]) -> [I::F32x8; 3] {
    [isa.splat_f32(x), isa.splat_f32(y), isa.splat_f32(z)]
}

/// Per axis which of two planes is crossed first.
#[inline(always)]
pub(super) fn sides(down: u32) -> [usize; 3] {
    [
        (down & 1) as usize,
        (down >> 1 & 1) as usize,
        (down >> 2 & 1) as usize,
    ]
}

impl<I: Isa> Slabs<I> {
    #[inline(always)]
    fn new(isa: I, lanes: &QuickLanes<I>, t_min: f64) -> Self {
        let QuickLanes {
            rd,
            minus_near: near,
            minus_far: far,
            down,
            clock,
        } = lanes;
        Self {
            rd: spread(isa, *rd),
            minus_near: spread(isa, *near),
            minus_far: spread(isa, *far),
            first: sides(*down),
            t_min: isa.splat_f32(clock.t_min(t_min)),
        }
    }

    /// From the constants of a ray by axis; `t_min` in the units of the culling test.
    #[inline(always)]
    pub(super) fn of(isa: I, lanes: &CullLanes, t_min: f32) -> Self {
        Self {
            rd: splats(isa, lanes.rd),
            minus_near: splats(isa, lanes.minus_near),
            minus_far: splats(isa, lanes.minus_far),
            first: sides(lanes.down),
            t_min: isa.splat_f32(t_min),
        }
    }

    /// The parameters at which the ray crosses the first planes of an axis.
    #[inline(always)]
    fn near(&self, isa: I, node: &impl WideNode, k: usize) -> I::F32x8 {
        let planes = node.planes(isa, k, self.first[k]);
        isa.mul_add(planes, self.rd[k], self.minus_near[k])
    }

    /// The parameters at which the ray crosses the last planes of an axis.
    #[inline(always)]
    fn far(&self, isa: I, node: &impl WideNode, k: usize) -> I::F32x8 {
        let planes = node.planes(isa, k, 1 - self.first[k]);
        isa.mul_add(planes, self.rd[k], self.minus_far[k])
    }

    /// The parameters at which the ray enters the children's boxes, and the children that it may meet.
    #[inline(always)]
    fn enter(&self, isa: I, node: &impl WideNode, t_max: I::F32x8) -> (I::F32x8, u32) {
        let (x, y, z) = (
            self.near(isa, node, 0),
            self.near(isa, node, 1),
            self.near(isa, node, 2),
        );
        let enter = isa.max_bits(isa.max_bits(x, y), isa.max_bits(z, self.t_min));
        let (x, y, z) = (
            self.far(isa, node, 0),
            self.far(isa, node, 1),
            self.far(isa, node, 2),
        );
        let leave = isa.min_bits(isa.min_bits(x, y), isa.min_bits(z, t_max));
        (enter, isa.le_f32(enter, leave) & node.used())
    }
}

impl Tree {
    /// Traverses the tree, nearer children first.
    #[inline(always)]
    fn walk<I: Isa, V: Visitor>(
        &self,
        isa: I,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        if self.root.is_block() && !V::WATCHES {
            // Testing their box would cost as much.
            let leaf = self.leaf(self.root);
            stats.primitive_tests += leaf.count as u64;
            visitor.visit_leaf(isa, &leaf, range.max);
            return;
        }
        self.walk_tree(isa, ray, range, visitor, stats);
    }

    /// The same for any root.
    #[inline(always)]
    fn walk_tree<I: Isa, V: Visitor>(
        &self,
        isa: I,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        match &self.nodes {
            Nodes::Full(nodes) => self.walk_nodes(isa, nodes, ray, range, visitor, stats),
            Nodes::Compact(nodes) => self.walk_compact(isa, nodes, ray, range, visitor, stats),
        }
    }

    #[inline(always)]
    fn walk_nodes<I: Isa, N: WideNode, V: Visitor>(
        &self,
        isa: I,
        nodes: &[N],
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let Some(lanes) = QuickLanes::new(isa, ray, range, &self.bounds) else {
            return;
        };
        let (slabs, clock) = (Slabs::new(isa, &lanes, range.min), lanes.clock);
        let root = self.root;
        self.walk_from(isa, nodes, root, &slabs, clock, ray, range, visitor, stats);
    }

    /// A separate function: two such loops in one would compete for registers.
    #[cold]
    #[inline(never)]
    fn walk_compact<I: Isa, V: Visitor>(
        &self,
        isa: I,
        nodes: &[CompactNode],
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        isa.call(
            #[inline(always)]
            || self.walk_nodes(isa, nodes, ray, range, visitor, stats),
        );
    }

    /// The leaf that a child stands for.
    #[inline(always)]
    pub(super) fn leaf(&self, child: Child) -> Leaf<'_> {
        let parts = child.parts();
        Leaf {
            class: parts.class,
            first_block: parts.first_block,
            count: parts.count,
            slots: &self.slots,
        }
    }

    /// Traverses a subtree, nearer children first; returns the upper end of the range as the visitor left it.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "the inner loop, inlined into its two callers"
    )]
    pub(super) fn walk_from<I: Isa, N: WideNode, V: Visitor>(
        &self,
        isa: I,
        nodes: &[N],
        subtree: Child,
        slabs: &Slabs<I>,
        clock: CullClock,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) -> f64 {
        let mut t_max = range.max;
        let mut far = clock.t_max(t_max);
        let mut far_lanes = isa.splat_f32(far);
        let mut stack = Stack::new();
        let mut current = subtree;
        let mut cost = TraversalStats::default();
        'walk: loop {
            if V::WATCHES {
                self.report(ray, range.with_max(t_max), current, visitor);
            }
            if !current.is_leaf() {
                cost.node_visits += 1;
                let node = &nodes[current.node()];
                let (near, mut hit) = slabs.enter(isa, node, far_lanes);
                // Branches rather than arithmetic on masks: the processor speculates on the likely child before the test is
                // done.
                if hit != 0 {
                    let first = hit.trailing_zeros() as usize;
                    hit &= hit - 1;
                    if hit == 0 {
                        current = node.child(first);
                        continue;
                    }
                    if V::ANY {
                        // In stored order, the largest first: it is unknown which of them are hit.
                        while hit != 0 {
                            let last = 31 - hit.leading_zeros() as usize;
                            hit ^= 1 << last;
                            stack.push(Waiting::new(node.child(last), 0.0));
                        }
                        current = node.child(first);
                        continue;
                    }
                    let near = isa.store_f32(near).0;
                    current = nearest_of(
                        #[inline(always)]
                        |i| Waiting::new(node.child(i), near[i]),
                        first,
                        hit,
                        &mut stack,
                        #[inline(always)]
                        |child| fetch_ahead(isa, nodes, visitor, child),
                    );
                    continue;
                }
            } else {
                let leaf = self.leaf(current);
                cost.primitive_tests += leaf.count as u64;
                let closest = visitor.visit_leaf(isa, &leaf, t_max);
                if closest < t_max {
                    t_max = closest;
                    if closest == f64::NEG_INFINITY {
                        break;
                    }
                    far = clock.t_max(t_max);
                    far_lanes = isa.splat_f32(far);
                }
            }
            // A box that starts exactly at the closest hit is still visited: ids decide ties.
            loop {
                let Some(next) = stack.pop() else {
                    break 'walk;
                };
                if V::ANY || next.near() <= far {
                    current = next.child();
                    break;
                }
            }
        }
        *stats += cost;
        t_max
    }
}

/// The nearest of two or more children, `first` and those whose bits are set in `others`. The others go on the stack, the nearest of them on top.
#[inline(always)]
fn nearest_of(
    waiting: impl Fn(usize) -> Waiting,
    first: usize,
    mut others: u32,
    stack: &mut Stack,
    fetch: impl Fn(Child),
) -> Child {
    let a = waiting(first);
    let b = waiting(others.trailing_zeros() as usize);
    others &= others - 1;
    let (mut nearest, other) = if b < a { (b, a) } else { (a, b) };
    fetch(other.child());
    let bottom = stack.len();
    stack.push(other);
    if others == 0 {
        return nearest.child();
    }
    while others != 0 {
        let next = waiting(others.trailing_zeros() as usize);
        others &= others - 1;
        let later;
        (nearest, later) = if next < nearest {
            (next, nearest)
        } else {
            (nearest, next)
        };
        fetch(later.child());
        stack.push(later);
    }
    farthest_first(&mut stack[bottom..]);
    nearest.child()
}

/// Prefetches the memory of a child that will be visited later. Without a branch on its kind, which would be hard to predict.
#[inline(always)]
fn fetch_ahead<I: Isa, N, V: Visitor>(isa: I, nodes: &[N], visitor: &V, child: Child) {
    let node: *const u8 = nodes.as_ptr().wrapping_add(child.node()).cast();
    let block = visitor.block_address(child.parts().first_block);
    let address = if child.is_leaf() { block } else { node };
    isa.prefetch(address);
    isa.prefetch(address.wrapping_add(64));
    isa.prefetch(address.wrapping_add(128));
}

/// Sorts a few children, the farthest first.
#[inline(always)]
fn farthest_first(list: &mut [Waiting]) {
    for i in 1..list.len() {
        let item = list[i];
        let mut j = i;
        while j > 0 && list[j - 1] < item {
            list[j] = list[j - 1];
            j -= 1;
        }
        list[j] = item;
    }
}
