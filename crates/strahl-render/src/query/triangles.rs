//! Searches among nothing but triangles of meshes of which every hit counts: what most meshes are, without what others need.

use super::Search;
use super::kinds::Query;
use crate::hit::Hit;
use strahl_accel::{BLOCK, Bvh8, Leaf, NO_PRIMITIVE, Visitor};
use strahl_geometry::RayShear;
use strahl_geometry::blocks::{Hits, TriangleBlock};
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// Triangles of a group, all of them tested in blocks, and hits on them taken as they are (see [`Query::is_plain`]).
pub(super) struct PlainTriangles<'g> {
    pub(super) bvh: &'g Bvh8,
    /// By the blocks of the leaves.
    pub(super) blocks: &'g [TriangleBlock<f32>],
    /// First element number of each primitive, if it is not the primitive's own.
    pub(super) first_ids: Option<&'g [u64]>,
    /// The triangle the ray starts on.
    pub(super) from_prim: u32,
    /// The number of the group's first element.
    pub(super) base: u64,
}

impl PlainTriangles<'_> {
    /// Searches them; returns the new upper end of the range.
    #[inline(always)]
    pub(super) fn search<I: Isa, Q: Query>(
        &self,
        isa: I,
        ray: &Ray,
        range: Interval,
        search: &mut Search<'_, '_, Q>,
    ) -> f64 {
        let mut visitor = TriangleVisitor {
            of: self,
            shear: RayShear::new(ray),
            range_min: range.min,
            t_max: range.max,
            query: search.query,
        };
        self.bvh
            .traverse_leaves(isa, ray, range, &mut visitor, search.stats);
        visitor.t_max
    }
}

struct TriangleVisitor<'v, 'g, Q> {
    of: &'v PlainTriangles<'g>,
    shear: RayShear,
    range_min: f64,
    t_max: f64,
    query: &'v mut Q,
}

impl<Q: Query> Visitor for TriangleVisitor<'_, '_, Q> {
    const ANY: bool = Q::ANY;

    #[inline(always)]
    fn visit_leaf<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, mut t_max: f64) -> f64 {
        let first = leaf.first_block;
        let Some(blocks) = self.of.blocks.get(first..first + leaf.blocks()) else {
            return t_max;
        };
        for (index, block) in blocks.iter().enumerate() {
            let mut hits = Hits::default();
            let range = Interval::new(self.range_min, t_max);
            let mut lanes = block.hits(isa, &self.shear, range, &mut hits);
            while lanes != 0 {
                // There are four lanes; said so, the compiler knows it too.
                let lane = lanes.trailing_zeros() as usize % BLOCK;
                lanes &= lanes - 1;
                let prim = leaf.id(index, lane);
                let t = hits.t[lane];
                // Another lane may have been closer.
                if prim == NO_PRIMITIVE || prim == self.of.from_prim || t > t_max {
                    continue;
                }
                let hit = Hit {
                    t,
                    id: self.of.base + self.of.first_id(prim),
                    facet: 0,
                    uv: [hits.uv[0][lane], hits.uv[1][lane]],
                };
                t_max = self.query.take(hit, t_max);
                self.t_max = t_max;
                if t_max == f64::NEG_INFINITY {
                    return t_max;
                }
            }
        }
        t_max
    }

    #[inline(always)]
    fn block_address(&self, block: usize) -> *const u8 {
        self.of.blocks.as_ptr().wrapping_add(block).cast()
    }

    /// Never asked: all triangles are in blocks.
    fn visit(&mut self, _: u32, t_max: f64) -> f64 {
        t_max
    }
}

impl PlainTriangles<'_> {
    #[inline(always)]
    fn first_id(&self, prim: u32) -> u64 {
        match self.first_ids {
            None => u64::from(prim),
            Some(first) => first.get(prim as usize).copied().unwrap_or_default(),
        }
    }
}
