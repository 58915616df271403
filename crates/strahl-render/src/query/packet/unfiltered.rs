//! Tests of shapes whose hits need no filter, for the rays of a packet.

use super::super::kinds::Query;
use super::super::shapes::UnfilteredShape;
use super::{PacketMemory, Together, are_dense, fill_packet};
use crate::activity::Phase;
use crate::hit::Hit;
use crate::uses::EarlyBox;
use strahl_accel::{PACKET, lanes_of};
use strahl_geometry::blocks::{PacketRays, PacketSearch, PacketSpans};
use strahl_geometry::{Csg, PacketRanges, PrimHit, Primitive, Scratch, Shape, SurfaceId};
use strahl_math::{Interval, Ray};

impl<Q: Query> Together<'_, '_, '_, Q> {
    /// Tests a shape whose hits need no filter for several rays.
    #[inline(never)]
    pub(super) fn unfiltered_shape(
        &mut self,
        id: u32,
        index: u32,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        let shape = UnfilteredShape::of(self.group, id, index, self.place.base);
        self.shared
            .slot
            .enter_for(Phase::Intersection, shape.number);
        let lanes = self.lanes_near(&shape, lanes, t_max);
        if lanes == 0 {
            self.shared.slot.enter(Phase::Traversal);
            return;
        }
        let side_by_side = match (shape.shape, shape.transform) {
            // The test of a box along the axes takes too little time.
            (Shape::Cuboid(_), None) => false,
            (Shape::Csg(tree), _) if tree.goes_in_packets() && fill_packet(lanes) => {
                self.meet_tree(id, &shape, tree, lanes, t_max);
                self.shared.slot.enter(Phase::Traversal);
                return;
            }
            (shape, _) => {
                let known = match Q::ALL {
                    true => PacketSpans::know(shape),
                    false => PacketSpans::know_first(shape),
                };
                known && are_dense(lanes & !self.lanes_from(id))
            }
        };
        if Q::ALL {
            self.meet_all(id, &shape, side_by_side, lanes, t_max);
            self.shared.slot.enter(Phase::Traversal);
            return;
        }
        match (shape.shape, shape.transform) {
            // Nearly every scene has a plane, and all rays are tested for it: the test is compiled into the loop.
            (Shape::Plane(plane), None) => {
                self.meet_together(id, &shape, lanes, t_max, |ray, range, from, scratch| {
                    shape.meet_as::<Q, _>(plane, ray, range, from, scratch)
                });
            }
            _ if side_by_side => self.meet_spans(id, &shape, lanes, t_max),
            _ => self.meet_together(id, &shape, lanes, t_max, |ray, range, from, scratch| {
                shape.meet::<Q>(ray, range, from, scratch)
            }),
        }
        self.shared.slot.enter(Phase::Traversal);
    }

    /// The lanes whose rays start on a primitive.
    #[inline]
    fn lanes_from(&self, id: u32) -> u32 {
        let mut lanes = 0;
        for (lane, from) in self.from_prims.iter().enumerate() {
            lanes |= u32::from(*from == id) << lane;
        }
        lanes
    }

    /// Those of the lanes whose rays may meet a shape, as far as its box tells.
    #[inline(always)]
    fn lanes_near(
        &mut self,
        shape: &UnfilteredShape<'_>,
        lanes: u32,
        t_max: &[f64; PACKET],
    ) -> u32 {
        let min = self.asked.min;
        match shape.early_box {
            None => match (shape.shape, shape.transform) {
                // Its own test takes as long for each ray as that of the box does for four.
                (Shape::Polygon(polygon), None) if fill_packet(lanes) => {
                    let bounds = polygon.bounds();
                    self.coordinates()
                        .may_meet(&bounds, None, lanes, min, t_max)
                }
                _ => lanes,
            },
            Some(EarlyBox::Own(own)) => {
                let map = shape.transform;
                self.coordinates().may_meet(own, map, lanes, min, t_max)
            }
            Some(EarlyBox::Bounds(bounds)) => {
                let Interval { min, max } = Interval::FORWARD;
                let everywhere = &[max; PACKET];
                self.coordinates()
                    .may_meet(bounds, None, lanes, min, everywhere)
            }
        }
    }

    /// The rays coordinate by coordinate.
    #[inline]
    fn coordinates(&mut self) -> &PacketRays {
        self.find_coordinates();
        &self.shared.memory.coordinates
    }

    #[inline]
    fn find_coordinates(&mut self) {
        if !self.has_coordinates {
            self.shared.memory.coordinates.set(self.asked.rays);
            self.has_coordinates = true;
        }
    }

    /// The surface of a shape that the ray of a lane starts on, if it starts on this primitive.
    #[inline(always)]
    fn start_on(&self, id: u32, shape: &UnfilteredShape<'_>, lane: usize) -> Option<SurfaceId> {
        let origin = self.asked.from[lane].filter(|_| self.from_prims[lane] == id)?;
        Some(shape.start(origin, origin.id - self.place.base))
    }

    /// Tests a tree for several rays: its leaves four side by side.
    fn meet_tree(
        &mut self,
        id: u32,
        shape: &UnfilteredShape<'_>,
        tree: &Csg,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        let starting = self.lanes_from(id);
        let ranges = PacketRanges {
            rays: self.asked.rays,
            min: self.asked.min,
            t_max,
            starting,
        };
        let map = shape.transform;
        self.shared.memory.tree.find(tree, &ranges, map, lanes);
        let mut found = self.shared.scratch.take_hits();
        for (place, lane) in lanes_of(lanes).enumerate() {
            let before = t_max[lane];
            if !(before > f64::NEG_INFINITY) {
                continue;
            }
            let range = Interval::new(self.asked.min, before);
            let from = self.start_on(id, shape, lane);
            let ray = &self.asked.rays[lane];
            let inner = map.map_or(*ray, |map| map.ray_to_object(ray));
            let scratch = &mut *self.shared.scratch;
            let (known, query) = (&self.shared.memory.tree, &mut self.queries[lane]);
            if Q::ALL {
                found.clear();
                if !known.all(tree, place, &inner, range, from, scratch, &mut found) {
                    found.clear();
                    tree.all_hits(&inner, range, from, scratch, &mut found);
                }
                for hit in &found {
                    t_max[lane] = query.take(shape.hit(hit), t_max[lane]);
                }
                continue;
            }
            let hit = match known.closest(tree, place, &inner, range, from, scratch) {
                Some(hit) => hit,
                None => tree.closest_hit(&inner, range, from, scratch),
            };
            if let Some(hit) = hit {
                let hit = match Q::ANY {
                    true => PrimHit::simple(range.max, 0),
                    false => hit,
                };
                t_max[lane] = query.take(shape.hit(&hit), before);
            }
        }
        self.shared.scratch.give_hits(found);
    }

    /// Finds where those of several rays that don't start on a shape are inside of it or first meet it, four side by side.
    fn find_spans(
        &mut self,
        id: u32,
        shape: &UnfilteredShape<'_>,
        lanes: u32,
        t_max: &[f64; PACKET],
    ) {
        let elsewhere = lanes & !self.lanes_from(id);
        self.find_coordinates();
        let PacketMemory {
            spans, coordinates, ..
        } = &mut *self.shared.memory;
        let search = PacketSearch {
            rays: coordinates,
            map: shape.transform,
            lanes: elsewhere,
            min: self.asked.min,
            t_max,
        };
        spans.find(shape.shape, &search);
    }

    /// Takes all hits of several rays on a shape, found four `side_by_side` or one by one.
    fn meet_all(
        &mut self,
        id: u32,
        shape: &UnfilteredShape<'_>,
        side_by_side: bool,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        if side_by_side {
            self.find_spans(id, shape, lanes, t_max);
        }
        let mut found = self.shared.scratch.take_hits();
        for lane in lanes_of(lanes) {
            if !(t_max[lane] > f64::NEG_INFINITY) {
                continue;
            }
            let range = Interval::new(self.asked.min, t_max[lane]);
            let from = self.start_on(id, shape, lane);
            found.clear();
            let known = side_by_side
                && from.is_none()
                && self
                    .shared
                    .memory
                    .spans
                    .all(shape.shape, lane, range, &mut found);
            if !known {
                let ray = &self.asked.rays[lane];
                shape.meet_all(ray, range, from, self.shared.scratch, &mut found);
            }
            for hit in &found {
                t_max[lane] = self.queries[lane].take(shape.hit(hit), t_max[lane]);
            }
        }
        self.shared.scratch.give_hits(found);
    }

    /// Tests a shape for several rays: four side by side.
    fn meet_spans(
        &mut self,
        id: u32,
        shape: &UnfilteredShape<'_>,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        self.find_spans(id, shape, lanes, t_max);
        for lane in lanes_of(lanes) {
            let before = t_max[lane];
            if !(before > f64::NEG_INFINITY) {
                continue;
            }
            let range = Interval::new(self.asked.min, before);
            let ray = &self.asked.rays[lane];
            let from = self.start_on(id, shape, lane);
            let known = match from {
                None => shape.meet_known::<Q>(&self.shared.memory.spans, lane, range),
                Some(_) => None,
            };
            let hit = match known {
                Some(hit) => hit,
                None => shape.meet::<Q>(ray, range, from, self.shared.scratch),
            };
            if let Some(hit) = hit {
                t_max[lane] = self.queries[lane].take(hit, before);
            }
        }
    }

    /// Tests a shape for several rays one by one.
    #[inline(always)]
    fn meet_together(
        &mut self,
        id: u32,
        shape: &UnfilteredShape<'_>,
        lanes: u32,
        t_max: &mut [f64; PACKET],
        meet: impl Fn(&Ray, Interval, Option<SurfaceId>, &mut Scratch) -> Option<Hit>,
    ) {
        for lane in lanes_of(lanes) {
            let before = t_max[lane];
            if !(before > f64::NEG_INFINITY) {
                continue;
            }
            let from = self.start_on(id, shape, lane);
            let range = Interval::new(self.asked.min, before);
            if let Some(hit) = meet(&self.asked.rays[lane], range, from, self.shared.scratch) {
                t_max[lane] = self.queries[lane].take(hit, before);
            }
        }
    }
}
