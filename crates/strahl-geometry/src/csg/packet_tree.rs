//! What a packet of rays knows of a tree: its boxes and leaves are tested four rays side by side.

use super::boxes::FourSlabs;
use super::compiled::Csg;
use super::four_stays::FourStays;
use super::node::Kind;
use super::sweep::Rule;
use crate::blocks::LANES;
use crate::blocks::convex::{FourRays, GROUPS};
use crate::primitives::convex::Stay;
use strahl_accel::PACKET;
use strahl_math::{Ray, Transform};
use strahl_simd::{Isa, Simd, dispatch};

/// The boxes and leaves of a tree that the rays of a packet meet.
#[derive(Clone, Debug, Default)]
pub struct PacketTree {
    /// For each node the rays, as bits, that may meet its surface. Along the others it is the same everywhere, as far away from it.
    nodes: Vec<u32>,
    leaves: Vec<[FourStays; GROUPS]>,
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
            if rays == 0 {
                if let Kind::Leaf(number) = node.kind {
                    self.leaves[number as usize][group].set_missed();
                }
                continue;
            }
            if !node.quick {
                rays &= four.slabs.may_meet(isa, &node.bounds);
            }
            self.nodes[index] |= rays << shift;
            let Kind::Leaf(number) = node.kind else {
                continue;
            };
            let Some(leaf) = csg.leaf(number) else {
                return;
            };
            let stays = &mut self.leaves[number as usize][group];
            if rays == 0 {
                stays.set_missed();
            } else {
                *stays = leaf.four_stays(isa, &four.rays).of(rays);
            }
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
}
