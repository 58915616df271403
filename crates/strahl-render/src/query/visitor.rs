//! The primitives that a ray may meet, in one group: what the traversal finds is tested here.

use super::block::Fetched;
use super::kinds::{Query, WalkEvent};
use super::shapes::UnfilteredShape;
use super::{From, NONE, Search};
use crate::activity::Phase;
use crate::blocks::{Blocks, LeafClass};
use crate::hit::Hit;
use crate::prim::{Prim, PrimKind};
use crate::resolve::Resolved;
use crate::scene::RenderGroup;
use strahl_accel::{Leaf, Step, Visitor};
use strahl_geometry::blocks::{SphereBlock, TriangleBlock};
use strahl_geometry::{PrimHit, Primitive, RayShear, SurfaceId};
use strahl_math::{Interval, Ray};
use strahl_shade::Sides;
use strahl_simd::Isa;

pub(super) struct GroupVisitor<'v, 'a, 's, Q> {
    pub(super) search: &'v mut Search<'a, 's, Q>,
    pub(super) group: &'v RenderGroup,
    /// The primitives in the order of the leaves.
    pub(super) blocks: &'v Blocks,
    pub(super) ray: &'v Ray,
    pub(super) shear: &'v RayShear,
    pub(super) range_min: f64,
    pub(super) from: From<'v>,
    /// The primitive the ray starts on, or `u32::MAX`.
    pub(super) from_prim: u32,
    pub(super) base: u64,
    pub(super) t_max: f64,
    /// Whether hits in blocks need no filter (see [`RenderGroup::uniform_flags`]).
    pub(super) unfiltered: bool,
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
            && let Some(index) = prim.unfiltered_shape()
        {
            return self.unfiltered_shape(id, index, t_max);
        }
        self.visit_any(id, prim, t_max)
    }
}

impl<Q: Query> GroupVisitor<'_, '_, '_, Q> {
    /// Tests a shape whose hits need no filter.
    #[inline(always)]
    fn unfiltered_shape(&mut self, id: u32, index: u32, t_max: f64) -> f64 {
        let shape = UnfilteredShape::of(self.group, id, index, self.base);
        let from = match self.from {
            Some((origin, from)) if id == self.from_prim => Some(shape.start(origin, from)),
            _ => None,
        };
        let slot = self.search.slot;
        slot.enter_for(Phase::Intersection, shape.number);
        let range = Interval::new(self.range_min, t_max);
        let hit = match shape.may_be_met(self.ray, range) {
            true => shape.meet::<Q>(self.ray, range, from, self.search.scratch),
            false => None,
        };
        slot.enter(Phase::Traversal);
        let Some(hit) = hit else {
            return t_max;
        };
        self.t_max = self.search.query.take(hit, t_max);
        self.t_max
    }

    /// Visits a primitive of any kind, which the query wants.
    #[inline(never)]
    pub(super) fn visit_any(&mut self, id: u32, prim: Prim, t_max: f64) -> f64 {
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
                object: self.group.appearance(id, 0).object,
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
    pub(super) fn facing(&self, id: u32, prim: Prim) -> Option<bool> {
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
        if !used.may_be_met(&ray, range) {
            return t_max;
        }
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
        let wanted = !self.search.query.chooses(prim.flags) || {
            let appearance = self.group.appearance(id, found.surface.element);
            let transmits = self.search.scene.transmits(appearance);
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
                let sphere = self.group.spheres.get(number, self.group.blocks.spheres());
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
                if !used.may_be_met(&ray, range) {
                    return None;
                }
                used.shape
                    .closest_hit(&ray, range, from, self.search.scratch)
            }
            PrimKind::Instance(_) => unreachable!("instances are searched, not tested"),
        }
    }

    /// Whether a hit counts: not on the back of a one-sided surface, nor in a hole of an alpha mask. `front` says that it is
    /// known not to be on the back.
    #[inline]
    pub(super) fn exists(
        &self,
        id: u32,
        prim: Prim,
        hit: &Hit,
        surface: SurfaceId,
        front: bool,
    ) -> bool {
        front && prim.flags & Prim::MASKED == 0 || self.exists_there(id, hit, surface)
    }

    fn exists_there(&self, id: u32, hit: &Hit, surface: SurfaceId) -> bool {
        let appearance = self.group.appearance(id, surface.element);
        let material = &self.search.scene.materials[appearance.material.0 as usize];
        let masked = material.is_masked();
        let mut point = Resolved::UNKNOWN.point;
        let kind = self.group.prims.at(id).kind();
        self.group
            .store_surface(kind, self.ray, hit, surface.element, masked, &mut point);
        let front = point.n_geom.dot(self.ray.direction) < 0.0;
        if material.sides == Sides::Front && !front {
            return false;
        }
        !masked || material.at(point.uv).opacity > 0.0
    }
}
