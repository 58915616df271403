//! Trees and the rays of a packet: leaves and boxes are tested four rays side by side, then each ray goes through the tree by itself.
//!
//! A ray is inside of a node along a few spans (Roth, "Ray casting for modeling solids", 1982); an operation combines those of its operands. As in
//! [`first`](super::first) crossings that could coincide are left to the general evaluation, so both give the same bits.

use super::Csg;
use super::boxes::FourSlabs;
use super::leaf::Leaf;
use super::lines::{Line, Search};
use super::small::Query;
use super::solid::{Kind, Node};
use super::sweep::Rule;
use super::timeline::TooClose;
use crate::blocks::LANES;
use crate::blocks::convex::{FourRays, FourSpans, GROUPS};
use crate::primitives::convex::Stay;
use crate::{PrimHit, Scratch, SurfaceId};
use std::ops::ControlFlow;
use strahl_accel::PACKET;
use strahl_math::{Interval, Ray, Transform};
use strahl_simd::{Isa, Simd, dispatch};

/// The most leaves of a tree: what is known of a leaf takes some hundred bytes.
const MOST_LEAVES: usize = 32;

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
                planes <= MOST_PLANES && node.kind != Kind::Operation(Rule::Union)
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

    /// Whether the ray at a place may meet the surface of a node.
    #[inline(always)]
    pub(super) fn may_meet(&self, node: u32, place: usize) -> bool {
        self.nodes[node as usize] >> place & 1 == 1
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
        if !self.may_meet(0, place) {
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
