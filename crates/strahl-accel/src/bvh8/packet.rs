//! Packets of rays: what a node's boxes look like to all of them at once.
//!
//! Rays that go in the same octant of directions are walked together. A node is looked at twice: all its children with intervals that
//! hold the constants of all rays, then each child that is left with all rays side by side. Where a single ray is left, it goes on by itself.
//!
//! S. Boulos, I. Wald, P. Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray Packets" (2006); I. Wald et al.,
//! "Embree: A Kernel Framework for Efficient CPU Ray Tracing" (2014), its hybrid traversal.

use super::node::{Child, Node, Nodes, WIDTH};
use super::traverse::Slabs;
use super::{Bvh8, Tree};
use crate::bvh::MAX_DEPTH;
use crate::cull::{CullBounds, CullClock, CullStart, LONGEST_QUICK, MOST_RECIPROCAL, QUICK_SLACK};
use crate::packet::{PACKET, Packet, PacketVisitor, lanes_of};
use crate::traversal::Leaf;
use crate::{TraversalStats, Visitor};
use arrayvec::ArrayVec;
use strahl_math::Interval;
use strahl_simd::{Isa, Lanes16, dispatch};

impl Bvh8 {
    /// Walks the hierarchy with all rays of a packet; `false` if it does so with single rays only, as a compact one.
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
        for id in self.unbounded.ids() {
            for lane in 0..packet.rays.len().min(PACKET) {
                let t_max = &mut packet.t_max[lane];
                if *t_max > f64::NEG_INFINITY {
                    *t_max = visitor.visit(*id, lane, *t_max);
                    stats.primitive_tests += 1;
                }
            }
        }
        if let Some((tree, nodes)) = tree {
            dispatch!(self.simd, isa => tree.walk_octants(isa, nodes, packet, visitor, stats));
        }
        true
    }
}

/// All lanes, as bits.
const ALL: u32 = (1 << PACKET) - 1;

/// The constants of the culling test by lane.
struct Lanes {
    rd: [Lanes16; 3],
    minus_near: [Lanes16; 3],
    minus_far: [Lanes16; 3],
    t_min: Lanes16,
    /// The upper ends of the ranges.
    far: Lanes16,
    clocks: [CullClock; PACKET],
}

/// What no lane's constants are beyond.
#[derive(Clone, Copy)]
struct Hull {
    rd: [[f32; 2]; 3],
    /// What is added for planes relative to the hull's point.
    shift: [[f32; 2]; 3],
    t_min: f32,
}

impl Hull {
    const NOTHING: Self = Self {
        rd: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
        shift: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
        t_min: f32::INFINITY,
    };

    #[inline(always)]
    fn grow(&mut self, rd: &[f32; 4], shift: &[[f32; 4]; 2], t_min: f32) {
        for axis in 0..3 {
            grow(&mut self.rd[axis], rd[axis], rd[axis]);
            grow(&mut self.shift[axis], shift[0][axis], shift[1][axis]);
        }
        self.t_min = self.t_min.min(t_min);
    }
}

#[inline(always)]
fn grow(range: &mut [f32; 2], low: f32, high: f32) {
    range[0] = if low < range[0] { low } else { range[0] };
    range[1] = if high > range[1] { high } else { range[1] };
}

/// The directions that rays go in, axis by axis: as bits for those along which they go down.
const OCTANTS: usize = 8;

impl Tree {
    /// Walks the tree with those rays together that go in the same octant.
    #[inline(always)]
    fn walk_octants<I: Isa, V: PacketVisitor>(
        &self,
        isa: I,
        nodes: &[Node],
        packet: &mut Packet<'_>,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let count = packet.rays.len().min(PACKET);
        let Some(first) = packet.rays.first() else {
            return;
        };
        let nothing = Lanes16([0.0; PACKET]);
        let mut lanes = Lanes {
            rd: [nothing; 3],
            minus_near: [nothing; 3],
            minus_far: [nothing; 3],
            t_min: nothing,
            far: Lanes16([f32::NEG_INFINITY; PACKET]),
            clocks: [CullClock::UNUSED; PACKET],
        };
        // Planes are taken relative to where rays start: then what is common to all rays does not widen the intervals.
        let o = first.origin;
        let near = o.abs().max_element() <= 4.0 * self.bounds.max_abs();
        let point = if near {
            o.as_vec3().as_dvec3()
        } else {
            self.bounds.bounds().center()
        };
        let point = point.as_vec3();
        if let Some((hull, octant)) = lanes.fill(isa, packet, &self.bounds, point.to_array()) {
            let walk = Walk {
                hull: HullSlabs::new(isa, &hull, point.to_array(), octant),
                octant,
            };
            let members = packet.alive();
            self.walk_together(
                isa, nodes, &walk, members, &mut lanes, packet, visitor, stats,
            );
            return;
        }
        let reference = [
            f64::from(point.x),
            f64::from(point.y),
            f64::from(point.z),
            0.0,
        ];
        let mut hulls = [Hull::NOTHING; OCTANTS];
        let mut members = [0u32; OCTANTS];
        for (lane, ray) in packet.rays[..count].iter().enumerate() {
            let range = Interval::new(packet.min, packet.t_max[lane]);
            if range.max == f64::NEG_INFINITY {
                continue;
            }
            let Some(start) = CullStart::new(ray, range, &self.bounds) else {
                continue;
            };
            let constants = start.lanes(isa);
            let shift = start.relative_to(isa, &reference);
            let t_min = start.clock.t_min(range.min);
            for axis in 0..3 {
                lanes.rd[axis].0[lane] = constants.rd[axis];
                lanes.minus_near[axis].0[lane] = constants.minus_near[axis];
                lanes.minus_far[axis].0[lane] = constants.minus_far[axis];
            }
            lanes.t_min.0[lane] = t_min;
            lanes.far.0[lane] = start.clock.t_max(range.max);
            lanes.clocks[lane] = start.clock;
            let octant = constants.down as usize % OCTANTS;
            hulls[octant].grow(&constants.rd, &shift, t_min);
            members[octant] |= 1 << lane;
        }
        let point = point.to_array();
        for octant in 0..OCTANTS {
            if members[octant] != 0 {
                let walk = Walk {
                    hull: HullSlabs::new(isa, &hulls[octant], point, octant),
                    octant,
                };
                self.walk_together(
                    isa,
                    nodes,
                    &walk,
                    members[octant],
                    &mut lanes,
                    packet,
                    visitor,
                    stats,
                );
            }
        }
    }

    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "inlined into its only caller")]
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
        let first = walk.first();
        let mut farthest = lanes.farthest(members);
        let mut alive = members;
        let mut stack = ArrayVec::<Waiting, { MAX_DEPTH * (WIDTH - 1) + 1 }>::new();
        let (mut current, mut mask) = (self.root, members);
        let mut cost = TraversalStats::default();
        'walk: loop {
            if mask & mask.wrapping_sub(1) == 0 && !current.is_leaf() {
                let lane = mask.trailing_zeros() as usize % PACKET;
                let slabs = lanes.slabs(isa, lane, walk.octant);
                let range = Interval::new(packet.min, packet.t_max[lane]);
                let mut one = One {
                    visitor: &mut *visitor,
                    lane,
                };
                let t_max = self.walk_from(
                    isa,
                    nodes,
                    current,
                    &slabs,
                    lanes.clocks[lane],
                    &packet.rays[lane],
                    range,
                    &mut one,
                    &mut cost,
                );
                packet.t_max[lane] = t_max;
                if t_max < range.max {
                    lanes.lower(lane, t_max);
                    farthest = lanes.farthest(members);
                    if t_max == f64::NEG_INFINITY {
                        alive &= !mask;
                    }
                }
            } else if !current.is_leaf() {
                cost.node_visits += u64::from(mask.count_ones());
                let node = &nodes[current.node()];
                let (keys, mut candidates) = walk.hull.enter(isa, node, farthest);
                let keys = isa.store_f32(keys).0;
                let bottom = stack.len();
                while candidates != 0 {
                    let child = candidates.trailing_zeros() as usize % WIDTH;
                    candidates &= candidates - 1;
                    let met = lanes.enter(isa, node, child, first) & mask;
                    if met != 0 {
                        stack.push(Waiting {
                            near: keys[child],
                            child: node.children[child],
                            lanes: met,
                        });
                    }
                }
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
                    if packet.t_max[lane] < before[lane] {
                        changed = true;
                        lanes.lower(lane, packet.t_max[lane]);
                        if packet.t_max[lane] == f64::NEG_INFINITY {
                            alive &= !(1 << lane);
                        }
                    }
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
}

/// A child to visit with some of the rays.
#[derive(Clone, Copy)]
struct Waiting {
    /// None of the rays gets there sooner.
    near: f32,
    child: Child,
    lanes: u32,
}

/// Sorts a few, the nearest last.
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

/// What the rays of one octant have in common.
struct Walk<I: Isa> {
    hull: HullSlabs<I>,
    octant: usize,
}

impl<I: Isa> Walk<I> {
    /// Per axis which of the two planes the rays meet first.
    #[inline(always)]
    fn first(&self) -> [usize; 3] {
        [self.octant & 1, self.octant >> 1 & 1, self.octant >> 2 & 1]
    }
}

/// Both ends of a range in vectors.
#[inline(always)]
fn pair<I: Isa>(isa: I, [low, high]: [f32; 2]) -> [I::F32x8; 2] {
    [isa.splat_f32(low), isa.splat_f32(high)]
}

/// The constants of a hull in vectors.
struct HullSlabs<I: Isa> {
    point: [I::F32x8; 3],
    rd: [[I::F32x8; 2]; 3],
    shift: [[I::F32x8; 2]; 3],
    t_min: I::F32x8,
    first: [usize; 3],
}

impl<I: Isa> HullSlabs<I> {
    #[inline(always)]
    fn new(isa: I, hull: &Hull, point: [f32; 3], octant: usize) -> Self {
        let ([rx, ry, rz], [sx, sy, sz]) = (hull.rd, hull.shift);
        Self {
            point: [
                isa.splat_f32(point[0]),
                isa.splat_f32(point[1]),
                isa.splat_f32(point[2]),
            ],
            rd: [pair(isa, rx), pair(isa, ry), pair(isa, rz)],
            shift: [pair(isa, sx), pair(isa, sy), pair(isa, sz)],
            t_min: isa.splat_f32(hull.t_min),
            first: [octant & 1, octant >> 1 & 1, octant >> 2 & 1],
        }
    }

    /// No ray crosses the planes of an axis that it meets first sooner.
    #[inline(always)]
    fn near(&self, isa: I, node: &Node, k: usize) -> I::F32x8 {
        let planes = isa.load_f32(&node.planes[2 * k + self.first[k]]);
        let q = isa.sub_f32(planes, self.point[k]);
        let [low, high] = self.rd[k];
        isa.min_f32(
            isa.mul_add(q, low, self.shift[k][0]),
            isa.mul_add(q, high, self.shift[k][0]),
        )
    }

    /// No ray crosses the planes of an axis that it meets last later.
    #[inline(always)]
    fn far(&self, isa: I, node: &Node, k: usize) -> I::F32x8 {
        let planes = isa.load_f32(&node.planes[2 * k + 1 - self.first[k]]);
        let q = isa.sub_f32(planes, self.point[k]);
        let [low, high] = self.rd[k];
        isa.max_f32(
            isa.mul_add(q, low, self.shift[k][1]),
            isa.mul_add(q, high, self.shift[k][1]),
        )
    }

    /// Where a ray enters the children's boxes at the soonest, and which of them a ray may meet.
    #[inline(always)]
    fn enter(&self, isa: I, node: &Node, farthest: f32) -> (I::F32x8, u32) {
        let (x, y, z) = (
            self.near(isa, node, 0),
            self.near(isa, node, 1),
            self.near(isa, node, 2),
        );
        let enter = isa.max_f32(isa.max_f32(x, y), isa.max_f32(z, self.t_min));
        let (x, y, z) = (
            self.far(isa, node, 0),
            self.far(isa, node, 1),
            self.far(isa, node, 2),
        );
        let farthest = isa.splat_f32(farthest);
        let leave = isa.min_f32(isa.min_f32(x, y), isa.min_f32(z, farthest));
        (enter, isa.le_f32(enter, leave))
    }
}

/// The factor 20u of the error bound of constants relative to a point.
const RELATIVE_SLACK: f64 = 20.0 / (1u64 << 24) as f64;

impl Lanes {
    /// Makes the constants of all rays at once, side by side in f32, if all are ordinary and go in the same octant; returns their hull and
    /// that octant.
    ///
    /// They are those of [`crate::cull::QuickLanes`], where the error bound is derived. Planes relative to a point f are crossed at
    /// `(b - f) r + (f - o) r`. In units of u|r| rounding changes the first product by at most 5|b - f| with what the loop adds, the second by
    /// 6|f - o| and, for o, |o|: together by less than 5B + 7|o| + 11|f|, for which 20(B + |o| + |f|) has room.
    #[inline(always)]
    fn fill<I: Isa>(
        &mut self,
        isa: I,
        packet: &Packet<'_>,
        bounds: &CullBounds,
        point: [f32; 3],
    ) -> Option<(Hull, usize)> {
        let first = packet.rays.get(packet.alive().trailing_zeros() as usize)?;
        let nothing = Lanes16([0.0; PACKET]);
        let (mut origins, mut directions) = ([nothing; 3], [nothing; 3]);
        let plain = CullClock::UNUSED;
        for lane in 0..PACKET {
            // Lanes without a ray repeat one: they change no hull.
            let t_max = packet.t_max[lane];
            let ray = match packet.rays.get(lane) {
                Some(ray) if t_max > f64::NEG_INFINITY => {
                    self.far.0[lane] = plain.t_max(t_max);
                    ray
                }
                _ => first,
            };
            for axis in 0..3 {
                origins[axis].0[lane] = ray.origin[axis] as f32;
                directions[axis].0[lane] = ray.direction[axis] as f32;
            }
        }
        let near = isa.splat_f32x16(bounds.near());
        let (longest, shortest) = (
            isa.splat_f32x16(LONGEST_QUICK),
            isa.splat_f32x16(1.0 / LONGEST_QUICK),
        );
        let (mut usable, mut long) = (ALL, 0);
        for axis in 0..3 {
            let distance = isa.abs_f32x16(isa.load_f32x16(&origins[axis]));
            let length = isa.abs_f32x16(isa.load_f32x16(&directions[axis]));
            usable &= isa.le_f32x16(distance, near) & isa.le_f32x16(length, longest);
            long |= isa.le_f32x16(shortest, length);
        }
        if usable & long != ALL {
            return None;
        }
        let (zero, one) = (isa.splat_f32x16(0.0), isa.splat_f32x16(1.0));
        let most = isa.splat_f32x16(MOST_RECIPROCAL as f32);
        let least = isa.sub_f32x16(zero, most);
        let slack = isa.splat_f32x16(QUICK_SLACK as f32);
        let relative_slack = isa.splat_f32x16(RELATIVE_SLACK as f32);
        let margin = isa.splat_f32x16(bounds.margin());
        let t_min = plain.t_min(packet.min);
        let mut hull = Hull {
            t_min,
            ..Hull::NOTHING
        };
        let mut octant = 0;
        for axis in 0..3 {
            let o = isa.load_f32x16(&origins[axis]);
            let r = isa.div_f32x16(one, isa.load_f32x16(&directions[axis]));
            let r = isa.max_f32x16(isa.min_f32x16(r, most), least);
            match isa.lt_f32x16(r, zero) {
                0 => {}
                ALL => octant |= 1 << axis,
                _ => return None,
            }
            let (size, distance) = (isa.abs_f32x16(r), isa.abs_f32x16(o));
            let reach = isa.mul_add_f32x16(distance, slack, margin);
            let e = isa.mul_f32x16(size, reach);
            let minus_o = isa.sub_f32x16(zero, o);
            self.rd[axis] = isa.store_f32x16(r);
            self.minus_near[axis] = isa.store_f32x16(isa.mul_sub_f32x16(minus_o, r, e));
            self.minus_far[axis] = isa.store_f32x16(isa.mul_add_f32x16(minus_o, r, e));
            let f = point[axis];
            let rest = RELATIVE_SLACK * (bounds.max_abs() + f64::from(f.abs()));
            let reach = isa.mul_add_f32x16(distance, relative_slack, isa.splat_f32x16(rest as f32));
            let e = isa.mul_f32x16(size, reach);
            let way = isa.sub_f32x16(isa.splat_f32x16(f), o);
            hull.rd[axis] = [isa.smallest_f32x16(r), isa.largest_f32x16(r)];
            hull.shift[axis] = [
                isa.smallest_f32x16(isa.mul_sub_f32x16(way, r, e)),
                isa.largest_f32x16(isa.mul_add_f32x16(way, r, e)),
            ];
        }
        self.t_min = Lanes16([t_min; PACKET]);
        Some((hull, octant))
    }

    /// Which rays may meet the box of a child.
    #[inline(always)]
    fn enter<I: Isa>(&self, isa: I, node: &Node, child: usize, first: [usize; 3]) -> u32 {
        let [x, y, z] = [
            self.crossed(isa, node, child, 0, first[0], &self.minus_near),
            self.crossed(isa, node, child, 1, 2 + first[1], &self.minus_near),
            self.crossed(isa, node, child, 2, 4 + first[2], &self.minus_near),
        ];
        let t_min = isa.load_f32x16(&self.t_min);
        let enter = isa.max_f32x16(isa.max_f32x16(x, y), isa.max_f32x16(z, t_min));
        let [x, y, z] = [
            self.crossed(isa, node, child, 0, 1 - first[0], &self.minus_far),
            self.crossed(isa, node, child, 1, 3 - first[1], &self.minus_far),
            self.crossed(isa, node, child, 2, 5 - first[2], &self.minus_far),
        ];
        let far = isa.load_f32x16(&self.far);
        let leave = isa.min_f32x16(isa.min_f32x16(x, y), isa.min_f32x16(z, far));
        isa.le_f32x16(enter, leave)
    }

    /// Where the rays cross a plane of a child.
    #[inline(always)]
    fn crossed<I: Isa>(
        &self,
        isa: I,
        node: &Node,
        child: usize,
        axis: usize,
        plane: usize,
        shift: &[Lanes16; 3],
    ) -> I::F32x16 {
        let plane = isa.splat_f32x16(node.planes[plane].0[child]);
        let rd = isa.load_f32x16(&self.rd[axis]);
        isa.mul_add_f32x16(plane, rd, isa.load_f32x16(&shift[axis]))
    }

    /// The constants of a single ray.
    #[inline(always)]
    fn slabs<I: Isa>(&self, isa: I, lane: usize, octant: usize) -> Slabs<I> {
        Slabs::of(
            isa,
            of_lane(&self.rd, lane),
            of_lane(&self.minus_near, lane),
            of_lane(&self.minus_far, lane),
            octant as u32,
            self.t_min.0[lane],
        )
    }

    /// A hit was found: nothing behind it is of interest.
    #[inline(always)]
    fn lower(&mut self, lane: usize, t_max: f64) {
        let far = if t_max == f64::NEG_INFINITY {
            f32::NEG_INFINITY
        } else {
            self.clocks[lane].t_max(t_max)
        };
        self.far.0[lane] = far;
    }

    /// The last parameter that any of some rays is interested in.
    #[inline(always)]
    fn farthest(&self, lanes: u32) -> f32 {
        lanes_of(lanes).fold(f32::NEG_INFINITY, |most, lane| {
            let far = self.far.0[lane];
            if far > most { far } else { most }
        })
    }
}

/// The numbers of one lane.
#[inline(always)]
fn of_lane(axes: &[Lanes16; 3], lane: usize) -> [f32; 4] {
    [axes[0].0[lane], axes[1].0[lane], axes[2].0[lane], 0.0]
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
