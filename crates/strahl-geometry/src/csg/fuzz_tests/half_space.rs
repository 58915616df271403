use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId,
    SurfacePoint,
};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// Everything on one side of a plane: the unbounded solid of the tests.
#[derive(Debug)]
pub(super) struct HalfSpace {
    normal: DVec3,
    distance: f64,
}

impl HalfSpace {
    pub(super) fn new(normal: DVec3, distance: f64) -> Self {
        Self { normal, distance }
    }

    fn crossing(&self, ray: &Ray) -> Option<Crossing> {
        let across = self.normal.dot(ray.direction);
        let t = (self.distance - self.normal.dot(ray.origin)) / across;
        let size = ray.origin.length() + self.distance.abs();
        let error = gamma(8) * (size / across.abs() + t.abs());
        let side = if across < 0.0 {
            Side::Enter
        } else {
            Side::Exit
        };
        t.is_finite()
            .then(|| Crossing::new(PrimHit::simple(t, 0), error, side))
    }
}

impl Primitive for HalfSpace {
    fn kind(&self) -> &'static str {
        "half_space"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        Aabb::EVERYTHING
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _: &mut Scratch,
    ) -> Option<PrimHit> {
        let hit = self.crossing(ray)?.hit;
        (from.is_none() && range.accepts(hit.t)).then_some(hit)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let at = ray.at(hit.t);
        SurfacePoint {
            position: at + self.normal * (self.distance - self.normal.dot(at)),
            position_error: (at.abs() + DVec3::splat(self.distance.abs() + at.length())) * gamma(8),
            n_geom: self.normal,
            n_shade: self.normal,
            uv: DVec2::ZERO,
            dpdu: DVec3::ZERO,
            dpdv: DVec3::ZERO,
        }
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for HalfSpace {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _: &mut Scratch,
        out: &mut Crossings,
    ) {
        let across = self.normal.dot(ray.direction);
        let Some(crossing) = self.crossing(ray) else {
            out.inside_at_start = self.contains(ray.origin);
            return;
        };
        let (t, start) = match from {
            Some(_) => (0.0, if range.min < 0.0 { 0.0 } else { range.min }),
            None => (crossing.hit.t, range.min),
        };
        out.inside_at_start = (start < t) == (across > 0.0);
        if from.is_none() && range.accepts(t) {
            out.list.push(crossing);
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        self.normal.dot(point) <= self.distance
    }
}
