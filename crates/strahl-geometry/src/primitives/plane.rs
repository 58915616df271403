use super::convex::{End, Span};
use super::frame::UvFrame;
use super::{check_direction, check_finite, plane_t_error, point_error, unit_vector};
use crate::blocks::convex::{FourLines, FourRays, FourSpans, sub};
use crate::blocks::dot;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};
use strahl_simd::Isa;

/// An infinite plane; as a solid the half-space behind it, away from the normal.
///
/// Texture coordinates are lengths along two perpendicular directions in the plane, measured from its point; for the
/// normal +y they are x and -z. Facets: one, 0. A ray parallel to the plane does not hit it.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    point: DVec3,
    normal: DVec3,
    frame: UvFrame,
}

impl Plane {
    /// The plane through a point, perpendicular to a normal of any length.
    pub fn new(point: DVec3, normal: DVec3) -> Self {
        Self {
            point,
            normal: unit_vector(normal),
            frame: UvFrame::default(),
        }
    }

    /// Like [`Plane::new`], checked.
    ///
    /// # Errors
    /// A value is not finite, or the normal is zero.
    pub fn try_new(point: DVec3, normal: DVec3) -> Result<Self, GeometryError> {
        let plane = Self::new(point, normal);
        plane.validate().map(|()| plane)
    }

    /// The point given: the origin of the texture coordinates.
    pub fn point(&self) -> DVec3 {
        self.point
    }

    /// The unit normal.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Where the line crosses the plane: `n · (o + t d - p) = 0`.
    #[inline]
    fn crossing(&self, ray: &Ray) -> Option<f64> {
        let t = (self.point - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        t.is_finite().then_some(t)
    }

    /// The span in which the line is inside; `None` if it runs along the plane.
    #[inline]
    pub(crate) fn span(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Span> {
        let speed = ray.direction.dot(self.normal);
        if speed == 0.0 || speed.is_nan() {
            return None;
        }
        let t = if from.is_some() {
            0.0
        } else {
            self.crossing(ray)?
        };
        let end = End { t, facet: 0 };
        Some(if speed < 0.0 {
            Span {
                enter: end,
                ..Span::LINE
            }
        } else {
            Span {
                exit: end,
                ..Span::LINE
            }
        })
    }
}

impl FourLines for Plane {
    #[inline(always)]
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        let (p, n) = (self.point, self.normal);
        let point = [isa.splat(p.x), isa.splat(p.y), isa.splat(p.z)];
        let normal = [isa.splat(n.x), isa.splat(n.y), isa.splat(n.z)];
        let (zero, infinite) = (isa.splat(0.0), isa.splat(f64::INFINITY));
        let speed = dot(isa, rays.direction, normal);
        let t = isa.div(dot(isa, sub(isa, point, rays.origin), normal), speed);
        // The own test decides about lines along the plane.
        let known = isa.lt(isa.abs(t), infinite) & isa.lt(zero, isa.abs(speed));
        FourSpans {
            known,
            met: known,
            enter: isa.store(isa.choose_le(zero, speed, isa.splat(f64::NEG_INFINITY), t)),
            exit: isa.store(isa.choose_le(zero, speed, t, infinite)),
            ..FourSpans::default()
        }
    }
}

impl Primitive for Plane {
    fn kind(&self) -> &'static str {
        "plane"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_finite("point of the plane", self.point)?;
        check_direction("normal of the plane", "plane", self.normal)
    }

    /// Unbounded, except above if the normal is exactly along an axis.
    fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EVERYTHING;
        for axis in 0..3 {
            if self.normal[axis] == 1.0 {
                bounds.max[axis] = self.point[axis];
            } else if self.normal[axis] == -1.0 {
                bounds.min[axis] = self.point[axis];
            }
        }
        bounds
    }

    #[inline]
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        if from.is_some() {
            return None;
        }
        let t = self.crossing(ray)?;
        range.accepts(t).then(|| PrimHit::simple(t, 0))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let bare = self.bare_surface_at(ray, hit);
        let local = bare.position - self.point;
        let axes = self.frame.axes(self.normal);
        let (dpdu, dpdv) = (axes.x_axis, axes.y_axis);
        // local = u dpdu + v dpdv, where the two need not be perpendicular once a map is baked in.
        let across = dpdu.cross(dpdv);
        let per_area = across / across.length_squared();
        let uv = DVec2::new(
            local.cross(dpdv).dot(per_area),
            dpdu.cross(local).dot(per_area),
        );
        SurfacePoint {
            uv,
            dpdu,
            dpdv,
            ..bare
        }
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        let at = ray.at(hit.t);
        let position = at - self.normal * (at - self.point).dot(self.normal);
        let local = position - self.point;
        let error = point_error(position, local.length(), 8);
        *out = SurfacePoint::bare(position, error, self.normal);
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// Any map makes a plane of a plane.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        Some(Shape::Plane(Self {
            point: map.point_to_world(self.point),
            normal: unit_vector(map.normal_to_world(self.normal)),
            frame: self.frame.turned(self.normal, map.linear()),
        }))
    }
}

impl Solid for Plane {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let speed = ray.direction.dot(self.normal);
        if speed == 0.0 {
            // A ray within the plane is outside, like one that starts on it and stays there.
            out.inside_at_start =
                from.is_none() && (ray.origin - self.point).dot(self.normal) < 0.0;
            return;
        }
        let Some(span) = self.span(ray, from) else {
            return;
        };
        span.list(
            range,
            from,
            |end| plane_t_error(ray, end.t, self.point, self.normal),
            out,
        );
    }

    fn contains(&self, point: DVec3) -> bool {
        (point - self.point).dot(self.normal) <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::primitive_tests!(floor, || Plane::new(DVec3::new(0.0, -0.5, 0.0), DVec3::Y));
    crate::primitive_tests!(tilted, || Plane::new(
        DVec3::new(0.1, 0.2, 0.3),
        DVec3::new(1.0, -2.0, 0.5)
    ));

    #[test]
    fn the_solid_is_behind_the_normal() {
        let plane = Plane::new(DVec3::ZERO, DVec3::Y * 1e-200);
        assert_eq!(plane.normal(), DVec3::Y);
        assert!(plane.contains(-DVec3::Y) && plane.contains(DVec3::X) && !plane.contains(DVec3::Y));
        assert_eq!(plane.bounds().max.y, 0.0);
        let parallel = Ray::new(-DVec3::Y, DVec3::X);
        let mut out = Crossings::default();
        plane.crossings(
            &parallel,
            Interval::LINE,
            None,
            &mut Scratch::default(),
            &mut out,
        );
        assert!(out.inside_at_start && out.list.is_empty());
    }

    #[test]
    fn impossible_planes_are_refused() {
        assert!(matches!(
            Plane::try_new(DVec3::ZERO, DVec3::ZERO),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            Plane::try_new(DVec3::NAN, DVec3::X),
            Err(GeometryError::NotFinite { .. })
        ));
        assert!(matches!(
            Plane::try_new(DVec3::ZERO, DVec3::INFINITY),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
