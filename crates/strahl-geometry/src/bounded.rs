use crate::{
    Crossings, Csg, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId,
    SurfacePoint,
};
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A shape that only those rays see that meet all its bounds too: POV-Ray's `bounded_by`.
///
/// A ray meets a bound if it hits it anywhere, also before or behind the shape, or on its way out of it. The bounds decide nothing else: the
/// inside stays that of the shape. So bounds that surround the shape change nothing.
#[derive(Clone, Debug)]
pub struct Bounded {
    shape: Shape,
    bounds: Vec<Arc<Csg>>,
    /// From the space of the bounds to that of the shape, if they differ.
    map: Option<Transform>,
}

impl Bounded {
    /// A shape and its bounds; `map` is from the space of the bounds to that of the shape.
    pub fn new(shape: Shape, bounds: Vec<Arc<Csg>>, map: Option<Transform>) -> Self {
        Self { shape, bounds, map }
    }

    /// The shape without its bounds.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Whether the ray meets all bounds.
    fn is_seen(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        let ray = &self.map.map_or(*ray, |map| map.ray_to_object(ray));
        self.bounds
            .iter()
            .all(|bound| bound.any_hit(ray, Interval::FORWARD, None, scratch))
    }
}

impl Primitive for Bounded {
    fn kind(&self) -> &'static str {
        self.shape.kind()
    }

    fn validate(&self) -> Result<(), GeometryError> {
        self.shape.validate()
    }

    fn bounds(&self) -> Aabb {
        self.shape.bounds()
    }

    fn elements(&self) -> u32 {
        self.shape.elements()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let hit = self.shape.closest_hit(ray, range, from, scratch)?;
        self.is_seen(ray, scratch).then_some(hit)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> bool {
        self.shape.any_hit(ray, range, from, scratch) && self.is_seen(ray, scratch)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.shape.surface_at(ray, hit)
    }

    fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        self.shape.texture_uv(hit, uv)
    }

    fn bare_surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.shape.bare_surface_at(ray, hit)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        self.shape.as_solid().map(|_| self as &dyn Solid)
    }
}

impl Solid for Bounded {
    fn inside_bounds(&self) -> Aabb {
        let solid = self.shape.as_solid();
        solid.map_or(Aabb::EMPTY, |solid| solid.inside_bounds())
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let Some(solid) = self.shape.as_solid() else {
            return;
        };
        solid.crossings(ray, range, from, scratch, out);
        if !out.list.is_empty() && !self.is_seen(ray, scratch) {
            for crossing in &mut out.list {
                crossing.visible = false;
            }
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        let solid = self.shape.as_solid();
        solid.is_some_and(|solid| solid.contains(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CsgNode, Cuboid, Cylinder, Disc, Sphere, primitive_tests};

    fn bound(shape: impl Into<Shape>) -> Vec<Arc<Csg>> {
        vec![Arc::new(
            Csg::try_new(CsgNode::leaf(shape, 0)).expect("a bound"),
        )]
    }

    fn cylinder() -> Shape {
        Cylinder::new(-DVec3::Y, DVec3::Y, 1.0).into()
    }

    primitive_tests!(surrounded, || Bounded::new(
        cylinder(),
        bound(Cuboid::new(DVec3::splat(-2.0), DVec3::splat(2.0))),
        Some(Transform::translate(DVec3::new(0.1, 0.2, 0.3))),
    ));

    fn sees(bounded: &Bounded, origin: [f64; 3]) -> bool {
        let ray = Ray::new(origin.into(), DVec3::Z);
        let scratch = &mut Scratch::default();
        let hit = bounded.closest_hit(&ray, Interval::FORWARD, None, scratch);
        let any = bounded.any_hit(&ray, Interval::FORWARD, None, scratch);
        assert_eq!(hit.is_some(), any);
        let mut list = Crossings::default();
        let solid = bounded.as_solid().expect("a solid");
        solid.crossings(&ray, Interval::FORWARD, None, scratch, &mut list);
        assert_eq!(list.list.iter().any(|c| c.visible), any);
        any
    }

    #[test]
    fn rays_see_what_is_bounded_through_the_bound() {
        for z in [-3.0, 0.0, 3.0] {
            let small = Sphere::new(DVec3::new(0.0, 0.0, z), 0.5);
            let bounded = Bounded::new(cylinder(), bound(small), None);
            assert!(sees(&bounded, [0.2, 0.2, -9.0]));
            assert!(!sees(&bounded, [0.8, 0.0, -9.0]), "{z}");
            assert!(bounded.contains(DVec3::new(0.9, 0.0, 0.0)));
        }
    }

    #[test]
    fn a_ray_from_within_the_bound_sees_everything() {
        let bounded = Bounded::new(cylinder(), bound(Sphere::new(DVec3::Z * -9.0, 1.0)), None);
        assert!(sees(&bounded, [0.8, 0.0, -9.0]));
        assert!(!sees(&bounded, [0.8, 0.0, -7.9]));
    }

    #[test]
    fn a_sheet_bounds_what_lies_behind_it() {
        let sheet = Disc::new(DVec3::Z * -2.0, DVec3::Z, 0.5, 0.0);
        let moved = Some(Transform::translate(DVec3::X * 0.5));
        let bounded = Bounded::new(cylinder(), bound(sheet), moved);
        assert!(sees(&bounded, [0.8, 0.0, -9.0]) && !sees(&bounded, [-0.2, 0.0, -9.0]));
        assert!(!sees(&bounded, [0.8, 0.0, -1.0]));
    }
}
