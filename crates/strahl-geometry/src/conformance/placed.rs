use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use std::sync::Arc;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A primitive in a space of its own, as a renderer treats shapes that it can't bake.
#[derive(Debug)]
pub(super) struct Placed {
    shape: Arc<dyn Primitive>,
    map: Transform,
    /// Whether this stands for the shape as a solid, which may differ from the shape where a ray only touches it.
    is_solid: bool,
    solid: Option<Box<Self>>,
}

impl Placed {
    pub(super) fn new(shape: Arc<dyn Primitive>, map: Transform) -> Self {
        let solid = shape.as_solid().map(|_| {
            Box::new(Self {
                shape: Arc::clone(&shape),
                map,
                is_solid: true,
                solid: None,
            })
        });
        Self {
            shape,
            map,
            is_solid: false,
            solid,
        }
    }

    fn primitive(&self) -> &dyn Primitive {
        match self.shape.as_solid() {
            Some(solid) if self.is_solid => solid,
            _ => &*self.shape,
        }
    }

    /// The surface point of object space, in outer space.
    fn surface_to_world(&self, inner: &SurfacePoint) -> SurfacePoint {
        let position = self.map.point_to_world(inner.position);
        let linear = self.map.error_to_world(inner.position.abs()) * gamma(4);
        SurfacePoint {
            position,
            position_error: self.map.error_to_world(inner.position_error)
                + linear
                + position.abs() * (2.0 * ROUNDOFF),
            n_geom: self.map.normal_to_world(inner.n_geom).normalize(),
            n_shade: self.map.normal_to_world(inner.n_shade).normalize(),
            uv: inner.uv,
            dpdu: self.map.vector_to_world(inner.dpdu),
            dpdv: self.map.vector_to_world(inner.dpdv),
        }
    }
}

impl Primitive for Placed {
    fn kind(&self) -> &'static str {
        self.primitive().kind()
    }

    fn validate(&self) -> Result<(), GeometryError> {
        self.primitive().validate()
    }

    fn bounds(&self) -> Aabb {
        self.map.bounds_to_world(&self.primitive().bounds())
    }

    fn elements(&self) -> u32 {
        self.primitive().elements()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.primitive()
            .closest_hit(&self.map.ray_to_object(ray), range, from, scratch)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> bool {
        self.primitive()
            .any_hit(&self.map.ray_to_object(ray), range, from, scratch)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.surface_to_world(
            &self
                .primitive()
                .surface_at(&self.map.ray_to_object(ray), hit),
        )
    }

    fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        self.primitive().texture_uv(hit, uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        if self.is_solid {
            return Some(self);
        }
        self.solid.as_deref().map(|solid| solid as &dyn Solid)
    }
}

impl Solid for Placed {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        if let Some(solid) = self.shape.as_solid() {
            solid.crossings(&self.map.ray_to_object(ray), range, from, scratch, out);
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        self.shape
            .as_solid()
            .is_some_and(|solid| solid.contains(self.map.point_to_object(point)))
    }
}
