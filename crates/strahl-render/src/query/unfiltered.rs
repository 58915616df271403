//! Specialised searches of groups that have only triangles of meshes, or only spheres, whose hits need no filter: the
//! common case of large scenes, without the code for all others.

use super::Search;
use super::block::Block;
use super::kinds::Query;
use super::leaves::lane_entered;
use crate::blocks::OneKind;
use crate::first_ids::FirstIds;
use crate::hit::Hit;
use strahl_accel::{BLOCK, Bvh8, Leaf, NO_PRIMITIVE, Visitor};
use strahl_geometry::RayShear;
use strahl_geometry::blocks::Hits;
use strahl_math::{Interval, Ray};
use strahl_simd::{Isa, dispatch};

/// A group all of whose primitives are tested in blocks of one kind, with hits that need no filter (see
/// [`Query::is_unfiltered`]).
#[derive(Clone, Copy)]
pub(super) struct Unfiltered<'g> {
    pub(super) bvh: &'g Bvh8,
    pub(super) blocks: OneKind<'g>,
    /// First element number of each primitive, if it is not the primitive's own.
    pub(super) first_ids: Option<&'g FirstIds>,
    /// The primitive the ray starts on.
    pub(super) from_prim: u32,
    /// The number of the group's first element.
    pub(super) base: u64,
}

impl Unfiltered<'_> {
    /// Searches the group; returns the new upper end of the range.
    #[inline(always)]
    pub(super) fn search<Q: Query>(
        &self,
        ray: &Ray,
        range: Interval,
        search: &mut Search<'_, '_, Q>,
    ) -> f64 {
        let simd = self.bvh.proof();
        match self.blocks {
            OneKind::Triangles(blocks) => {
                dispatch!(simd, isa => self.walk(isa, blocks, ray, range, search))
            }
            OneKind::Spheres(blocks) => {
                dispatch!(simd, isa => self.walk(isa, blocks, ray, range, search))
            }
        }
    }

    #[inline(always)]
    fn walk<I: Isa, B: Block, Q: Query>(
        &self,
        isa: I,
        blocks: &[B],
        ray: &Ray,
        range: Interval,
        search: &mut Search<'_, '_, Q>,
    ) -> f64 {
        let mut visitor = BlockVisitor {
            of: self,
            blocks,
            ray,
            shear: if B::CURVED {
                RayShear::UNUSED
            } else {
                RayShear::new(ray)
            },
            range_min: range.min,
            t_max: range.max,
            query: search.query,
        };
        self.bvh
            .traverse_leaves(isa, ray, range, &mut visitor, search.stats);
        visitor.t_max
    }

    #[inline(always)]
    fn first_id(&self, prim: u32) -> u64 {
        match self.first_ids {
            None => u64::from(prim),
            Some(ids) => ids.of(prim),
        }
    }
}

struct BlockVisitor<'v, 'g, B, Q> {
    of: &'v Unfiltered<'g>,
    /// In the order of the leaves.
    blocks: &'v [B],
    ray: &'v Ray,
    shear: RayShear,
    range_min: f64,
    t_max: f64,
    query: &'v mut Q,
}

impl<B: Block, Q: Query> Visitor for BlockVisitor<'_, '_, B, Q> {
    const ANY: bool = Q::ANY;

    #[inline(always)]
    fn visit_leaf<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, mut t_max: f64) -> f64 {
        let first = leaf.first_block;
        let Some(blocks) = self.blocks.get(first..first + leaf.blocks()) else {
            return t_max;
        };
        let from_prim = self.of.from_prim;
        for (index, block) in blocks.iter().enumerate() {
            let range = Interval::new(self.range_min, t_max);
            if let Some(lane) = lane_entered(block, leaf, index, from_prim, self.ray, range.min)
                && let Some(t) = block.met_again(lane, self.ray, range)
            {
                t_max = self.take(from_prim, t, [0.0; 2], t_max);
                if t_max == f64::NEG_INFINITY {
                    return t_max;
                }
            }
            let mut hits = Hits::default();
            let range = range.with_max(t_max);
            let mut lanes = block.hits(isa, self.ray, &self.shear, range, &mut hits);
            while lanes != 0 {
                // Lets the compiler see that there are four lanes.
                let lane = lanes.trailing_zeros() as usize % BLOCK;
                lanes &= lanes - 1;
                let prim = leaf.id(index, lane);
                let t = hits.t[lane];
                // An earlier lane may have been closer.
                if prim == NO_PRIMITIVE || prim == from_prim || t > t_max {
                    continue;
                }
                let uv = [hits.uv[0][lane], hits.uv[1][lane]];
                t_max = self.take(prim, t, uv, t_max);
                if t_max == f64::NEG_INFINITY {
                    return t_max;
                }
            }
        }
        t_max
    }

    #[inline(always)]
    fn block_address(&self, block: usize) -> *const u8 {
        self.blocks.as_ptr().wrapping_add(block).cast()
    }

    /// Never called: all primitives are in blocks.
    fn visit(&mut self, _: u32, t_max: f64) -> f64 {
        t_max
    }
}

impl<B, Q: Query> BlockVisitor<'_, '_, B, Q> {
    #[inline(always)]
    fn take(&mut self, prim: u32, t: f64, uv: [f64; 2], t_max: f64) -> f64 {
        let hit = Hit {
            t,
            id: self.of.base + self.of.first_id(prim),
            facet: 0,
            uv,
        };
        self.t_max = self.query.take(hit, t_max);
        self.t_max
    }
}
