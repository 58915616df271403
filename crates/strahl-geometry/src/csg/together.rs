//! Trees and the rays of a packet: leaves and boxes are tested four rays side by side, then each ray goes through the tree by itself.
//!
//! A ray is inside of a node along a few spans (Roth, "Ray casting for modeling solids", 1982); an operation combines those of its operands. As in
//! [`first`](super::first) crossings that could coincide are left to the general evaluation, so both give the same bits.

use super::Csg;
use super::leaf::Leaf;
use super::packet::FourFusing;
use super::small::Query;
use super::solid::{Kind, Node};
use super::sweep::Rule;
use super::timeline::TooClose;
use crate::blocks::LANES;
use crate::blocks::convex::{FourRays, FourSpans, GROUPS, sub};
use crate::primitives::convex::{End, Span, Stay};
use crate::{PrimHit, Scratch, Side, SurfaceId};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use strahl_accel::PACKET;
use strahl_math::{Aabb, Interval, Ray, Transform};
use strahl_simd::{Isa, Simd, dispatch};

/// The most leaves of a tree: what is known of a leaf takes some hundred bytes.
const MOST_LEAVES: usize = 32;

/// The most ends of the spans of a node; with more the search with one ray decides.
const MOST_ENDS: usize = 8;

impl Csg {
    /// Whether trees of these nodes are searched by [`PacketTree`].
    pub(super) fn goes_together(nodes: &[Node], leaves: &[Leaf]) -> bool {
        let listed = leaves.iter().filter(|leaf| leaf.is_listed()).count();
        leaves.len() <= MOST_LEAVES
            && listed * LISTED_SHARE <= leaves.len()
            && leaves
                .iter()
                .all(|leaf| leaf.has_stays() || leaf.is_listed())
            && nodes.iter().all(|node| {
                let planes = node.half_spaces.as_ref().map_or(0, |planes| planes.len());
                node.hierarchy.is_none()
                    && planes <= MOST_PLANES
                    && node.kind != Kind::Operation(Rule::Union)
            })
    }
}

/// One leaf of as many may be of a shape that lists its crossings, which takes much longer than the test of the others.
const LISTED_SHARE: usize = 4;

/// More planes of one intersection are searched faster by [`HalfSpaces`](super::half_spaces).
const MOST_PLANES: usize = 3;

/// The boxes and leaves of a tree that the rays of a packet meet.
#[derive(Clone, Debug, Default)]
pub struct PacketTree {
    /// For each node the rays, as bits, that may meet its surface. Along the others it is the same everywhere, as far away from it.
    nodes: Vec<u32>,
    leaves: Vec<[FourStays; GROUPS]>,
}

/// What is known of four lines and a leaf's shape.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FourStays {
    pub(super) spans: FourSpans,
    /// The lanes, as bits, that are outside on their span and inside everywhere else.
    pub(super) outside: u32,
}

impl FourStays {
    /// Lines that miss the shape.
    const MISSED: Self = Self {
        spans: FourSpans {
            known: 0b1111,
            only_enter: 0,
            met: 0,
            enter: [0.0; LANES],
            exit: [0.0; LANES],
            enter_facet: [0; LANES],
            exit_facet: [0; LANES],
            enter_leaf: [0; LANES],
            exit_leaf: [0; LANES],
        },
        outside: 0,
    };

    /// The same if all but these lanes miss the shape's box.
    #[inline(always)]
    fn of(mut self, lanes: u32) -> Self {
        self.spans.known |= !lanes & 0b1111;
        self.spans.met &= lanes;
        self.outside &= lanes;
        self
    }

    /// Where a line is inside of the shape, if that is known.
    #[inline(always)]
    fn stay(&self, lane: usize) -> Option<Stay> {
        let has = |lanes: u32| lanes >> lane & 1 == 1;
        let spans = &self.spans;
        has(spans.known).then(|| Stay {
            span: has(spans.met).then(|| spans.span(lane)),
            outside: has(self.outside),
        })
    }
}

/// What is asked of a packet: its rays and the ranges that matter, from `min` to the `t_max` of each lane.
#[derive(Clone, Copy, Debug)]
pub struct PacketRanges<'r> {
    /// The rays, at most [`PACKET`].
    pub rays: &'r [Ray],
    /// The beginning of all ranges.
    pub min: f64,
    /// Their ends.
    pub t_max: &'r [f64; PACKET],
    /// The rays, as bits, that start on the tree.
    pub starting: u32,
}

/// Four rays of a packet and what matters about them.
struct Four<I: Isa> {
    rays: FourRays<I>,
    slabs: FourSlabs<I>,
    /// The places of the rays that are wanted, as bits, and of those that start on the tree.
    wanted: u32,
    starting: u32,
}

impl<I: Isa> Four<I> {
    /// The rays of these lanes, at most four, in the space to which a map leads.
    #[inline(always)]
    fn of(isa: I, ranges: &PacketRanges<'_>, map: Option<&Transform>, lanes: &mut u32) -> Self {
        // The other places have the first ray, which nobody asks about.
        let first = lanes.trailing_zeros() as usize % PACKET;
        let mut rays = [&ranges.rays[first]; LANES];
        let mut ends = [f64::NEG_INFINITY; LANES];
        let (mut wanted, mut starting) = (0, 0);
        for place in 0..LANES {
            if *lanes == 0 {
                break;
            }
            let lane = lanes.trailing_zeros() as usize % PACKET;
            *lanes &= *lanes - 1;
            (rays[place], ends[place]) = (&ranges.rays[lane], ranges.t_max[lane]);
            wanted |= 1 << place;
            starting |= (ranges.starting >> lane & 1) << place;
        }
        let rays = FourRays::of(isa, rays, map);
        let slabs = FourSlabs::new(isa, &rays, ranges.min, &ends);
        Self {
            rays,
            slabs,
            wanted,
            starting,
        }
    }
}

impl PacketTree {
    /// Tests the boxes and leaves of a tree for those of the rays `lanes`, as bits, in the space to which a map leads. The first of them has place 0,
    /// the next one place 1.
    pub fn find(
        &mut self,
        csg: &Csg,
        ranges: &PacketRanges<'_>,
        map: Option<&Transform>,
        lanes: u32,
    ) {
        self.find_at(Simd::best(), csg, ranges, map, lanes);
    }

    #[inline(always)]
    pub(super) fn find_at(
        &mut self,
        simd: Simd,
        csg: &Csg,
        ranges: &PacketRanges<'_>,
        map: Option<&Transform>,
        lanes: u32,
    ) {
        self.nodes.clear();
        self.nodes.resize(csg.node_count(), 0);
        if self.leaves.len() < csg.leaves() {
            self.leaves.resize_with(csg.leaves(), Default::default);
        }
        dispatch!(simd, isa => {
            let mut left = lanes;
            for group in 0..GROUPS {
                if left != 0 {
                    let four = Four::of(isa, ranges, map, &mut left);
                    self.find_four(isa, csg, &four, group);
                }
            }
        });
    }

    /// The same for one group of four rays.
    #[inline(always)]
    fn find_four<I: Isa>(&mut self, isa: I, csg: &Csg, four: &Four<I>, group: usize) {
        let shift = group * LANES;
        for index in 0..self.nodes.len() {
            let Some(node) = csg.node(index as u32) else {
                return;
            };
            // Parents stand before their operands.
            let mut rays = match self.nodes.get(node.parent as usize) {
                Some(parent) => parent >> shift & 0b1111,
                None => four.wanted,
            };
            if rays != 0 && !node.quick {
                rays &= four.slabs.may_meet(isa, &node.bounds);
            }
            self.nodes[index] |= rays << shift;
            let Kind::Leaf(number) = node.kind else {
                continue;
            };
            let Some(leaf) = csg.leaf(number) else {
                return;
            };
            let stays = match rays {
                0 => FourStays::MISSED,
                _ => leaf.four_stays(isa, &four.rays).of(rays),
            };
            self.leaves[number as usize][group] = stays;
            // Nothing is left of an intersection outside of an operand.
            let spans = &stays.spans;
            let outside = match leaf.negative {
                true => !stays.outside,
                false => stays.outside,
            };
            let missed = spans.known & !spans.met & !outside & !four.starting;
            if let Some(parent) = csg.node(node.parent)
                && parent.kind == Kind::Operation(Rule::Intersection)
                && !parent.far
            {
                self.nodes[node.parent as usize] &= !(missed << shift);
            }
        }
    }

    /// Where the ray at a place is inside of a leaf's shape, if that is known and the ray does not start on it.
    #[inline(always)]
    pub(super) fn stay(&self, leaf: u32, place: usize) -> Option<Stay> {
        self.leaves[leaf as usize][place / LANES % GROUPS].stay(place % LANES)
    }

    /// The first hit of the ray at a place on the tree in its range, as [`Primitive::closest_hit`](crate::Primitive::closest_hit) finds it; `None` if only
    /// that function knows. The ray is in the tree's space.
    pub fn closest(
        &self,
        csg: &Csg,
        place: usize,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<Option<PrimHit>> {
        let mut first = None;
        let sure = self.visit(csg, place, ray, range, from, scratch, |hit| {
            first = Some(hit);
            false
        });
        sure.is_ok().then_some(first)
    }

    /// Appends all hits of the ray at a place on the tree, as [`Primitive::all_hits`](crate::Primitive::all_hits) does; false if only that function
    /// knows, after some may have been appended.
    #[expect(
        clippy::too_many_arguments,
        reason = "a query and where its results go"
    )]
    pub fn all(
        &self,
        csg: &Csg,
        place: usize,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) -> bool {
        let sure = self.visit(csg, place, ray, range, from, scratch, |hit| {
            out.push(hit);
            true
        });
        sure.is_ok()
    }

    /// Goes along a ray from one visible surface to the next, until `take` returns false.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "a query and where its results go"
    )]
    fn visit(
        &self,
        csg: &Csg,
        place: usize,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        mut take: impl FnMut(PrimHit) -> bool,
    ) -> Result<(), TooClose> {
        let from = from.map(|surface| csg.leaf_surface(surface));
        let Some(query) = Query::new(ray, range, from) else {
            return Ok(());
        };
        if self.nodes.first().is_none_or(|root| root >> place & 1 == 0) {
            return match csg.node(0) {
                Some(root) if !root.far => Ok(()),
                _ => Err(TooClose),
            };
        }
        if let Some(small) = csg.small_merge() {
            let mut visit = |hit: PrimHit| {
                let goes_on = !csg.is_seen(hit.surface.element, ray, scratch) || take(hit);
                match goes_on {
                    true => ControlFlow::Continue(()),
                    false => ControlFlow::Break(()),
                }
            };
            return small.visit_merged(csg.all_leaves(), &query, Some((self, place)), &mut visit);
        }
        let mut line = Line::default();
        let mut search = Search {
            csg,
            tree: self,
            place,
            query: &query,
            scratch,
        };
        search.node(0, &mut line)?;
        let followers = line.ends.iter().skip(1).map(|next| next.t);
        for (end, next) in line.ends.iter().zip(followers.chain([f64::INFINITY])) {
            if end.t > query.range.max {
                break;
            }
            query.check_apart(end.t, next)?;
            let Some(leaf) = csg.leaf(end.leaf) else {
                return Err(TooClose);
            };
            let seen =
                leaf.visible && end.t > query.range.min && csg.is_seen(end.element, ray, scratch);
            if !seen {
                continue;
            }
            let mut hit = PrimHit::simple(end.t, end.facet);
            hit.surface.element = end.element;
            if !take(hit) {
                break;
            }
        }
        Ok(())
    }
}

/// Where a ray is inside of a node: whether it is inside where it begins, and where it enters and leaves further on.
#[derive(Debug, Default)]
struct Line {
    inside: bool,
    ends: ArrayVec<LineEnd, MOST_ENDS>,
}

/// An end of a span.
#[derive(Clone, Copy, Debug)]
struct LineEnd {
    t: f64,
    leaf: u32,
    element: u32,
    facet: u32,
}

impl Line {
    /// The state of a line that is the same everywhere.
    #[inline(always)]
    fn constant(&self) -> Option<bool> {
        self.ends.is_empty().then_some(self.inside)
    }

    #[inline(always)]
    fn set(&mut self, inside: bool) {
        self.inside = inside;
        self.ends.clear();
    }
}

/// The search of one ray for the spans of a tree's nodes.
struct Search<'a> {
    csg: &'a Csg,
    tree: &'a PacketTree,
    place: usize,
    query: &'a Query<'a>,
    scratch: &'a mut Scratch,
}

impl Search<'_> {
    /// Where the ray is inside of a node.
    fn node(&mut self, index: u32, out: &mut Line) -> Result<(), TooClose> {
        let Some(node) = self.csg.node(index) else {
            return Err(TooClose);
        };
        if self.tree.nodes[index as usize] >> self.place & 1 == 0 {
            out.set(node.far);
            return Ok(());
        }
        match node.kind {
            Kind::Leaf(number) => self.leaf(number, out),
            Kind::Operation(rule) => self.operation(node, rule, out),
        }
    }

    fn operation(&mut self, node: &Node, rule: Rule, out: &mut Line) -> Result<(), TooClose> {
        out.set(rule.neutral());
        let mut operand = Line::default();
        for place in node.first..node.end {
            let number = self.csg.operand(place).unwrap_or_default();
            if out.ends.is_empty() {
                self.node(number, out)?;
            } else {
                self.node(number, &mut operand)?;
                match operand.constant() {
                    None => self.query.combine(rule, out, &operand)?,
                    Some(inside) if inside == rule.neutral() => {}
                    Some(inside) => out.set(inside),
                }
            }
            if out.constant() == Some(!rule.neutral()) {
                return Ok(());
            }
        }
        Ok(())
    }

    fn leaf(&mut self, number: u32, out: &mut Line) -> Result<(), TooClose> {
        let Some(leaf) = self.csg.leaf(number) else {
            return Err(TooClose);
        };
        let own = self.query.own(number);
        if !leaf.has_stays() {
            return self.listed(leaf, number, own, out);
        }
        let known = match own {
            None => self.tree.stay(number, self.place),
            Some(_) => None,
        };
        let stay = match known {
            Some(stay) => stay,
            None => leaf.stay(self.query.ray, own).ok_or(TooClose)?,
        };
        self.query.stay(leaf, number, own, &stay, out)
    }

    /// The same for a shape that lists its crossings.
    fn listed(
        &mut self,
        leaf: &Leaf,
        number: u32,
        own: Option<SurfaceId>,
        out: &mut Line,
    ) -> Result<(), TooClose> {
        let query = self.query;
        let mut list = self.scratch.take();
        leaf.bare_crossings(query.ray, query.alive, own, self.scratch, &mut list);
        out.set(list.inside_at_start);
        let mut sure = Ok(());
        for crossing in &list.list {
            let (hit, enters) = (&crossing.hit, crossing.side == Side::Enter);
            if crossing.side == Side::Inner || hit.uv != [0.0; 2] || query.starts_at(hit.t) {
                sure = Err(TooClose);
            } else if hit.t > query.begin {
                let end = LineEnd {
                    t: hit.t,
                    leaf: number,
                    element: hit.surface.element,
                    facet: hit.surface.facet,
                };
                sure = sure.and(out.ends.try_push(end).map_err(|_| TooClose));
            } else {
                out.inside = enters;
            }
        }
        self.scratch.give(list);
        sure
    }
}

impl Query<'_> {
    /// Where the ray is inside of what a leaf contributes, given where it is inside of its shape.
    #[inline(always)]
    fn stay(
        &self,
        leaf: &Leaf,
        number: u32,
        own: Option<SurfaceId>,
        stay: &Stay,
        out: &mut Line,
    ) -> Result<(), TooClose> {
        // Whether the leaf contributes what is outside of the span.
        let outside = leaf.negative != stay.outside;
        out.set(outside);
        let Some(Span { enter, exit }) = stay.span else {
            return Ok(());
        };
        if exit.t < self.alive.min || enter.t > self.alive.max {
            return Ok(());
        }
        for End { t, facet } in [enter, exit] {
            let left = own.is_some_and(|surface| t == 0.0 && surface.facet == facet);
            if left || t.is_infinite() {
                continue;
            }
            if self.starts_at(t) {
                return Err(TooClose);
            }
            if t > self.begin {
                out.ends.push(LineEnd {
                    t,
                    leaf: number,
                    element: leaf.first_element,
                    facet,
                });
            }
        }
        out.inside = (enter.t <= self.begin && self.begin < exit.t) != outside;
        Ok(())
    }

    /// Combines what the ray is inside of with another operand.
    fn combine(&self, rule: Rule, line: &mut Line, other: &Line) -> Result<(), TooClose> {
        let holds = |a: bool, b: bool| match rule {
            Rule::Intersection => a && b,
            Rule::Union | Rule::Merge => a || b,
        };
        let (mut a, mut b) = (line.inside, other.inside);
        let mut state = holds(a, b);
        let mut both = Line {
            inside: state,
            ends: ArrayVec::new(),
        };
        let (mut left, mut right) = (&line.ends[..], &other.ends[..]);
        let mut before = f64::NEG_INFINITY;
        loop {
            let end = match (left.split_first(), right.split_first()) {
                (None, None) => break,
                (Some((end, rest)), other) if other.is_none_or(|(o, _)| end.t < o.t) => {
                    (a, left) = (!a, rest);
                    end
                }
                (_, Some((end, rest))) => {
                    (b, right) = (!b, rest);
                    end
                }
                // Parameters are numbers.
                _ => return Err(TooClose),
            };
            if before <= self.range.max {
                self.check_apart(before, end.t)?;
            }
            before = end.t;
            if holds(a, b) != state {
                state = !state;
                both.ends.try_push(*end).map_err(|_| TooClose)?;
            }
        }
        *line = both;
        Ok(())
    }

    /// Fails for a crossing and the next one if they could coincide.
    #[inline(always)]
    fn check_apart(&self, t: f64, next: f64) -> Result<(), TooClose> {
        if next - t > self.fusing.gap(t, next) || next == f64::INFINITY || t == f64::NEG_INFINITY {
            Ok(())
        } else {
            Err(TooClose)
        }
    }
}

/// Four rays that are tested against many boxes.
struct FourSlabs<I: Isa> {
    origin: [I::F64x4; 3],
    inverse: [I::F64x4; 3],
    /// The parts that matter, a little wider than what is asked.
    min: I::F64x4,
    max: I::F64x4,
    /// The lanes that run along a face of a box.
    parallel: u32,
}

impl<I: Isa> FourSlabs<I> {
    #[inline(always)]
    fn new(isa: I, rays: &FourRays<I>, min: f64, ends: &[f64; LANES]) -> Self {
        let one = isa.splat(1.0);
        let [x, y, z] = rays.direction;
        let inverse = [isa.div(one, x), isa.div(one, y), isa.div(one, z)];
        let largest = isa.splat(f64::MAX);
        let finite = isa.le(isa.abs(inverse[0]), largest)
            & isa.le(isa.abs(inverse[1]), largest)
            & isa.le(isa.abs(inverse[2]), largest);
        let fusing = FourFusing::new(isa, rays);
        let (min, max, wide) = (isa.splat(min), isa.load(ends), isa.splat(32.0));
        Self {
            origin: rays.origin,
            inverse,
            min: isa.sub(min, isa.mul(wide, fusing.margin(isa, min))),
            max: isa.add(max, isa.mul(wide, fusing.margin(isa, max))),
            parallel: !finite & 0b1111,
        }
    }

    /// The lanes, as bits, that may meet a box: all others certainly miss it.
    #[inline(always)]
    fn may_meet(&self, isa: I, bounds: &Aabb) -> u32 {
        // A difference, a reciprocal and a product, each within half an ulp: widened by more than their sum.
        let slack = isa.splat(4.0 * f64::EPSILON);
        let corner = |v: strahl_math::DVec3| [isa.splat(v.x), isa.splat(v.y), isa.splat(v.z)];
        let (low, high) = (corner(bounds.min), corner(bounds.max));
        let a = times(isa, sub(isa, low, self.origin), self.inverse);
        let b = times(isa, sub(isa, high, self.origin), self.inverse);
        let near = isa.max(
            isa.max(isa.min(a[0], b[0]), isa.min(a[1], b[1])),
            isa.min(a[2], b[2]),
        );
        let far = isa.min(
            isa.min(isa.max(a[0], b[0]), isa.max(a[1], b[1])),
            isa.max(a[2], b[2]),
        );
        let near = isa.sub(near, isa.mul(isa.abs(near), slack));
        let far = isa.add(far, isa.mul(isa.abs(far), slack));
        let missed = isa.lt(far, near) | isa.lt(far, self.min) | isa.lt(self.max, near);
        !missed & 0b1111 | self.parallel
    }
}

#[inline(always)]
fn times<I: Isa>(isa: I, a: [I::F64x4; 3], b: [I::F64x4; 3]) -> [I::F64x4; 3] {
    [
        isa.mul(a[0], b[0]),
        isa.mul(a[1], b[1]),
        isa.mul(a[2], b[2]),
    ]
}
