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

    /// A box around all that bounds have in common, in their space: rays that meet it nowhere don't see the shape.
    pub fn seen_through(&self) -> Aabb {
        (self.bounds.iter()).fold(Aabb::EVERYTHING, |all, bound| {
            all.intersection(&bound.bounds())
        })
    }

    /// The bounds of a solid, if they are in the space that `to_outer` leads to from that of the shape.
    pub(crate) fn bounds_in(&self, to_outer: Option<&Transform>) -> Option<&[Arc<Csg>]> {
        let here = match (&self.map, to_outer) {
            (None, None) => true,
            (Some(map), Some(to_outer)) => *map == to_outer.inverted(),
            _ => false,
        };
        (here && self.shape.as_solid().is_some()).then_some(&self.bounds)
    }

    /// Whether the shape takes longer than bounds usually do, so that the bounds should be asked first.
    fn bounds_first(&self) -> bool {
        !matches!(
            self.shape,
            Shape::Sphere(_)
                | Shape::Cuboid(_)
                | Shape::Plane(_)
                | Shape::Cylinder(_)
                | Shape::Cone(_)
                | Shape::Disc(_)
                | Shape::Triangle(_)
                | Shape::Polygon(_)
                | Shape::Quadric(_)
        )
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
        if self.bounds_first() {
            return self
                .is_seen(ray, scratch)
                .then(|| self.shape.closest_hit(ray, range, from, scratch))?;
        }
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
        if self.bounds_first() {
            return self.is_seen(ray, scratch) && self.shape.any_hit(ray, range, from, scratch);
        }
        self.shape.any_hit(ray, range, from, scratch) && self.is_seen(ray, scratch)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.shape.surface_at(ray, hit)
    }

    fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        self.shape.texture_uv(hit, uv)
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        self.shape.store_bare_surface(ray, hit, out);
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
    use crate::{CsgNode, Cuboid, Cylinder, Disc, Plane, Sphere, Torus, primitive_tests};

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

    /// A bounded leaf of a tree, whose bounds are in the tree's space, as scenes have it.
    fn leaf(shape: impl Into<Shape>, bounds: &[Arc<Csg>], place: Option<Transform>) -> CsgNode {
        let shape = shape.into();
        let bounded = Bounded::new(shape, bounds.to_vec(), place.map(|map| map.inverted()));
        CsgNode::Leaf {
            shape: bounded.into(),
            transform: place.map(Box::new),
            tag: 0,
        }
    }

    /// The planes of a cube, each turned and moved from the plane z = 0.
    fn cube(leaf: &dyn Fn(Shape, Option<Transform>) -> CsgNode) -> Vec<CsgNode> {
        let plane = || Plane::new(DVec3::ZERO, DVec3::Z).into();
        let lift = Transform::translate(DVec3::Z * 0.7);
        let quarter = std::f64::consts::FRAC_PI_2;
        let turns = [0.0, 1.0, 2.0, 3.0].map(|k| Transform::rotate(DVec3::X, k * quarter));
        let sides = [1.0, -1.0].map(|k| Transform::rotate(DVec3::Y, k * quarter));
        let turns = turns.into_iter().chain(sides);
        turns
            .map(|turn| leaf(plane(), Some(lift.then(&turn))))
            .collect()
    }

    #[test]
    fn a_tree_of_bounded_shapes_is_the_tree_where_rays_meet_the_bounds() {
        let bounds = bound(Sphere::new(DVec3::new(0.2, 0.1, -0.4), 0.6));
        let plain = |shape: Shape, place: Option<Transform>| CsgNode::Leaf {
            shape,
            transform: place.map(Box::new),
            tag: 0,
        };
        let seen = |shape: Shape, place| leaf(shape, &bounds, place);
        let hole = || Shape::from(Cylinder::new(-DVec3::Y, DVec3::Y, 0.4));
        let trees = |leaf: &dyn Fn(Shape, Option<Transform>) -> CsgNode| {
            let cut = CsgNode::difference([CsgNode::intersection(cube(leaf)), leaf(hole(), None)]);
            let both = CsgNode::union([CsgNode::merge(cube(leaf)), leaf(hole(), None)]);
            let lens = [0.3, -0.3].map(|x| leaf(Sphere::new(DVec3::X * x, 0.6).into(), None));
            [
                CsgNode::intersection(cube(leaf)),
                cut,
                both,
                CsgNode::intersection(lens),
            ]
        };
        let scratch = &mut Scratch::default();
        let (mut met, mut hidden) = (0, 0);
        for (bounded, plain) in trees(&seen).into_iter().zip(trees(&plain)) {
            let compiled = |node| Csg::try_new(node).expect("a tree");
            let (bounded, plain) = (compiled(bounded), compiled(plain));
            for i in 0..400 {
                let angle = f64::from(i) * 0.377;
                let origin = DVec3::new(
                    3.0 * angle.cos(),
                    f64::from(i % 21) * 0.1 - 1.0,
                    3.0 * angle.sin(),
                );
                let target = DVec3::new(
                    f64::from(i % 7) * 0.2 - 0.6,
                    0.05,
                    f64::from(i % 11) * 0.1 - 0.5,
                );
                let ray = &Ray::new(origin, target - origin);
                let meets = bounds[0].any_hit(ray, Interval::FORWARD, None, scratch);
                let expected = plain.closest_hit(ray, Interval::FORWARD, None, scratch);
                let found = bounded.closest_hit(ray, Interval::FORWARD, None, scratch);
                assert_eq!(found, expected.filter(|_| meets), "{i}");
                let (mut all, mut expected) = (vec![], vec![]);
                bounded.all_hits(ray, Interval::FORWARD, None, scratch, &mut all);
                plain.all_hits(ray, Interval::FORWARD, None, scratch, &mut expected);
                expected.retain(|_| meets);
                assert_eq!(all, expected, "{i}");
                let mut list = Crossings::default();
                bounded.crossings(ray, Interval::FORWARD, None, scratch, &mut list);
                let visible = list.list.iter().find(|c| c.visible);
                assert_eq!(visible.map(|c| c.hit), found, "{i}");
                met += u32::from(found.is_some());
                hidden += u32::from(!meets && !list.list.is_empty());
            }
        }
        assert!(met > 200 && hidden > 200, "{met} {hidden}");
    }

    #[test]
    fn a_slow_shape_is_seen_as_a_fast_one() {
        let bounds = || bound(Sphere::new(DVec3::new(0.5, 0.2, 1.0), 0.7));
        let torus = Torus::try_new(DVec3::ZERO, DVec3::Y, 1.0, 0.4).expect("a torus");
        let bounded = Bounded::new(torus.into(), bounds(), None);
        assert!(sees(&bounded, [1.0, 0.2, -9.0]));
        assert!(!sees(&bounded, [-0.5, 0.2, -9.0]));
        let torus = bounded.shape();
        let ray = &Ray::new(DVec3::new(-0.5, 0.2, -9.0), DVec3::Z);
        assert!(torus.any_hit(ray, Interval::FORWARD, None, &mut Scratch::default()));
    }
}
