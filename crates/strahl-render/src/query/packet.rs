//! Searches for several rays at once. Tests of the whole packet only cull; the remaining rays are tested one by one, as single
//! rays are.

mod instance;
mod unfiltered;

use super::block::{Block, BlockOfLeaf, Fetched, PacketCulls};
use super::kinds::{Any, Closest, Query, Transmitting};
use super::{From, GroupVisitor, Intersector, NONE, Search};
use crate::activity::{Phase, Slot};
use crate::blocks::{Blocks, Flats, LeafClass};
use crate::hit::{Hit, Origin, RayClass};
use crate::prim::PrimKind;
use crate::scene::{RenderGroup, RenderScene};
use arrayvec::ArrayVec;
use instance::Place;
use std::borrow::Borrow;
use strahl_accel::{
    Accelerator, BLOCK, Leaf, PACKET, Packet, PacketVisitor, TraversalStats, Visitor, lanes_of,
};
use strahl_geometry::blocks::{
    Hits, PacketLines, PacketRays, PacketShears, PacketSpans, SphereBlock, TriangleBlock,
};
use strahl_geometry::{PacketTree, RayShear, Scratch};
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// Fewer rays, to hits or to a light, are traced one by one: what a packet costs at first does not pay for them.
pub(crate) const PACKET_MIN: usize = 3;

/// Whether there are enough of these lanes for a packet.
const fn fill_packet(lanes: u32) -> bool {
    lanes.count_ones() as usize >= PACKET_MIN
}

/// Whether it pays to test these lanes four side by side: if more than two in each group of four are wanted.
const fn are_dense(lanes: u32) -> bool {
    let groups = (lanes | lanes >> 1 | lanes >> 2 | lanes >> 3) & 0x1111;
    lanes.count_ones() > 2 * groups.count_ones()
}

/// Evaluates an expression with the visitor of a single ray: `of_lane!(self, lane, t_max, visitor => expression)`. A macro,
/// because a closure would not be compiled for the vector instructions of its caller.
macro_rules! of_lane {
    ($self:ident, $lane:expr, $t_max:expr, $visitor:ident => $body:expr) => {{
        let lane = $lane % PACKET;
        let mut search = Search {
            scene: $self.shared.scene,
            scratch: $self.shared.scratch,
            stats: $self.shared.stats,
            slot: $self.shared.slot,
            class: $self.shared.class,
            parts: $self.shared.parts,
            query: &mut $self.queries[lane],
        };
        let base = $self.place.base;
        let from: From<'_> = $self.asked.from[lane].map(|o| (o, o.id - base));
        let mut $visitor = GroupVisitor {
            search: &mut search,
            group: $self.group,
            blocks: $self.blocks,
            ray: &$self.asked.rays[lane],
            shear: $self.shears.get(lane).unwrap_or(&RayShear::UNUSED),
            range_min: $self.asked.min,
            from,
            from_prim: $self.from_prims[lane],
            base,
            t_max: $t_max,
            unfiltered: $self.unfiltered,
        };
        $body
    }};
}

impl Intersector<'_> {
    /// [`Intersector::closest_hit`] for several rays, at most [`PACKET`], which should be close to each other: the same hits, found
    /// sooner. `from` has their origins; the results go to `hits`.
    pub fn closest_hits(
        &mut self,
        rays: &[Ray],
        range: Interval,
        from: &[Option<&Origin>; PACKET],
        class: RayClass,
        hits: &mut [Option<Hit>; PACKET],
    ) {
        let asked = Asked {
            rays,
            min: range.min,
            from,
            class,
            first: NONE,
        };
        let queries: &mut [Closest; PACKET] = hits;
        queries.fill(None);
        self.search_packet(&asked, common_end(rays, range), queries);
    }

    /// [`Intersector::any_opaque`] for several rays, at most [`PACKET`], as bits.
    pub fn any_opaques(
        &mut self,
        rays: &[Ray],
        range: Interval,
        from: &[Option<&Origin>; PACKET],
    ) -> u32 {
        let asked = Asked {
            rays,
            min: range.min,
            from,
            class: RayClass::Shadow,
            first: NONE,
        };
        self.search_opaque(&asked, common_end(rays, range)).0
    }

    /// [`Intersector::occluded`] for several rays to one light, as bits; each has a range from `min` to the `t_max` of its lane.
    pub(crate) fn all_occluded(
        &mut self,
        rays: &[Ray],
        min: f64,
        t_max: [f64; PACKET],
        from: &[Option<&Origin>; PACKET],
        light: usize,
    ) -> u32 {
        let asked = Asked {
            rays,
            min,
            from,
            class: RayClass::Shadow,
            first: self.occluders[light],
        };
        let (found, last) = self.search_opaque(&asked, t_max);
        self.remember(light, last);
        found
    }

    /// [`Intersector::transmitting_hits`] for several rays; each has a range from `min` to the `t_max` of its lane, and its own list.
    pub(crate) fn all_transmitting_hits(
        &mut self,
        rays: &[Ray],
        min: f64,
        t_max: [f64; PACKET],
        from: &[Option<&Origin>; PACKET],
        hits: &mut [Vec<Hit>; PACKET],
    ) {
        let asked = Asked {
            rays,
            min,
            from,
            class: RayClass::Shadow,
            first: NONE,
        };
        let mut queries = hits.each_mut().map(|hits| Transmitting { hits });
        self.search_packet(&asked, t_max, &mut queries);
    }

    /// The rays that meet something opaque, as bits, and what the last of them has found.
    fn search_opaque(&mut self, asked: &Asked<'_>, t_max: [f64; PACKET]) -> (u32, Option<u64>) {
        let mut queries = [Any::OPAQUE; PACKET];
        self.search_packet(asked, t_max, &mut queries);
        let (mut found, mut last) = (0, None);
        for (lane, query) in queries.iter().enumerate() {
            found |= u32::from(query.found.is_some()) << lane;
            last = query.found.or(last);
        }
        (found, last)
    }

    fn search_packet<Q: Query>(
        &mut self,
        asked: &Asked<'_>,
        t_max: [f64; PACKET],
        queries: &mut [Q; PACKET],
    ) {
        let group = &self.scene.groups[0];
        self.slot.enter(Phase::Traversal);
        let mut shared = Shared {
            scene: self.scene,
            scratch: &mut self.scratch,
            stats: &mut self.stats,
            slot: &self.slot,
            class: asked.class.bit(),
            parts: self.remembers,
            memory: &mut self.packet,
        };
        shared.search(group, asked, Place::WORLD, t_max, queries);
    }
}

/// What the searches of the world and of the groups within it share.
struct Shared<'v, 's> {
    scene: &'s RenderScene,
    scratch: &'v mut Scratch,
    stats: &'v mut TraversalStats,
    slot: &'v Slot,
    class: u8,
    /// Whether to search only the part of a group that matters to the query.
    parts: bool,
    memory: &'v mut PacketMemory,
}

/// What the searches of packets use again, because it is large.
#[derive(Debug, Default)]
pub(super) struct PacketMemory {
    /// What a packet meets of a CSG tree.
    tree: PacketTree,
    /// The rays coordinate by coordinate.
    coordinates: PacketRays,
    /// Where they are inside of a shape.
    spans: PacketSpans,
}

impl<'s> Shared<'_, 's> {
    /// Searches a group for rays in its space, and returns the new upper ends of their ranges.
    // One function for the world and for groups within it: the traversal is compiled into it.
    #[inline(never)]
    fn search<Q: Query>(
        &mut self,
        group: &'s RenderGroup,
        asked: &Asked<'_>,
        place: Place,
        t_max: [f64; PACKET],
        queries: &mut [Q; PACKET],
    ) -> [f64; PACKET] {
        let part = queries[0].part(group).filter(|_| self.parts);
        let (accelerator, blocks, is_sheared) = match part {
            None => (&group.accelerator, &group.blocks, group.sheared),
            Some(part) => (&part.accelerator, &part.blocks, part.sheared),
        };
        let mut stats = TraversalStats::default();
        let mut shears = ArrayVec::<RayShear, PACKET>::new();
        let max_abs = group.bounds.max_abs();
        let (sheared, lines);
        let mut culls = PacketCulls {
            shears: None,
            lines: None,
        };
        if is_sheared {
            shears.extend(asked.rays.iter().take(PACKET).map(RayShear::new));
            sheared = PacketShears::new(&shears, max_abs);
            culls.shears = sheared.as_ref();
        }
        if blocks.has_spheres() {
            lines = PacketLines::new(asked.rays, max_abs);
            culls.lines = Some(&lines);
        }
        let class = self.class;
        let mut visitor = Together {
            unfiltered: group.uniform_flags.is_some_and(|(visible, flags)| {
                visible & class != 0 && queries[0].is_unfiltered(flags)
            }),
            shared: &mut *self,
            group,
            blocks,
            asked,
            place,
            from_prims: prims_of(group, asked, place),
            shears: &shears,
            culls,
            has_coordinates: false,
            queries,
        };
        let mut packet = Packet {
            rays: asked.rays,
            min: asked.min,
            t_max,
        };
        if asked.first != NONE {
            let alive = packet.alive();
            visitor.visit_together(asked.first, alive, &mut packet.t_max);
            stats.primitive_tests += u64::from(alive.count_ones());
        }
        if !accelerator.traverse_packet(&mut packet, &mut visitor, &mut stats) {
            for (lane, ray) in asked.rays.iter().enumerate().take(PACKET) {
                let range = Interval::new(asked.min, packet.t_max[lane]);
                if range.max > f64::NEG_INFINITY {
                    packet.t_max[lane] = of_lane!(visitor, lane, range.max, one => {
                        accelerator.traverse(ray, range, &mut one, &mut stats);
                        one.t_max
                    });
                }
            }
        }
        *self.stats += stats;
        packet.t_max
    }
}

/// The primitives of a group that the rays come from.
#[inline(always)]
fn prims_of(group: &RenderGroup, asked: &Asked<'_>, place: Place) -> [u32; PACKET] {
    let mut prims = [NONE; PACKET];
    for (prim, from) in prims.iter_mut().zip(asked.from) {
        if let Some(origin) = from {
            *prim = group.prim_of(origin.id - place.base);
        }
    }
    prims
}

/// The upper end of a range in the lanes of these rays.
fn common_end(rays: &[Ray], range: Interval) -> [f64; PACKET] {
    let mut t_max = [f64::NEG_INFINITY; PACKET];
    for (t_max, _) in t_max.iter_mut().zip(rays) {
        *t_max = range.max;
    }
    t_max
}

/// A query for several rays.
struct Asked<'r> {
    rays: &'r [Ray],
    min: f64,
    /// Their origins.
    from: &'r [Option<&'r Origin>; PACKET],
    class: RayClass,
    /// The primitive to test before all others, or [`NONE`].
    first: u32,
}

/// A search of a group for several rays.
struct Together<'v, 'w, 's, Q> {
    shared: &'v mut Shared<'w, 's>,
    group: &'s RenderGroup,
    blocks: &'s Blocks,
    asked: &'v Asked<'v>,
    place: Place,
    from_prims: [u32; PACKET],
    /// Empty where no primitive needs them.
    shears: &'v [RayShear],
    culls: PacketCulls<'v>,
    /// Whether the memory has these rays coordinate by coordinate: once a shape needs them.
    has_coordinates: bool,
    unfiltered: bool,
    queries: &'v mut [Q; PACKET],
}

impl<Q: Query> Together<'_, '_, '_, Q> {
    /// Tests the primitives of a leaf for several rays.
    #[inline(always)]
    fn leaf_of_blocks<I: Isa, B: BlockOfLeaf>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        let mut hits = Hits::default();
        for index in 0..leaf.blocks() {
            let found = B::of(self.group, self.blocks, leaf, index);
            self.block::<I, B>(isa, leaf, index, found.borrow(), &mut hits, lanes, t_max);
        }
    }

    /// Tests the flat primitives of a leaf for several rays.
    #[inline(always)]
    fn leaf_of_flats<I: Isa>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        let mut hits = Hits::default();
        for index in 0..leaf.blocks() {
            match self.blocks.flats(leaf.first_block + index) {
                Flats::Triangles(block) => {
                    self.block(isa, leaf, index, block, &mut hits, lanes, t_max);
                }
                Flats::Polygons(block) => {
                    for lane in lanes_of(lanes) {
                        let before = t_max[lane];
                        if before > f64::NEG_INFINITY {
                            t_max[lane] = of_lane!(self, lane, before, visitor =>
                                visitor.polygons(isa, leaf, index, block, before));
                        }
                    }
                }
            }
        }
    }

    /// Tests the primitives of one block of a leaf for several rays.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "the inner loop, inlined into its two callers"
    )]
    fn block<I: Isa, B: Block>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        index: usize,
        block: &B,
        hits: &mut Hits,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        let used = leaf.count - index * BLOCK;
        let mut left = lanes;
        if fill_packet(lanes) {
            left &= block.may_hit(isa, &self.culls, used);
        }
        for lane in lanes_of(left) {
            let before = t_max[lane];
            if before > f64::NEG_INFINITY {
                t_max[lane] = of_lane!(self, lane, before, visitor =>
                    visitor.block(isa, leaf, index, block, hits, before));
            }
        }
    }
}

impl<Q: Query> PacketVisitor for Together<'_, '_, '_, Q> {
    const ANY: bool = Q::ANY;

    fn visit(&mut self, id: u32, lane: usize, t_max: f64) -> f64 {
        of_lane!(self, lane, t_max, visitor => visitor.visit(id, t_max))
    }

    fn visit_together(&mut self, id: u32, lanes: u32, t_max: &mut [f64; PACKET]) {
        let prim = self.group.prims.at(id);
        if prim.visible & self.shared.class == 0 || !self.queries[0].wants(prim.flags) {
            return;
        }
        if let Some(index) = prim.unfiltered_shape().filter(|_| !Q::WATCHES) {
            self.unfiltered_shape(id, index, lanes, t_max);
            return;
        }
        if let PrimKind::Instance(index) = prim.kind()
            && fill_packet(lanes)
            && self.place.depth < Place::DEEPEST
        {
            self.instance(id, index, lanes, t_max);
            return;
        }
        for lane in lanes_of(lanes) {
            let before = t_max[lane];
            if before > f64::NEG_INFINITY {
                t_max[lane] =
                    of_lane!(self, lane, before, visitor => visitor.visit_any(id, prim, before));
            }
        }
    }

    #[inline(always)]
    fn visit_leaf<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, lane: usize, t_max: f64) -> f64 {
        of_lane!(self, lane, t_max, visitor => visitor.visit_leaf(isa, leaf, t_max))
    }

    #[inline(always)]
    fn visit_leaf_together<I: Isa>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        match LeafClass::from_number(leaf.class) {
            LeafClass::Mesh if self.blocks.fetches() => {
                self.leaf_of_blocks::<I, Fetched>(isa, leaf, lanes, t_max);
            }
            LeafClass::Mesh => {
                self.leaf_of_blocks::<I, TriangleBlock<f32>>(isa, leaf, lanes, t_max);
            }
            LeafClass::Flats => self.leaf_of_flats(isa, leaf, lanes, t_max),
            LeafClass::Spheres => self.leaf_of_blocks::<I, SphereBlock>(isa, leaf, lanes, t_max),
            LeafClass::Single => {
                for id in leaf.ids() {
                    self.visit_together(*id, lanes, t_max);
                }
            }
        }
    }
}
