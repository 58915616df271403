//! Packets of rays: traversal with all rays of a packet at once.
//!
//! Rays in the same octant of directions are traversed together. A node is tested in two steps: all its children against
//! intervals that contain the constants of all rays (`hull`), then each remaining child against all rays side by side
//! (`lanes`). Rays of which too few are left together continue as single rays. The traversal itself is here.
//!
//! S. Boulos, I. Wald, P. Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray Packets" (2006); I. Wald et al.,
//! "Embree: A Kernel Framework for Efficient CPU Ray Tracing" (2014), its hybrid traversal.

mod hull;
mod lanes;

use super::node::{Child, Node, WIDTH};
use super::nodes::Nodes;
use super::{Bvh8, Tree};
use crate::bvh::MAX_DEPTH;
use crate::cull::{CullStart, NEAR};
use crate::leaf::Leaf;
use crate::packet::{PACKET, Packet, PacketVisitor, lanes_of};
use crate::{TraversalStats, Visitor};
use arrayvec::ArrayVec;
use hull::{Hull, HullSlabs};
use lanes::{Filled, Lanes};
use strahl_math::Interval;
use strahl_simd::{Isa, Portable, dispatch};

impl Bvh8 {
    /// Traverses the hierarchy with all rays of a packet; `false` if it can traverse single rays only, as a compact one.
    #[inline]
    pub(super) fn walk_packet<V: PacketVisitor>(
        &self,
        packet: &mut Packet<'_>,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) -> bool {
        let tree = match &self.tree {
            None => None,
            Some(tree) => match &tree.nodes {
                Nodes::Full(nodes) => Some((tree, nodes)),
                Nodes::Compact(_) => return false,
            },
        };
        for id in self.apart.ids() {
            let alive = packet.alive();
            visitor.visit_together(*id, alive, &mut packet.t_max);
            stats.primitive_tests += u64::from(alive.count_ones());
        }
        if let Some((tree, nodes)) = tree {
            dispatch!(self.simd, isa => tree.walk_octants(isa, nodes, packet, visitor, stats));
        }
        true
    }
}

/// Rays of several octants have little in common: when no more than so many of them are left together, they continue as single rays.
const ALONE: u32 = 4;

/// The octants of directions, numbered by bits: one for each axis along which the rays go down.
const OCTANTS: usize = 8;

impl Tree {
    /// Traverses the tree with the rays of each octant together.
    #[inline(always)]
    fn walk_octants<I: Isa, V: PacketVisitor>(
        &self,
        isa: I,
        nodes: &[Node],
        packet: &mut Packet<'_>,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let Some(first) = packet.rays.first() else {
            return;
        };
        let mut lanes = Lanes::unused();
        // Planes are taken relative to an origin, so that the common part of the rays' origins does not widen the intervals.
        let o = first.origin;
        let near = o.abs().max_element() <= NEAR * self.bounds.max_abs();
        let point = if near {
            o.as_vec3().as_dvec3()
        } else {
            self.bounds.bounds().center()
        };
        let point = point.as_vec3().to_array();
        let (mut octant, mut hull, mut members, others) =
            match lanes.fill(isa, packet, &self.bounds, point) {
                Some(Filled::Alike(hull, octant)) => (octant, hull, packet.alive(), None),
                Some(Filled::Mixed(directions)) => {
                    let octants = lanes.hulls(isa, &directions, packet.alive());
                    (0, octants.0[0], octants.1[0], Some(octants))
                }
                None => {
                    let octants = self.one_by_one(packet, point, &mut lanes);
                    (0, octants.0[0], octants.1[0], Some(octants))
                }
            };
        // The only call, because the traversal is inlined: a second one would double the program's largest functions.
        loop {
            if members != 0 {
                let walk = Walk {
                    hull: HullSlabs::new(isa, &hull, point, octant),
                    octant,
                    alone: if others.is_some() { ALONE } else { 1 },
                };
                self.walk_together(
                    isa, nodes, &walk, members, &mut lanes, packet, visitor, stats,
                );
            }
            octant += 1;
            match &others {
                Some((hulls, rays)) if octant < OCTANTS => {
                    (hull, members) = (hulls[octant], rays[octant]);
                }
                _ => return,
            }
        }
    }

    /// Sets the constants of rays of any kind, and returns by octant their hull and which they are.
    #[cold]
    #[inline(never)]
    fn one_by_one(
        &self,
        packet: &Packet<'_>,
        [x, y, z]: [f32; 3],
        lanes: &mut Lanes,
    ) -> ([Hull; OCTANTS], [u32; OCTANTS]) {
        let reference = [f64::from(x), f64::from(y), f64::from(z), 0.0];
        let mut hulls = [Hull::NOTHING; OCTANTS];
        let mut members = [0u32; OCTANTS];
        for (lane, ray) in packet.rays.iter().enumerate().take(PACKET) {
            let range = Interval::new(packet.min, packet.t_max[lane]);
            if range.max == f64::NEG_INFINITY {
                continue;
            }
            let Some(start) = CullStart::new(ray, range, &self.bounds) else {
                continue;
            };
            let constants = start.lanes(Portable);
            let shift = start.relative_to(Portable, &reference);
            let t_min = start.clock.t_min(range.min);
            lanes.set(lane, &constants, start.clock, range);
            let octant = constants.down as usize % OCTANTS;
            hulls[octant].grow(&constants.rd, &shift, t_min);
            members[octant] |= 1 << lane;
        }
        (hulls, members)
    }

    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "inlined into its caller")]
    fn walk_together<I: Isa, V: PacketVisitor>(
        &self,
        isa: I,
        nodes: &[Node],
        walk: &Walk<I>,
        members: u32,
        lanes: &mut Lanes,
        packet: &mut Packet<'_>,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let mut farthest = lanes.farthest(members);
        let mut alive = members;
        let mut stack = Stack::new();
        let (mut current, mut mask) = (self.root, members);
        let mut cost = TraversalStats::default();
        'walk: loop {
            if mask.count_ones() <= walk.alone && !current.is_leaf() {
                let mut changed = false;
                for lane in lanes_of(mask) {
                    let before = packet.t_max[lane];
                    let mut one = One {
                        visitor: &mut *visitor,
                        lane,
                    };
                    let alone = (current, walk.octant);
                    let t_max =
                        self.walk_alone(isa, nodes, alone, lanes, packet, &mut one, &mut cost);
                    packet.t_max[lane] = t_max;
                    changed |= lowered(lanes, &mut alive, lane, before, t_max);
                }
                if changed {
                    farthest = lanes.farthest(members);
                }
            } else if !current.is_leaf() {
                cost.node_visits += u64::from(mask.count_ones());
                let node = &nodes[current.node()];
                let bottom = stack.len();
                push_children(isa, node, &walk.hull, lanes, mask, farthest, &mut stack);
                if !V::ANY {
                    nearest_last(&mut stack[bottom..]);
                }
            } else {
                let leaf = self.leaf(current);
                cost.primitive_tests += leaf.count as u64 * u64::from(mask.count_ones());
                let before = packet.t_max;
                visitor.visit_leaf_together(isa, &leaf, mask, &mut packet.t_max);
                let mut changed = false;
                for lane in lanes_of(mask) {
                    let t_max = packet.t_max[lane];
                    changed |= lowered(lanes, &mut alive, lane, before[lane], t_max);
                }
                if changed {
                    farthest = lanes.farthest(members);
                }
            }
            loop {
                let Some(next) = stack.pop() else {
                    break 'walk;
                };
                mask = next.lanes & alive;
                // A box that starts exactly at the closest hit is still visited: ids decide ties.
                if mask != 0 && (V::ANY || next.near <= farthest) {
                    current = next.child;
                    break;
                }
            }
        }
        *stats += cost;
    }

    /// Traverses a subtree with a single ray. A separate function: two such loops in one would compete for registers.
    #[inline(never)]
    #[expect(
        clippy::too_many_arguments,
        reason = "the state of a loop, most of which is passed in registers"
    )]
    fn walk_alone<I: Isa, V: PacketVisitor>(
        &self,
        isa: I,
        nodes: &[Node],
        (subtree, octant): (Child, usize),
        lanes: &Lanes,
        packet: &Packet<'_>,
        one: &mut One<'_, V>,
        stats: &mut TraversalStats,
    ) -> f64 {
        isa.call(
            #[inline(always)]
            || {
                let lane = one.lane;
                let slabs = lanes.slabs(isa, lane, octant);
                let range = Interval::new(packet.min, packet.t_max[lane]);
                let (clock, ray) = (lanes.clocks[lane], &packet.rays[lane]);
                self.walk_from(isa, nodes, subtree, &slabs, clock, ray, range, one, stats)
            },
        )
    }
}

/// A child to visit with some of the rays.
#[derive(Clone, Copy)]
struct Waiting {
    /// A lower bound of the parameters at which the rays enter it.
    near: f32,
    child: Child,
    lanes: u32,
}

/// The children to visit.
type Stack = ArrayVec<Waiting, { MAX_DEPTH * (WIDTH - 1) + 1 }>;

/// Pushes the children of a node that some of the rays in `mask` may meet, each with these rays.
#[inline(always)]
fn push_children<I: Isa>(
    isa: I,
    node: &Node,
    hull: &HullSlabs<I>,
    lanes: &Lanes,
    mask: u32,
    farthest: f32,
    stack: &mut Stack,
) {
    let (keys, mut candidates) = hull.enter(isa, node, farthest);
    let keys = isa.store_f32(keys).0;
    while candidates != 0 {
        let child = candidates.trailing_zeros() as usize % WIDTH;
        candidates &= candidates - 1;
        let met = lanes.enter(isa, node, child, hull.first) & mask;
        if met != 0 {
            stack.push(Waiting {
                near: keys[child],
                child: node.children[child],
                lanes: met,
            });
        }
    }
}

/// Takes over the end of the range of a ray, and whether it is lower than before. A ray that needs no more hits leaves those that are `alive`.
#[inline(always)]
fn lowered(lanes: &mut Lanes, alive: &mut u32, lane: usize, before: f64, t_max: f64) -> bool {
    if t_max < before {
        lanes.lower(lane, t_max);
        if t_max == f64::NEG_INFINITY {
            *alive &= !(1 << lane);
        }
        return true;
    }
    false
}

/// Sorts a few children, the nearest last.
#[inline(always)]
fn nearest_last(list: &mut [Waiting]) {
    for i in 1..list.len() {
        let item = list[i];
        let mut j = i;
        while j > 0 && list[j - 1].near < item.near {
            list[j] = list[j - 1];
            j -= 1;
        }
        list[j] = item;
    }
}

/// The rays of one octant, and the constants they share.
struct Walk<I: Isa> {
    hull: HullSlabs<I>,
    octant: usize,
    /// So many rays that are left together continue as single rays.
    alone: u32,
}

/// The visitor of one ray of a packet.
struct One<'v, V> {
    visitor: &'v mut V,
    lane: usize,
}

impl<V: PacketVisitor> Visitor for One<'_, V> {
    const ANY: bool = V::ANY;

    #[inline(always)]
    fn visit_leaf<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, t_max: f64) -> f64 {
        self.visitor.visit_leaf(isa, leaf, self.lane, t_max)
    }

    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        self.visitor.visit(id, self.lane, t_max)
    }
}
