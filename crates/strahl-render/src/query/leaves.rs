//! Leaves tested in blocks: which of four primitives a ray hits, and what becomes of these hits.

use super::block::{Block, BlockOfLeaf};
use super::kinds::Query;
use super::{GroupVisitor, NONE};
use crate::blocks::Flats;
use crate::hit::Hit;
use crate::prim::{Prim, PrimKind};
use std::borrow::Borrow;
use strahl_accel::{BLOCK, Leaf, NO_PRIMITIVE, Visitor};
use strahl_geometry::blocks::{Hits, PlaneHits, PolygonBlock};
use strahl_geometry::{PlaneHit, Shape, SurfaceId};
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// The lane of a block with the primitive that a ray starts on, if the ray may hit that one again.
#[inline(always)]
pub(super) fn lane_entered<B: Block>(
    block: &B,
    leaf: &Leaf<'_>,
    index: usize,
    from_prim: u32,
    ray: &Ray,
    range_min: f64,
) -> Option<usize> {
    if !B::CURVED || from_prim == NONE {
        return None;
    }
    let lane = (0..BLOCK).find(|lane| leaf.id(index, *lane) == from_prim)?;
    (range_min < 0.0 || block.is_entered(lane, ray)).then_some(lane)
}

impl<Q: Query> GroupVisitor<'_, '_, '_, Q> {
    /// Tests the primitives of a leaf four at a time.
    #[inline(always)]
    pub(super) fn blocks<I: Isa, B: BlockOfLeaf>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        mut t_max: f64,
    ) -> f64 {
        let mut hits = Hits::default();
        for index in 0..leaf.blocks() {
            let block = B::of(self.group, self.blocks, leaf, index);
            t_max = self.block::<I, B>(isa, leaf, index, block.borrow(), &mut hits, t_max);
            if t_max == f64::NEG_INFINITY {
                break;
            }
        }
        t_max
    }

    /// Tests the flat primitives of a leaf four at a time.
    #[inline(always)]
    pub(super) fn flats<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, mut t_max: f64) -> f64 {
        let mut hits = Hits::default();
        for index in 0..leaf.blocks() {
            t_max = match self.blocks.flats(leaf.first_block + index) {
                Flats::Triangles(block) => self.block(isa, leaf, index, block, &mut hits, t_max),
                Flats::Polygons(block) => self.polygons(isa, leaf, index, block, t_max),
            };
            if t_max == f64::NEG_INFINITY {
                break;
            }
        }
        t_max
    }

    /// Tests those primitives of a block whose lanes the block test has kept.
    #[inline(always)]
    pub(super) fn polygons<I: Isa>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        index: usize,
        block: &PolygonBlock,
        mut t_max: f64,
    ) -> f64 {
        let range = Interval::new(self.range_min, t_max);
        let mut at = PlaneHits::default();
        let mut lanes = block.may_hit(isa, self.ray, range, &mut at);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % BLOCK;
            lanes &= lanes - 1;
            t_max = self.polygon(
                leaf.id(index, lane),
                block.is_polygon(lane),
                at.lane(lane),
                t_max,
            );
            if t_max == f64::NEG_INFINITY {
                break;
            }
        }
        t_max
    }

    /// Tests a polygon whose plane the ray is known to cross, if it does.
    #[inline(always)]
    fn polygon(&mut self, id: u32, is_polygon: bool, at: PlaneHit, t_max: f64) -> f64 {
        if id == self.from_prim {
            return t_max;
        }
        let prim = self.group.prims.at(id);
        // Its block has already rejected it if it faces away.
        let unfiltered = is_polygon
            && prim.visible & self.search.class != 0
            && prim.flags & Prim::MASKED == 0
            && self
                .search
                .query
                .is_unfiltered_flat(prim.flags & !Prim::FILTERED);
        let PrimKind::Shape(index) = prim.kind() else {
            return self.visit(id, t_max);
        };
        match &self.group.shapes[index as usize].shape {
            Shape::Polygon(polygon) if unfiltered => {
                let range = Interval::new(self.range_min, t_max);
                match polygon.hit_in_plane(self.ray, range, at) {
                    Some(t) => self.take(id, t, [0.0; 2], t_max),
                    None => t_max,
                }
            }
            _ => self.visit(id, t_max),
        }
    }

    /// Tests the primitives of one block of a leaf.
    #[inline(always)]
    pub(super) fn block<I: Isa, B: Block>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        index: usize,
        block: &B,
        hits: &mut Hits,
        mut t_max: f64,
    ) -> f64 {
        let (from_prim, ray) = (self.from_prim, self.ray);
        if let Some(lane) = lane_entered(block, leaf, index, from_prim, ray, self.range_min) {
            // The primitive's own test decides, which, unlike the test of the block, knows where the ray starts. There is one
            // hit at most.
            let id = self.from_prim;
            t_max = if self.unfiltered || self.is_unfiltered(id, false) {
                match block.met_again(lane, self.ray, Interval::new(self.range_min, t_max)) {
                    Some(t) => self.take(id, t, [0.0; 2], t_max),
                    None => t_max,
                }
            } else {
                self.visit(id, t_max)
            };
            if t_max == f64::NEG_INFINITY {
                return t_max;
            }
        }
        let range = Interval::new(self.range_min, t_max);
        let mut lanes = block.hits(isa, self.ray, self.shear, range, hits);
        while lanes != 0 {
            // Lets the compiler see that there are four lanes.
            let lane = lanes.trailing_zeros() as usize % BLOCK;
            lanes &= lanes - 1;
            let id = leaf.id(index, lane);
            if id == NO_PRIMITIVE || id == self.from_prim {
                continue;
            } else if self.unfiltered || self.is_unfiltered(id, B::CURVED) {
                let uv = [hits.uv[0][lane], hits.uv[1][lane]];
                t_max = self.take(id, hits.t[lane], uv, t_max);
            } else if B::CURVED && Q::ALL && self.is_unfiltered(id, false) {
                for t in block.all_hits(lane, self.ray, range).into_iter().flatten() {
                    t_max = self.take(id, t, [0.0; 2], t_max);
                }
            } else if B::CURVED {
                t_max = self.visit(id, t_max);
            } else {
                let uv = [hits.uv[0][lane], hits.uv[1][lane]];
                t_max = self.take_filtered(id, hits.t[lane], uv, t_max);
            }
            if t_max == f64::NEG_INFINITY {
                return t_max;
            }
        }
        t_max
    }

    /// Whether hits of a block on this primitive need no filter.
    #[inline]
    fn is_unfiltered(&self, id: u32, curved: bool) -> bool {
        let prim = self.group.prims.at(id);
        let unfiltered = if curved {
            self.search.query.is_unfiltered(prim.flags)
        } else {
            self.search.query.is_unfiltered_flat(prim.flags)
        };
        prim.visible & self.search.class != 0 && unfiltered
    }

    /// Takes a hit that needs no filter.
    #[inline(always)]
    fn take(&mut self, id: u32, t: f64, uv: [f64; 2], t_max: f64) -> f64 {
        // An earlier lane may have been closer.
        if t <= t_max {
            let id = self.base + self.group.first_id(id);
            let facet = 0;
            self.t_max = self.search.query.take(Hit { t, id, facet, uv }, t_max);
            return self.t_max;
        }
        t_max
    }

    /// Takes a hit on a flat primitive, unless it is on the back or in a hole.
    #[inline]
    fn take_filtered(&mut self, id: u32, t: f64, uv: [f64; 2], t_max: f64) -> f64 {
        let prim = self.group.prims.at(id);
        if prim.visible & self.search.class == 0
            || !self
                .search
                .query
                .is_unfiltered_flat(prim.flags & !Prim::FILTERED)
        {
            return self.visit(id, t_max);
        }
        let facing = self.facing(id, prim);
        let hit = Hit {
            t,
            id: self.base + self.group.first_id(id),
            facet: 0,
            uv,
        };
        let surface = SurfaceId {
            element: 0,
            facet: 0,
        };
        let front = facing.is_some();
        if facing != Some(false) && t <= t_max && self.exists(id, prim, &hit, surface, front) {
            self.take(id, t, uv, t_max)
        } else {
            t_max
        }
    }
}
