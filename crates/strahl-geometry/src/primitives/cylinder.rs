use super::check_positive;
use super::convex::Span;
use super::frustum::Frustum;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::{Aabb, DVec3, Interval, Ray, Transform};

/// A right circular cylinder: closed with caps, or an open tube without thickness.
///
/// An *open* cylinder has no visible caps, but it is still a solid, which ends where the caps would be.
///
/// Texture coordinates of the side: `u` is the angle, 0 to 1, `v` the height, 0 at the base and 1 at the apex; of a cap: `u` the
/// angle, `v` the distance from the axis, 1 at the rim. Facets: 0 the side, 1 the cap at the base, 2 the cap at
/// the apex. The normal of the side points away from the axis. A ray that touches the side or runs within it does not hit it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder(Frustum);

impl Cylinder {
    /// The frustum that it is.
    pub(crate) fn frustum(&self) -> &Frustum {
        &self.0
    }

    /// The solid cylinder between the centres of its two caps.
    pub fn new(base: DVec3, apex: DVec3, radius: f64) -> Self {
        Self(Frustum::new(base, radius, apex, radius, true))
    }

    /// The same without visible caps.
    pub fn open(base: DVec3, apex: DVec3, radius: f64) -> Self {
        Self(Frustum::new(base, radius, apex, radius, false))
    }

    /// Like [`Cylinder::new`], checked.
    ///
    /// # Errors
    /// A value is not finite, the two points are the same, or the radius is not positive.
    pub fn try_new(base: DVec3, apex: DVec3, radius: f64) -> Result<Self, GeometryError> {
        let cylinder = Self::new(base, apex, radius);
        cylinder.validate().map(|()| cylinder)
    }

    /// The centre of the lower cap.
    pub fn base(&self) -> DVec3 {
        self.0.base
    }

    /// The centre of the upper cap, up to rounding.
    pub fn apex(&self) -> DVec3 {
        self.0.apex()
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.0.base_radius
    }

    /// Whether it has visible caps.
    pub fn is_capped(&self) -> bool {
        self.0.capped
    }

    /// The span in which the line is inside of the solid.
    pub(crate) fn span(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Span> {
        self.0.span(ray, from)
    }
}

impl Primitive for Cylinder {
    fn kind(&self) -> &'static str {
        "cylinder"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_positive("radius of the cylinder", self.0.base_radius)?;
        self.0.validate("cylinder")
    }

    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    #[inline]
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.0.closest_hit(ray, range, from)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.0.surface_at(ray, hit)
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        self.0.store_bare_surface(ray, hit, out);
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// Any similarity makes a cylinder of a cylinder.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        self.0.baked(map).map(|frustum| Self(frustum).into())
    }
}

impl Solid for Cylinder {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        self.0.crossings(ray, range, from, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.0.contains(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::primitive_tests!(upright, || Cylinder::new(DVec3::ZERO, DVec3::Y, 0.5));
    crate::primitive_tests!(tilted, || Cylinder::new(
        DVec3::new(1.0, 2.0, 3.0),
        DVec3::new(2.0, 1.0, 3.5),
        0.7
    ));
    crate::primitive_tests!(coin, || Cylinder::new(
        DVec3::ZERO,
        DVec3::new(0.01, 0.02, 0.05),
        3.0
    ));
    crate::primitive_tests!(tube, || Cylinder::open(
        DVec3::new(1.0, 2.0, 3.0),
        DVec3::new(2.0, 1.0, 3.5),
        0.7
    ));

    fn hits(cylinder: &Cylinder, ray: &Ray) -> Vec<(f64, u32)> {
        let mut out = Crossings::default();
        cylinder.crossings(ray, Interval::LINE, None, &mut Scratch::default(), &mut out);
        out.list
            .iter()
            .map(|c| (c.hit.t, c.surface().facet))
            .collect()
    }

    #[test]
    fn side_and_caps_join() {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Y * 2.0, 1.0);
        let ray = |o, d| Ray::new(o, d);
        assert_eq!(
            hits(&cylinder, &ray(DVec3::new(0.5, 9.0, 0.0), -DVec3::Y)),
            [(7.0, 2), (9.0, 1)]
        );
        assert_eq!(
            hits(&cylinder, &ray(DVec3::new(-3.0, 1.0, 0.0), DVec3::X)),
            [(2.0, 0), (4.0, 0)]
        );
        // In through the side, out through the base.
        let slanted = ray(DVec3::new(-2.0, 2.0, 0.0), DVec3::new(1.0, -1.0, 0.0));
        assert_eq!(hits(&cylinder, &slanted), [(1.0, 0), (2.0, 1)]);
        // Exactly through the edge of the top, only touching.
        assert_eq!(
            hits(
                &cylinder,
                &ray(DVec3::new(-2.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0))
            ),
            []
        );
        // Along the side and within a cap.
        assert_eq!(
            hits(&cylinder, &ray(DVec3::new(1.0, -1.0, 0.0), DVec3::Y)),
            []
        );
        assert_eq!(
            hits(&cylinder, &ray(DVec3::new(-3.0, 2.0, 0.0), DVec3::X)),
            []
        );
    }

    #[test]
    fn rays_through_the_rim_enter_and_leave() {
        let mut random = crate::conformance::Random::new(7);
        let (axis, radius) = (DVec3::new(1.0, -1.0, 0.5), 0.7);
        let base = DVec3::new(1.0, 2.0, 3.0);
        let cylinder = Cylinder::new(base, base + axis, radius);
        let mut through = 0;
        for _ in 0..20_000 {
            let across = axis.cross(random.direction()).normalize();
            let end = if random.below(2) == 0 {
                base
            } else {
                base + axis
            };
            let direction = match random.below(3) {
                // Along the rim, along the side, anywhere.
                0 => axis.cross(across),
                1 => axis + across * random.magnitude(-18.0, -1.0),
                _ => random.direction(),
            };
            let origin = end + across * radius - direction * random.between(0.0, 3.0);
            let ray = Ray::new(origin, direction);
            let found = hits(&cylinder, &ray);
            assert!(
                matches!(found[..], [] | [_, _]) && found.is_sorted_by(|a, b| a.0 < b.0),
                "{ray:?} {found:?}"
            );
            let first = cylinder.closest_hit(&ray, Interval::LINE, None, &mut Scratch::default());
            assert_eq!(
                first.map(|hit| (hit.t, hit.surface.facet)),
                found.first().copied()
            );
            through += found.len() / 2;
        }
        assert!((2_000..18_000).contains(&through), "{through}");
    }

    #[test]
    fn a_tube_is_open() {
        let tube = Cylinder::open(DVec3::ZERO, DVec3::Y * 2.0, 1.0);
        assert!(tube.contains(DVec3::Y) && !tube.contains(DVec3::Y * 3.0));
        let hit = |ray: &Ray| {
            tube.closest_hit(ray, Interval::FORWARD, None, &mut Scratch::default())
                .map(|hit| hit.t)
        };
        assert_eq!(hit(&Ray::new(DVec3::new(0.5, 9.0, 0.0), -DVec3::Y)), None);
        assert_eq!(
            hit(&Ray::new(
                DVec3::new(-2.0, 3.0, 0.0),
                DVec3::new(1.0, -1.0, 0.0)
            )),
            Some(1.0)
        );
        // In through the open top, against the inner side.
        assert_eq!(
            hit(&Ray::new(
                DVec3::new(0.0, 3.0, 0.0),
                DVec3::new(1.0, -2.0, 0.0)
            )),
            Some(1.0)
        );
    }

    #[test]
    fn a_ray_nearly_along_the_axis_from_far_away_hits_the_cap() {
        let axis = DVec3::new(1.0, 2.0, -0.7).normalize();
        let cylinder = Cylinder::new(DVec3::ZERO, axis, 1e-3);
        for distance in [1.0, 1e3, 1e6, 1e9] {
            let ray = Ray::new(axis * -distance, axis);
            let hit = cylinder.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
            assert!(
                hit.is_some_and(|hit| hit.surface.facet == 1),
                "{distance}: {hit:?}"
            );
        }
    }

    #[test]
    fn impossible_cylinders_are_refused() {
        let cylinder = |apex, r| Cylinder::try_new(DVec3::ZERO, apex, r);
        assert!(matches!(
            cylinder(DVec3::ZERO, 1.0),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            cylinder(DVec3::X, 0.0),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            cylinder(DVec3::X, f64::NAN),
            Err(GeometryError::NotFinite { .. })
        ));
        assert!(matches!(
            cylinder(DVec3::NAN, 1.0),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
