use super::frame::{UvFrame, similarity, turn};
use super::{
    check_direction, check_finite, check_length, check_positive, point_error, unit_vector,
};
use crate::{
    Crossings, GeometryError, Plane, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId,
    SurfacePoint,
};
use std::f64::consts::PI;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A flat round disc, optionally with a round hole in its middle.
///
/// It is visible from both sides. As a solid it is the half-space behind its normal; of that half-space's plane only the disc is
/// visible.
///
/// Texture coordinates: `u` is the angle, 0 to 1; `v` is 0 at the hole (or the centre) and 1 at the rim. Facets: one, 0. The
/// rims belong to the disc. A ray within its plane does not hit it.
#[derive(Clone, Debug, PartialEq)]
pub struct Disc {
    center: DVec3,
    normal: DVec3,
    radius: f64,
    hole: f64,
    frame: UvFrame,
}

impl Disc {
    /// The disc of a centre, a normal of any length, a radius and the radius of its hole (0 for none).
    pub fn new(center: DVec3, normal: DVec3, radius: f64, hole: f64) -> Self {
        Self {
            center,
            normal: unit_vector(normal),
            radius,
            hole,
            frame: UvFrame::default(),
        }
    }

    /// Like [`Disc::new`], checked.
    ///
    /// # Errors
    /// A value is not finite, the normal is zero, the radius is not positive, or the hole is negative or leaves nothing.
    pub fn try_new(
        center: DVec3,
        normal: DVec3,
        radius: f64,
        hole: f64,
    ) -> Result<Self, GeometryError> {
        let disc = Self::new(center, normal, radius, hole);
        disc.validate().map(|()| disc)
    }

    /// The centre.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The unit normal.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The radius of the hole, 0 if there is none.
    pub fn hole(&self) -> f64 {
        self.hole
    }

    /// The plane it lies in.
    fn plane(&self) -> Plane {
        Plane::new(self.center, self.normal)
    }

    /// Whether a point of the plane, relative to the centre, is on the disc.
    fn covers(&self, local: DVec3) -> bool {
        let distance = (local - self.normal * local.dot(self.normal)).length();
        self.hole <= distance && distance <= self.radius
    }
}

/// The box around a circle, not padded.
///
/// On each axis it reaches `r √(1 - n²)`, computed from the other two components so that no digits cancel.
pub(super) fn circle_bounds(center: DVec3, normal: DVec3, radius: f64) -> Aabb {
    let n = normal * normal;
    let sine = DVec3::new((n.y + n.z).sqrt(), (n.z + n.x).sqrt(), (n.x + n.y).sqrt());
    let reach = sine * radius;
    Aabb::new(center - reach, center + reach)
}

impl Disc {
    /// From the centre to a hit, in the plane of the disc.
    fn local(&self, ray: &Ray, hit: &PrimHit) -> DVec3 {
        let local = (ray.origin - self.center) + ray.direction * hit.t;
        local - self.normal * local.dot(self.normal)
    }
}

impl Primitive for Disc {
    fn kind(&self) -> &'static str {
        "disc"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_finite("center of the disc", self.center)?;
        check_direction("normal of the disc", "disc", self.normal)?;
        check_positive("radius of the disc", self.radius)?;
        check_length("radius of the disc's hole", self.hole)?;
        if self.hole < self.radius {
            return Ok(());
        }
        Err(GeometryError::Degenerate {
            what: "disc",
            why: "its hole is as large as the disc",
        })
    }

    fn bounds(&self) -> Aabb {
        let tight = circle_bounds(self.center, self.normal, self.radius);
        tight.padded(point_error(
            self.center.abs() + self.radius.abs(),
            self.radius.abs(),
            12,
        ))
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
        let f = ray.origin - self.center;
        let t = -f.dot(self.normal) / ray.direction.dot(self.normal);
        if !(range.accepts(t) && t.is_finite()) {
            return None;
        }
        self.covers(f + ray.direction * t)
            .then(|| PrimHit::simple(t, 0))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let local = self.local(ray, hit);
        let axes = self.frame.axes(self.normal);
        let (x, y) = (local.dot(axes.x_axis), local.dot(axes.y_axis));
        let distance = DVec2::new(x, y).length();
        let (cos, sin) = if distance > 0.0 {
            (x / distance, y / distance)
        } else {
            (1.0, 0.0)
        };
        let width = self.radius - self.hole;
        SurfacePoint {
            uv: DVec2::new(turn(y, x), (distance - self.hole) / width),
            dpdu: (axes.y_axis * cos - axes.x_axis * sin) * (2.0 * PI * distance),
            dpdv: (axes.x_axis * cos + axes.y_axis * sin) * width,
            ..self.bare_surface_at(ray, hit)
        }
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        let local = self.local(ray, hit);
        let position = self.center + local;
        let error = point_error(position, local.length(), 8);
        *out = SurfacePoint::bare(position, error, self.normal);
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// Any similarity makes a disc of a disc.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        let (scale, orthogonal) = similarity(map)?;
        Some(Shape::Disc(Self {
            center: map.point_to_world(self.center),
            normal: unit_vector(map.normal_to_world(self.normal)),
            radius: self.radius * scale,
            hole: self.hole * scale,
            frame: self.frame.turned(self.normal, orthogonal),
        }))
    }
}

impl Solid for Disc {
    fn inside_bounds(&self) -> Aabb {
        self.plane().bounds()
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        self.plane().crossings(ray, range, from, scratch, out);
        for crossing in &mut out.list {
            let f = ray.origin - self.center;
            crossing.visible = self.covers(f + ray.direction * crossing.hit.t);
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        self.plane().contains(point)
    }
}

#[cfg(test)]
mod tests {
    use super::super::frame::basis;
    use super::*;

    crate::primitive_tests!(flat, || Disc::new(DVec3::ZERO, DVec3::Y, 1.0, 0.0));
    crate::primitive_tests!(ring, || Disc::new(
        DVec3::new(1.0, 2.0, 3.0),
        DVec3::new(0.3, -0.5, 2.0),
        2.0,
        1.0
    ));

    fn hit(disc: &Disc, x: f64) -> bool {
        let ray = Ray::new(DVec3::new(x, 1.0, 0.0), -DVec3::Y);
        disc.any_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
    }

    #[test]
    fn the_hole_is_open_and_the_rims_belong_to_the_disc() {
        let disc = Disc::new(DVec3::ZERO, DVec3::Y, 2.0, 1.0);
        assert!(!hit(&disc, 0.0) && !hit(&disc, 1.0f64.next_down()));
        assert!(hit(&disc, 1.0) && hit(&disc, 2.0));
        assert!(!hit(&disc, 2.0f64.next_up()));
        assert!(hit(&Disc::new(DVec3::ZERO, DVec3::Y, 2.0, 0.0), 0.0));
    }

    #[test]
    fn the_box_of_a_tilted_circle_is_tight() {
        let n = DVec3::new(0.6, 0.0, 0.8);
        let bounds = circle_bounds(DVec3::ZERO, n, 5.0);
        assert!((bounds.max - DVec3::new(4.0, 5.0, 3.0)).length() < 1e-14);
        let axes = basis(n);
        for i in 0..64 {
            let angle = f64::from(i) * 0.1;
            let p = (axes.x_axis * angle.cos() + axes.y_axis * angle.sin()) * 5.0;
            assert!(bounds.padded(DVec3::splat(1e-14)).contains(p));
        }
    }

    #[test]
    fn impossible_discs_are_refused() {
        let disc = |n, r, hole| Disc::try_new(DVec3::ZERO, n, r, hole);
        assert!(matches!(
            disc(DVec3::ZERO, 1.0, 0.0),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            disc(DVec3::X, 0.0, 0.0),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            disc(DVec3::X, 1.0, -1.0),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            disc(DVec3::X, 1.0, 1.0),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            disc(DVec3::X, f64::INFINITY, 1.0),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
