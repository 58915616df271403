mod kinds;
mod leaves;
mod packet;
mod plain;

use crate::activity::{Phase, Slot};
use crate::blocks::{Blocks, Fetched, LeafClass};
use crate::hit::{Hit, Origin, RayClass};
use crate::prim::{Prim, PrimKind};
use crate::resolve::Resolved;
use crate::scene::{InstanceUse, RenderGroup, RenderScene};
use crate::walk::WalkEvent;
use kinds::{AnyOpaque, Closest, Query, Transmitting, Watched};
use plain::Plain;
use std::sync::Arc;
use strahl_accel::{Accelerator, AnyAccelerator, Leaf, Step, TraversalStats, Visitor};
use strahl_geometry::blocks::{SphereBlock, TriangleBlock};
use strahl_geometry::{PrimHit, Primitive, RayShear, Scratch, SurfaceId};
use strahl_math::{Interval, Ray};
use strahl_shade::Sides;
use strahl_simd::Isa;

/// Finds the intersections of rays with a scene; owns the working memory of one thread.
#[derive(Debug)]
pub struct Tracer<'s> {
    pub(crate) scene: &'s RenderScene,
    pub(crate) scratch: Scratch,
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

impl<'s> Tracer<'s> {
    /// For one scene and one thread.
    pub fn new(scene: &'s RenderScene) -> Self {
        Self {
            scene,
            scratch: Scratch::default(),
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

    /// [`Tracer::closest_hit`], reporting every step of the traversal.
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
        let mut query = AnyOpaque { found: None };
        self.search(ray, range, from, RayClass::Shadow, NONE, &mut query);
        query.found.is_some()
    }

    /// [`Tracer::any_opaque`] for a ray to a light, testing the last occluder of that light first: the answer is the same,
    /// found sooner.
    #[inline]
    pub(crate) fn occluded(
        &mut self,
        ray: &Ray,
        range: Interval,
        from: &Origin,
        light: usize,
    ) -> bool {
        let mut query = AnyOpaque { found: None };
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

    /// Forgets the last occluders, so that the cost of the following queries does not depend on earlier ones.
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
        let part = if self.parts { Q::part(group) } else { None };
        let (accelerator, blocks, sheared) = match part {
            None => (&group.accelerator, &group.blocks, group.sheared),
            Some(part) => (&part.accelerator, &part.blocks, part.sheared),
        };
        let plain = group.common.is_some_and(|(visible, flags)| {
            visible & self.class != 0 && self.query.is_plain(flags)
        });
        let mut alone = None;
        if Q::HAS_FAST_SEARCH
            && plain
            && let AnyAccelerator::Bvh8(bvh) = accelerator
            && let Some(blocks) = blocks.of_one_kind()
            && bvh.has_leaves_only()
        {
            let searched = Plain {
                bvh,
                blocks,
                first_ids: group.first_ids.as_deref(),
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
            plain,
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

struct GroupVisitor<'v, 'a, 's, Q> {
    search: &'v mut Search<'a, 's, Q>,
    group: &'v RenderGroup,
    /// The primitives in the order of the leaves.
    blocks: &'v Blocks,
    ray: &'v Ray,
    shear: &'v RayShear,
    range_min: f64,
    from: From<'v>,
    /// The primitive the ray starts on, or `u32::MAX`.
    from_prim: u32,
    base: u64,
    t_max: f64,
    /// Whether hits in blocks need no further checks (see [`RenderGroup::common`]).
    plain: bool,
}

impl<Q: Query> Visitor for GroupVisitor<'_, '_, '_, Q> {
    const WATCHES: bool = Q::WATCHES;
    const ANY: bool = Q::ANY;

    #[inline(always)]
    fn visit_leaf<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, t_max: f64) -> f64 {
        // With an observer every test is made and reported one by one.
        let class = match Q::WATCHES {
            true => LeafClass::Single,
            false => LeafClass::from_number(leaf.class),
        };
        match class {
            LeafClass::Mesh if self.blocks.fetches() => self.blocks::<I, Fetched>(isa, leaf, t_max),
            LeafClass::Mesh => self.blocks::<I, TriangleBlock<f32>>(isa, leaf, t_max),
            LeafClass::Flats => self.flats(isa, leaf, t_max),
            LeafClass::Spheres => self.blocks::<I, SphereBlock>(isa, leaf, t_max),
            LeafClass::Single => {
                let mut t_max = t_max;
                for id in leaf.ids() {
                    t_max = self.visit(*id, t_max);
                    if t_max == f64::NEG_INFINITY {
                        break;
                    }
                }
                t_max
            }
        }
    }

    fn step(&mut self, step: Step) {
        self.search.query.tell(WalkEvent::Step(step));
    }

    #[inline]
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let prim = self.group.prims.at(id);
        if prim.visible & self.search.class == 0 || !self.search.query.wants(prim.flags) {
            return t_max;
        }
        // Most primitives of most scenes.
        if !Q::ALL
            && !Q::WATCHES
            && let Some(index) = prim.plain_shape()
        {
            return self.plain_shape(id, index, t_max);
        }
        self.visit_any(id, prim, t_max)
    }
}

impl<Q: Query> GroupVisitor<'_, '_, '_, Q> {
    /// Tests a shape whose hits need no further checks.
    #[inline(always)]
    fn plain_shape(&mut self, id: u32, index: u32, t_max: f64) -> f64 {
        let first = self.group.first_id(id);
        let number = self.base + first;
        let from = match self.from {
            Some((origin, from)) if id == self.from_prim => Some(SurfaceId {
                element: (from - first) as u32,
                facet: origin.facet,
            }),
            _ => None,
        };
        let (shape, slot) = (&self.group.shapes[index as usize].shape, self.search.slot);
        slot.enter_for(Phase::Intersection, number);
        let range = Interval::new(self.range_min, t_max);
        let scratch = &mut *self.search.scratch;
        let found = if Q::ANY {
            // Where the ray meets it does not matter.
            let met = shape.any_hit(self.ray, range, from, scratch);
            met.then_some(PrimHit {
                t: t_max,
                surface: SurfaceId {
                    element: 0,
                    facet: 0,
                },
                uv: [0.0; 2],
            })
        } else {
            shape.closest_hit(self.ray, range, from, scratch)
        };
        slot.enter(Phase::Traversal);
        let Some(found) = found else {
            return t_max;
        };
        let hit = Hit {
            t: found.t,
            id: number + u64::from(found.surface.element),
            facet: found.surface.facet,
            uv: found.uv,
        };
        self.t_max = self.search.query.take(hit, t_max);
        self.t_max
    }

    /// Visits a primitive of any kind, which the query wants.
    #[inline(never)]
    fn visit_any(&mut self, id: u32, prim: Prim, t_max: f64) -> f64 {
        let first = self.group.first_id(id);
        let from = if id == self.from_prim {
            self.from.map(|(origin, number)| (origin, number - first))
        } else {
            None
        };
        self.t_max = match prim.kind() {
            PrimKind::Instance(index) => self.instance(index, t_max, from, first),
            _ => self.simple(id, prim, t_max, from, first),
        };
        if Q::WATCHES && !matches!(prim.kind(), PrimKind::Instance(_)) {
            self.search.query.tell(WalkEvent::Test {
                id: self.base + first,
                object: self.group.look(id, 0).object,
                closest: self.t_max.is_finite().then_some(self.t_max),
                found: self.t_max < t_max,
            });
        }
        self.t_max
    }
}

impl<Q: Query> GroupVisitor<'_, '_, '_, Q> {
    /// Whether the ray sees the front of a one-sided flat primitive, as far as that can be decided without a hit.
    #[inline(always)]
    fn facing(&self, id: u32, prim: Prim) -> Option<bool> {
        match prim.flags & Prim::ONE_SIDED {
            0 => None,
            _ => self.group.shows_front(id, self.ray.direction),
        }
    }

    fn instance(&mut self, index: u32, t_max: f64, from: From<'_>, first: u64) -> f64 {
        let instance = &self.group.instances[index as usize];
        let inner = &self.search.scene.groups[instance.group as usize];
        let mut ray = instance.transform.ray_to_object(self.ray);
        if let Some((origin, number)) = from {
            // The origin lies in this space, not in one further inside, and is exact here.
            let prim = inner.prims.at(inner.prim_of(number));
            if !matches!(prim.kind(), PrimKind::Instance(_)) {
                ray.origin = origin.local;
            }
        }
        let range = Interval::new(self.range_min, t_max);
        if Q::WATCHES {
            let id = self.base + first;
            self.search.query.tell(WalkEvent::Enter { id });
        }
        let t_max = self
            .search
            .group(inner, &ray, range, from, self.base + first, NONE);
        if Q::WATCHES {
            self.search.query.tell(WalkEvent::Leave);
        }
        t_max
    }

    #[inline]
    fn simple(&mut self, id: u32, prim: Prim, t_max: f64, from: From<'_>, first: u64) -> f64 {
        let from = from.map(|(origin, number)| SurfaceId {
            element: number as u32,
            facet: origin.facet,
        });
        // Flat primitives that face away need no test.
        let facing = self.facing(id, prim);
        if facing == Some(false) {
            return t_max;
        }
        let front = facing.is_some();
        if Q::ALL && matches!(prim.kind(), PrimKind::Shape(_) | PrimKind::Placed(_)) {
            return self.all_of_shape(id, prim, t_max, from, first, front);
        }
        let (mut min, mut t_max) = (self.range_min, t_max);
        loop {
            let slot = self.search.slot;
            slot.enter_for(Phase::Intersection, self.base + first);
            let found = self.test(prim.kind(), Interval::new(min, t_max), from);
            slot.enter(Phase::Traversal);
            let Some(found) = found else {
                return t_max;
            };
            if let Some(closer) = self.take_met(id, prim, &found, t_max, first, front) {
                t_max = closer;
                if !Q::ALL {
                    return t_max;
                }
            }
            // Continue behind this hit; the lower end of a range is open.
            min = found.t;
            if min >= t_max {
                return t_max;
            }
        }
    }

    /// Takes all hits on a shape at once, which then has to be intersected only once.
    fn all_of_shape(
        &mut self,
        id: u32,
        prim: Prim,
        mut t_max: f64,
        from: Option<SurfaceId>,
        first: u64,
        front: bool,
    ) -> f64 {
        let (PrimKind::Shape(index) | PrimKind::Placed(index)) = prim.kind() else {
            return t_max;
        };
        let used = &self.group.shapes[index as usize];
        let map = used.transform.as_ref();
        let ray = map.map_or(*self.ray, |m| m.ray_to_object(self.ray));
        let range = Interval::new(self.range_min, t_max);
        let slot = self.search.slot;
        slot.enter_for(Phase::Intersection, self.base + first);
        let mut hits = self.search.scratch.take_hits();
        let scratch = &mut *self.search.scratch;
        used.shape.all_hits(&ray, range, from, scratch, &mut hits);
        slot.enter(Phase::Traversal);
        for found in &hits {
            if let Some(closer) = self.take_met(id, prim, found, t_max, first, front) {
                t_max = closer;
            }
        }
        self.search.scratch.give_hits(hits);
        t_max
    }

    /// Takes a hit on a primitive, if there is something at that place and the query wants it; returns the new upper end of the
    /// range. `front` says that it is known not to be on the back.
    #[inline]
    fn take_met(
        &mut self,
        id: u32,
        prim: Prim,
        found: &PrimHit,
        t_max: f64,
        first: u64,
        front: bool,
    ) -> Option<f64> {
        let hit = Hit {
            t: found.t,
            id: self.base + first + u64::from(found.surface.element),
            facet: found.surface.facet,
            uv: found.uv,
        };
        let exists =
            prim.flags & Prim::FILTERED == 0 || self.exists(id, prim, &hit, found.surface, front);
        let mixed = prim.flags & (Prim::TRANSMITS | Prim::STOPS) == Prim::TRANSMITS | Prim::STOPS;
        let wanted = !mixed || {
            let look = self.group.look(id, found.surface.element);
            let transmits = self.search.scene.transmits(look);
            self.search.query.wants_hit(transmits)
        };
        (exists && wanted).then(|| self.search.query.take(hit, t_max))
    }

    #[inline]
    fn test(
        &mut self,
        kind: PrimKind,
        range: Interval,
        from: Option<SurfaceId>,
    ) -> Option<PrimHit> {
        match kind {
            PrimKind::Triangle(mesh, triangle) => {
                if from.is_some() {
                    return None;
                }
                let mesh = &self.group.meshes[mesh as usize].mesh;
                let hit = mesh.hit_element(triangle, self.shear, range)?;
                // Outside of the mesh every triangle counts as a primitive of one element.
                Some(PrimHit {
                    surface: SurfaceId {
                        element: 0,
                        ..hit.surface
                    },
                    ..hit
                })
            }
            PrimKind::Sphere(number) => {
                let sphere = self.group.spheres.get(number, &self.group.blocks);
                sphere.closest_hit(self.ray, range, from, self.search.scratch)
            }
            PrimKind::Shape(index) => {
                let shape = &self.group.shapes[index as usize].shape;
                shape.closest_hit(self.ray, range, from, self.search.scratch)
            }
            PrimKind::Placed(index) => {
                let used = &self.group.shapes[index as usize];
                let ray = used
                    .transform
                    .as_ref()
                    .map_or(*self.ray, |m| m.ray_to_object(self.ray));
                used.shape
                    .closest_hit(&ray, range, from, self.search.scratch)
            }
            PrimKind::Instance(_) => unreachable!("instances are searched, not tested"),
        }
    }

    /// Whether a hit counts: not on the back of a one-sided surface, nor in a hole of an alpha mask. `front` says that it is
    /// known not to be on the back.
    #[inline]
    fn exists(&self, id: u32, prim: Prim, hit: &Hit, surface: SurfaceId, front: bool) -> bool {
        front && prim.flags & Prim::MASKED == 0 || self.exists_there(id, hit, surface)
    }

    fn exists_there(&self, id: u32, hit: &Hit, surface: SurfaceId) -> bool {
        let look = self.group.look(id, surface.element);
        let material = &self.search.scene.materials[look.material.0 as usize];
        let masked = material.is_masked();
        let mut point = Resolved::UNKNOWN.point;
        self.group
            .store_surface(id, self.ray, hit, surface.element, masked, &mut point);
        let front = point.n_geom.dot(self.ray.direction) < 0.0;
        if material.sides == Sides::Front && !front {
            return false;
        }
        !masked || material.at(point.uv).opacity > 0.0
    }
}

impl RenderScene {
    /// Whether the material of an element transmits light.
    pub(crate) fn transmits(&self, look: crate::look::Look) -> bool {
        crate::compile::material_transmits(&self.materials[look.material.0 as usize])
    }
}
