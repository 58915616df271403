use super::convex::Span;
use super::frustum::Frustum;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::{Aabb, DVec3, Interval, Ray, Transform};

/// A right circular cone or truncated cone: closed with caps, or open, without thickness.
///
/// An *open* cone has no visible caps, but it is still a solid, which ends where the caps would be.
///
/// The radius changes linearly from the base to the apex; either may be 0 (a tip), both may be equal. Texture coordinates
/// and facets as for [`crate::Cylinder`]: 0 the side, 1 the cap at the base, 2 the cap at the apex. The normal of the
/// side points away from the axis. A ray that touches the side or runs within it does not hit it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cone(Frustum);

impl Cone {
    /// The frustum that it is.
    pub(crate) fn frustum(&self) -> &Frustum {
        &self.0
    }

    /// The solid cone between two points on its axis, with the radii there.
    pub fn new(base: DVec3, base_radius: f64, apex: DVec3, apex_radius: f64) -> Self {
        Self(Frustum::new(base, base_radius, apex, apex_radius, true))
    }

    /// The same without visible caps.
    pub fn open(base: DVec3, base_radius: f64, apex: DVec3, apex_radius: f64) -> Self {
        Self(Frustum::new(base, base_radius, apex, apex_radius, false))
    }

    /// Like [`Cone::new`], checked.
    ///
    /// # Errors
    /// A value is not finite, the two points are the same, a radius is negative, or both are 0.
    pub fn try_new(
        base: DVec3,
        base_radius: f64,
        apex: DVec3,
        apex_radius: f64,
    ) -> Result<Self, GeometryError> {
        let cone = Self::new(base, base_radius, apex, apex_radius);
        cone.validate().map(|()| cone)
    }

    /// The centre of the base.
    pub fn base(&self) -> DVec3 {
        self.0.base
    }

    /// The radius at the base.
    pub fn base_radius(&self) -> f64 {
        self.0.base_radius
    }

    /// The other end of the axis, up to rounding.
    pub fn apex(&self) -> DVec3 {
        self.0.apex()
    }

    /// The radius at the apex, up to rounding.
    pub fn apex_radius(&self) -> f64 {
        self.0.apex_radius()
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

impl Primitive for Cone {
    fn kind(&self) -> &'static str {
        "cone"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        self.0.validate("cone")
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

    /// Any similarity makes a cone of a cone.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        self.0.baked(map).map(|frustum| Self(frustum).into())
    }
}

impl Solid for Cone {
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

    crate::primitive_tests!(pointed, || Cone::new(DVec3::ZERO, 1.0, DVec3::Y, 0.0));
    crate::primitive_tests!(upside_down, || Cone::new(
        DVec3::new(1.0, 2.0, 3.0),
        0.0,
        DVec3::new(2.0, 1.0, 3.5),
        1.5
    ));
    crate::primitive_tests!(truncated, || Cone::new(
        DVec3::new(1.0, 2.0, 3.0),
        1.0,
        DVec3::new(2.0, 1.0, 3.5),
        0.3
    ));
    crate::primitive_tests!(straight, || Cone::new(
        DVec3::ZERO,
        0.5,
        DVec3::new(1.0, 1.0, 1.0),
        0.5
    ));
    crate::primitive_tests!(flat, || Cone::new(
        DVec3::ZERO,
        2.0,
        DVec3::new(0.0, 0.1, 0.0),
        0.0
    ));
    crate::primitive_tests!(open, || Cone::open(
        DVec3::ZERO,
        1.0,
        DVec3::new(0.3, 0.1, 2.0),
        0.5
    ));

    fn hits(cone: &Cone, ray: &Ray) -> Vec<(f64, u32)> {
        let mut out = Crossings::default();
        cone.crossings(ray, Interval::LINE, None, &mut Scratch::default(), &mut out);
        out.list
            .iter()
            .map(|c| (c.hit.t, c.surface().facet))
            .collect()
    }

    #[test]
    fn special_rays() {
        let cone = Cone::new(DVec3::ZERO, 1.0, DVec3::Y, 0.0);
        // Down the axis, through the very tip.
        let down = hits(&cone, &Ray::new(DVec3::Y * 3.0, -DVec3::Y));
        assert_eq!(down.iter().map(|hit| hit.0).collect::<Vec<_>>(), [2.0, 3.0]);
        // From the tip itself, down.
        let from_tip = hits(&cone, &Ray::new(DVec3::Y, -DVec3::Y));
        assert_eq!(from_tip.last(), Some(&(1.0, 1)));
        // Parallel to a generator: a vanishes, there is one crossing with the side.
        let parallel = Ray::new(DVec3::new(0.5, -1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0));
        assert_eq!(hits(&cone, &parallel).len(), 2);
        // Along a generator, and above the tip, where the other half of the double cone would be.
        assert_eq!(
            hits(&cone, &Ray::new(DVec3::X, DVec3::new(-1.0, 1.0, 0.0))),
            []
        );
        assert_eq!(
            hits(&cone, &Ray::new(DVec3::new(-3.0, 1.5, 0.0), DVec3::X)),
            []
        );
        // Across.
        assert_eq!(
            hits(&cone, &Ray::new(DVec3::new(-3.0, 0.5, 0.0), DVec3::X)),
            [(2.5, 0), (3.5, 0)]
        );
    }

    #[test]
    fn impossible_cones_are_refused() {
        let cone = |r0, apex, r1| Cone::try_new(DVec3::ZERO, r0, apex, r1);
        assert!(matches!(
            cone(1.0, DVec3::ZERO, 0.0),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            cone(0.0, DVec3::X, 0.0),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            cone(1.0, DVec3::X, -0.5),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            cone(-1.0, DVec3::X, 0.5),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            cone(1.0, DVec3::X, f64::INFINITY),
            Err(GeometryError::NotFinite { .. })
        ));
        assert!(cone(0.1, DVec3::new(0.1, 0.2, 0.3), 0.0).is_ok());
    }
}
