mod block;
mod kinds;
mod leaves;
mod packet;
mod shapes;
mod unfiltered;
mod visitor;

use crate::activity::{Phase, Slot};
use crate::hit::{Hit, Origin, RayClass};
use crate::scene::{RenderGroup, RenderScene};
use crate::uses::InstanceUse;
pub use kinds::WalkEvent;
use kinds::{Any, Closest, Query, Transmitting, Watched};
pub(crate) use packet::PACKET_MIN;
use packet::PacketMemory;
use std::sync::Arc;
use strahl_accel::{Accelerator, AnyAccelerator, TraversalStats, Visitor};
use strahl_geometry::{RayShear, Scratch};
use strahl_math::{Interval, Ray};
use unfiltered::Unfiltered;
use visitor::GroupVisitor;

/// Finds the intersections of rays with a scene; owns the working memory of one thread.
#[derive(Debug)]
pub struct Intersector<'s> {
    pub(crate) scene: &'s RenderScene,
    pub(crate) scratch: Scratch,
    packet: PacketMemory,
    /// The cost of all queries so far.
    pub stats: TraversalStats,
    /// For each light the primitive of the world that blocked it last: likely to block it again.
    occluders: Vec<u32>,
    /// Whether to test that primitive first.
    pub(crate) remembers: bool,
    /// What this thread is doing.
    pub(crate) slot: Arc<Slot>,
}

/// No primitive.
const NONE: u32 = u32::MAX;

impl<'s> Intersector<'s> {
    /// For one scene and one thread.
    pub fn new(scene: &'s RenderScene) -> Self {
        Self {
            scene,
            scratch: Scratch::default(),
            packet: PacketMemory::default(),
            stats: TraversalStats::default(),
            occluders: vec![NONE; scene.lights.len()],
            remembers: true,
            slot: Arc::default(),
        }
    }

    /// The nearest hit in `range`; of several at the same `t` the one with the smallest id.
    #[inline]
    pub fn closest_hit(
        &mut self,
        ray: &Ray,
        range: Interval,
        from: Option<&Origin>,
        class: RayClass,
    ) -> Option<Hit> {
        let mut query: Closest = None;
        self.search(ray, range, from, class, NONE, &mut query);
        query
    }

    /// [`Intersector::closest_hit`], reporting every step of the traversal.
    pub(crate) fn watched_hit(
        &mut self,
        ray: &Ray,
        range: Interval,
        class: RayClass,
        events: &mut Vec<WalkEvent>,
    ) -> Option<Hit> {
        let mut query = Watched {
            closest: None,
            opaque: false,
            events: Some(events),
        };
        self.search(ray, range, None, class, NONE, &mut query);
        query.closest
    }

    /// The nearest hit in `range` on an opaque surface.
    #[cold]
    pub(crate) fn closest_opaque(
        &mut self,
        ray: &Ray,
        range: Interval,
        from: Option<&Origin>,
    ) -> Option<Hit> {
        let mut query = Watched {
            closest: None,
            opaque: true,
            events: None,
        };
        self.search(ray, range, from, RayClass::Shadow, NONE, &mut query);
        query.closest
    }

    /// Whether an opaque surface is in `range`.
    #[inline]
    pub fn any_opaque(&mut self, ray: &Ray, range: Interval, from: Option<&Origin>) -> bool {
        let mut query = Any::OPAQUE;
        self.search(ray, range, from, RayClass::Shadow, NONE, &mut query);
        query.found.is_some()
    }

    /// [`Intersector::any_opaque`] for a ray to a light, testing the last occluder of that light first: the answer is the same,
    /// found sooner.
    #[inline]
    pub(crate) fn occluded(
        &mut self,
        ray: &Ray,
        range: Interval,
        from: &Origin,
        light: usize,
    ) -> bool {
        let mut query = Any::OPAQUE;
        self.search(
            ray,
            range,
            Some(from),
            RayClass::Shadow,
            self.occluders[light],
            &mut query,
        );
        self.remember(light, query.found);
        query.found.is_some()
    }

    /// Remembers what blocked a light, or that nothing did: where one ray reaches the light, the next one probably will.
    #[inline]
    fn remember(&mut self, light: usize, found: Option<u64>) {
        if self.remembers {
            self.occluders[light] = found.map_or(NONE, |id| self.scene.groups[0].prim_of(id));
        }
    }

    /// Where in `range` a ray first crosses the mask of a light, a group that other rays don't see.
    #[cold]
    pub(crate) fn crossing(
        &mut self,
        mask: &InstanceUse,
        ray: &Ray,
        range: Interval,
    ) -> Option<f64> {
        let mut query: Closest = None;
        let group = self.scene.groups.get(mask.group as usize)?;
        let inner = mask.transform.ray_to_object(ray);
        let mut search = Search {
            scene: self.scene,
            scratch: &mut self.scratch,
            stats: &mut self.stats,
            // Its primitives have no numbers in the scene.
            slot: &Slot::default(),
            class: u8::MAX,
            parts: false,
            query: &mut query,
        };
        search.group(group, &inner, range, None, 0, NONE);
        query.map(|hit| hit.t)
    }

    /// Forgets what the last rays to lights met, so that the cost of the following queries does not depend on earlier ones.
    pub(crate) fn forget_occluders(&mut self) {
        self.occluders.fill(NONE);
    }

    /// All hits in `range` on primitives that may transmit light, in no particular order. Hits on a primitive that lies in
    /// several cells may be repeated.
    pub(crate) fn transmitting_hits(
        &mut self,
        ray: &Ray,
        range: Interval,
        from: Option<&Origin>,
        hits: &mut Vec<Hit>,
    ) {
        self.search(
            ray,
            range,
            from,
            RayClass::Shadow,
            NONE,
            &mut Transmitting { hits },
        );
    }

    #[inline]
    fn search<Q: Query>(
        &mut self,
        ray: &Ray,
        range: Interval,
        from: Option<&Origin>,
        class: RayClass,
        first: u32,
        query: &mut Q,
    ) {
        self.slot.enter(Phase::Traversal);
        let mut search = Search {
            scene: self.scene,
            scratch: &mut self.scratch,
            stats: &mut self.stats,
            slot: &self.slot,
            class: class.bit(),
            parts: self.remembers,
            query,
        };
        let from = from.map(|o| (o, o.id));
        search.group(&self.scene.groups[0], ray, range, from, 0, first);
    }
}

/// The origin of the ray, and the number of its element relative to the group being searched.
type From<'o> = Option<(&'o Origin, u64)>;

struct Search<'a, 's, Q> {
    scene: &'s RenderScene,
    scratch: &'a mut Scratch,
    stats: &'a mut TraversalStats,
    slot: &'a Slot,
    class: u8,
    /// Whether to search only the part of a group that matters to the query.
    parts: bool,
    query: &'a mut Q,
}

impl<Q: Query> Search<'_, '_, Q> {
    /// Searches a group, testing primitive `first` before all others if there is one; `base` is the number of the group's first
    /// element. Returns the new upper end of the range.
    #[inline]
    fn group(
        &mut self,
        group: &RenderGroup,
        ray: &Ray,
        range: Interval,
        from: From<'_>,
        base: u64,
        first: u32,
    ) -> f64 {
        let from_prim = from.map_or(NONE, |(_, id)| group.prim_of(id));
        let part = if self.parts {
            self.query.part(group)
        } else {
            None
        };
        let (accelerator, blocks, sheared) = match part {
            None => (&group.accelerator, &group.blocks, group.sheared),
            Some(part) => (&part.accelerator, &part.blocks, part.sheared),
        };
        let unfiltered = group.uniform_flags.is_some_and(|(visible, flags)| {
            visible & self.class != 0 && self.query.is_unfiltered(flags)
        });
        let mut alone = None;
        if Q::HAS_FAST_SEARCH
            && unfiltered
            && let AnyAccelerator::Bvh8(bvh) = accelerator
            && let Some(blocks) = blocks.of_one_kind()
            && bvh.has_leaves_only()
        {
            let searched = Unfiltered {
                bvh,
                blocks,
                first_ids: group.first_ids.as_ref(),
                from_prim,
                base,
            };
            if first == NONE {
                return searched.search(ray, range, self);
            }
            alone = Some(searched);
        }
        let mut stats = TraversalStats::default();
        let shear = if sheared {
            RayShear::new(ray)
        } else {
            RayShear::UNUSED
        };
        let mut visitor = GroupVisitor {
            search: self,
            group,
            blocks,
            ray,
            shear: &shear,
            range_min: range.min,
            from,
            from_prim,
            base,
            t_max: range.max,
            unfiltered,
        };
        if first != NONE {
            stats.primitive_tests += 1;
            visitor.visit(first, range.max);
        }
        if visitor.t_max != f64::NEG_INFINITY {
            if Q::HAS_FAST_SEARCH
                && let Some(searched) = alone
            {
                let range = range.with_max(visitor.t_max);
                *self.stats += stats;
                return searched.search(ray, range, self);
            }
            accelerator.traverse(ray, range, &mut visitor, &mut stats);
        }
        let t_max = visitor.t_max;
        *self.stats += stats;
        t_max
    }
}

impl RenderScene {
    /// Whether the material of an element transmits light.
    pub(crate) fn transmits(&self, appearance: crate::appearance::Appearance) -> bool {
        self.transmitting[appearance.material.0 as usize]
    }
}
