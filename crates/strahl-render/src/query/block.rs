//! The tests of blocks: four primitives of a leaf side by side.

use crate::blocks::Blocks;
use crate::scene::RenderGroup;
use std::borrow::Borrow;
use strahl_accel::Leaf;
use strahl_geometry::RayShear;
use strahl_geometry::blocks::{
    Coordinate, Hits, LANES, PacketLines, PacketShears, SphereBlock, TriangleBlock,
};
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// The constants of a packet for the culling tests of blocks; `None` where the rays have too little in common or no block needs
/// them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PacketCulls<'c> {
    pub(crate) shears: Option<&'c PacketShears>,
    pub(crate) lines: Option<&'c PacketLines>,
}

/// A block of a leaf all of whose blocks are of this kind.
pub(crate) trait BlockOfLeaf: Block {
    /// A reference to a block, or a block made on demand.
    type Found<'b>: Borrow<Self>;

    /// One of the blocks of a leaf of this class.
    fn of<'b>(
        group: &RenderGroup,
        blocks: &'b Blocks,
        leaf: &Leaf<'_>,
        index: usize,
    ) -> Self::Found<'b>;
}

/// A block of primitives of one class that finds their hits.
pub(crate) trait Block: Sized {
    /// Whether a ray that starts on a primitive may meet that primitive again.
    const CURVED: bool;

    /// The lanes that the ray hits in the range, as bits, and the hits. The lane of the primitive that the ray starts on has no
    /// meaning.
    fn hits<I: Isa>(
        &self,
        isa: I,
        ray: &Ray,
        shear: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32;

    /// The rays of a packet that may hit one of the first `used` primitives, as bits; all others certainly miss them.
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32;

    /// Whether a ray that starts on the primitive of a lane may hit it again further on.
    fn is_entered(&self, _lane: usize, _ray: &Ray) -> bool {
        Self::CURVED
    }

    /// Where a ray that starts on the primitive of a lane hits it again in a range.
    fn met_again(&self, _lane: usize, _ray: &Ray, _range: Interval) -> Option<f64> {
        None
    }

    /// All hits in a range on the curved primitive of a lane, for a ray that starts elsewhere.
    fn all_hits(&self, _lane: usize, _ray: &Ray, _range: Interval) -> [Option<f64>; 2] {
        [None; 2]
    }
}

impl BlockOfLeaf for TriangleBlock<f32> {
    type Found<'b> = &'b Self;

    #[inline(always)]
    fn of<'b>(_: &RenderGroup, blocks: &'b Blocks, leaf: &Leaf<'_>, index: usize) -> &'b Self {
        blocks.mesh(leaf.first_block + index)
    }
}

impl<T: Coordinate> Block for TriangleBlock<T> {
    const CURVED: bool = false;

    #[inline(always)]
    fn hits<I: Isa>(
        &self,
        isa: I,
        _: &Ray,
        shear: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32 {
        self.hits(isa, shear, range, hits)
    }

    #[inline(always)]
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32 {
        match packet.shears {
            Some(shears) => self.may_hit(isa, shears, used),
            None => u32::MAX,
        }
    }
}

impl BlockOfLeaf for SphereBlock {
    type Found<'b> = &'b Self;

    #[inline(always)]
    fn of<'b>(_: &RenderGroup, blocks: &'b Blocks, leaf: &Leaf<'_>, index: usize) -> &'b Self {
        &blocks.spheres()[blocks.place(leaf.first_block + index)]
    }
}

impl Block for SphereBlock {
    const CURVED: bool = true;

    #[inline(always)]
    fn hits<I: Isa>(
        &self,
        isa: I,
        ray: &Ray,
        _: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32 {
        self.hits(isa, ray, range, hits)
    }

    #[inline(always)]
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32 {
        match packet.lines {
            Some(lines) => self.may_hit(isa, lines, used),
            None => u32::MAX,
        }
    }

    #[inline(always)]
    fn is_entered(&self, lane: usize, ray: &Ray) -> bool {
        self.is_entered(lane, ray)
    }

    #[inline(always)]
    fn met_again(&self, lane: usize, ray: &Ray, range: Interval) -> Option<f64> {
        self.met_again(lane, ray, range)
    }

    #[inline]
    fn all_hits(&self, lane: usize, ray: &Ray, range: Interval) -> [Option<f64>; 2] {
        self.all_hits(lane, ray, range)
    }
}

/// Four triangles of meshes, fetched from the meshes when a ray visits their leaf.
pub(crate) struct Fetched(TriangleBlock<f32>);

impl BlockOfLeaf for Fetched {
    type Found<'b> = Self;

    #[inline(always)]
    fn of(group: &RenderGroup, _: &Blocks, leaf: &Leaf<'_>, index: usize) -> Self {
        let mut four = TriangleBlock::EMPTY;
        let used = leaf.count - index * LANES;
        for lane in 0..used.min(LANES) {
            if let Some(corners) = group.stored_corners(leaf.id(index, lane)) {
                four.set(lane, corners);
            }
        }
        Self(four)
    }
}

impl Block for Fetched {
    const CURVED: bool = false;

    #[inline(always)]
    fn hits<I: Isa>(
        &self,
        isa: I,
        _: &Ray,
        shear: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32 {
        self.0.hits(isa, shear, range, hits)
    }
    #[inline(always)]
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32 {
        Block::may_hit(&self.0, isa, packet, used)
    }
}
