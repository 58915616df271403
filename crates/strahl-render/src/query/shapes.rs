//! Shapes whose hits need no filter: most primitives of most scenes.

use super::kinds::Query;
use crate::hit::{Hit, Origin};
use crate::scene::RenderGroup;
use crate::uses::EarlyBox;
use strahl_geometry::blocks::PacketSpans;
use strahl_geometry::{PrimHit, Primitive, Scratch, Shape, SurfaceId};
use strahl_math::{Interval, Ray, Transform};

/// A shape of a group, as a primitive that [has no filter](crate::prim::Prim::unfiltered_shape).
pub(super) struct UnfilteredShape<'g> {
    pub(super) early_box: Option<&'g EarlyBox>,
    pub(super) shape: &'g Shape,
    pub(super) transform: Option<&'g Transform>,
    /// The number of its first element, in the group.
    first: u64,
    /// The same number in the scene.
    pub(super) number: u64,
}

impl<'g> UnfilteredShape<'g> {
    /// The shape with this index, of the primitive `id`; `base` is the number of the group's first element.
    #[inline(always)]
    pub(super) fn of(group: &'g RenderGroup, id: u32, index: u32, base: u64) -> Self {
        let used = &group.shapes[index as usize];
        let first = group.first_id(id);
        Self {
            early_box: used.early_box.as_deref(),
            shape: &used.shape,
            transform: used.transform.as_deref(),
            first,
            number: base + first,
        }
    }

    /// The surface that a ray starts on, given its origin and the number of the element, counted in the group.
    #[inline(always)]
    pub(super) fn start(&self, origin: &Origin, from: u64) -> SurfaceId {
        SurfaceId {
            element: (from - self.first) as u32,
            facet: origin.facet,
        }
    }

    /// Whether a ray may meet it in the range, as far as its box tells.
    #[inline(always)]
    pub(super) fn may_be_met(&self, ray: &Ray, range: Interval) -> bool {
        match (self.early_box, self.transform) {
            (Some(EarlyBox::Own(own)), Some(map)) => own.may_be_met(&map.ray_to_object(ray), range),
            (Some(EarlyBox::Bounds(bounds)), _) => bounds.may_be_met(ray, Interval::FORWARD),
            _ => true,
        }
    }

    /// Where a ray meets it first; anywhere, if that is all the query asks for.
    #[inline(always)]
    pub(super) fn meet<Q: Query>(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<Hit> {
        match self.transform {
            None => self.meet_as::<Q, _>(self.shape, ray, range, from, scratch),
            Some(map) => {
                let inner = map.ray_to_object(ray);
                self.meet_as::<Q, _>(self.shape, &inner, range, from, scratch)
            }
        }
    }

    /// The same, given the primitive that the shape is, and the ray in its space.
    #[inline(always)]
    pub(super) fn meet_as<Q: Query, P: Primitive>(
        &self,
        primitive: &P,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<Hit> {
        let found = if Q::ANY {
            primitive
                .any_hit(ray, range, from, scratch)
                .then_some(PrimHit::simple(range.max, 0))
        } else {
            primitive.closest_hit(ray, range, from, scratch)
        }?;
        Some(self.hit(&found))
    }

    /// The same for a ray of a packet whose span in the shape is known; `None` if it isn't.
    #[inline(always)]
    pub(super) fn meet_known<Q: Query>(
        &self,
        spans: &PacketSpans,
        lane: usize,
        range: Interval,
    ) -> Option<Option<Hit>> {
        let found = spans.closest(self.shape, lane, range)?;
        Some(found.map(|found| match Q::ANY {
            true => self.hit(&PrimHit::simple(range.max, 0)),
            false => self.hit(&found),
        }))
    }

    /// Appends all places where a ray meets it.
    #[inline]
    pub(super) fn meet_all(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        let inner = self.transform.map_or(*ray, |map| map.ray_to_object(ray));
        self.shape.all_hits(&inner, range, from, scratch, out);
    }

    /// A hit in the scene.
    #[inline(always)]
    pub(super) fn hit(&self, found: &PrimHit) -> Hit {
        Hit {
            t: found.t,
            id: self.number + u64::from(found.surface.element),
            facet: found.surface.facet,
            uv: found.uv,
        }
    }
}
