use super::{Csg, CsgNode};
use crate::conformance::Random;
use crate::{
    Crossings, Cuboid, Cylinder, GeometryError, Plane, PrimHit, Primitive, Scratch, Shape, Side,
    Solid, Sphere, SurfaceId, SurfacePoint,
};
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

fn ball(x: f64, radius: f64, tag: u32) -> CsgNode {
    CsgNode::leaf(Sphere::new(DVec3::new(x, 0.0, 0.0), radius), tag)
}

fn cube(min: f64, max: f64, tag: u32) -> CsgNode {
    CsgNode::leaf(Cuboid::new(DVec3::splat(min), DVec3::splat(max)), tag)
}

fn slab(x0: f64, x1: f64, y: f64, tag: u32) -> CsgNode {
    CsgNode::leaf(
        Cuboid::new(DVec3::new(x0, -y, -y), DVec3::new(x1, y, y)),
        tag,
    )
}

fn compiled(tree: CsgNode) -> Csg {
    Csg::try_new(tree).expect("a valid tree")
}

fn list(csg: &Csg, ray: &Ray, range: Interval) -> Crossings {
    let mut out = Crossings::default();
    csg.crossings(ray, range, None, &mut Scratch::default(), &mut out);
    out
}

/// The crossings of the x axis and their kind: `>` in, `<` out, `|` inner, lower case for invisible.
fn along_x(tree: CsgNode) -> Vec<(f64, char, u32)> {
    let csg = compiled(tree);
    let ray = Ray::new(DVec3::new(-10.0, 0.0, 0.0), DVec3::X);
    list(&csg, &ray, Interval::LINE)
        .list
        .iter()
        .map(|c| {
            let side = match (c.side, c.visible) {
                (Side::Enter, true) => '>',
                (Side::Exit, true) => '<',
                (Side::Inner, true) => '|',
                (Side::Enter, false) => 'i',
                (Side::Exit, false) => 'o',
                (Side::Inner, false) => '?',
            };
            (
                c.hit.t - 10.0,
                side,
                csg.leaf_tag(csg.leaf_of(c.surface().element).0),
            )
        })
        .collect()
}

/// An open square at a certain x, front towards -x.
#[derive(Debug)]
struct Screen(f64);

impl Primitive for Screen {
    fn kind(&self) -> &'static str {
        "screen"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        Aabb::new(DVec3::new(self.0, -9.0, -9.0), DVec3::new(self.0, 9.0, 9.0))
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _: &mut Scratch,
    ) -> Option<PrimHit> {
        let t = (self.0 - ray.origin.x) / ray.direction.x;
        (from.is_none() && range.accepts(t)).then(|| PrimHit::simple(t, 0))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        SurfacePoint {
            position: ray.at(hit.t),
            position_error: DVec3::splat(1e-14),
            n_geom: -DVec3::X,
            n_shade: -DVec3::X,
            uv: DVec2::ZERO,
            dpdu: DVec3::ZERO,
            dpdv: DVec3::ZERO,
        }
    }
}

fn screen(x: f64, tag: u32) -> CsgNode {
    CsgNode::leaf(Shape::Custom(Arc::new(Screen(x))), tag)
}

#[test]
fn two_balls_make_a_lens() {
    let lens = CsgNode::intersection([ball(-1.0, 2.0, 7), ball(1.0, 2.0, 8)]);
    assert_eq!(along_x(lens), [(-1.0, '>', 8), (1.0, '<', 7)]);
    let csg = compiled(CsgNode::intersection([
        ball(-1.0, 2.0, 7),
        ball(1.0, 2.0, 8),
    ]));
    let bounds = csg.bounds();
    assert!((bounds.min.x + 1.0).abs() < 1e-12 && (bounds.max.x - 1.0).abs() < 1e-12);
}

#[test]
fn a_box_with_a_ball_taken_out() {
    let tree = || CsgNode::difference([cube(-2.0, 2.0, 1), ball(0.0, 1.0, 2)]);
    let expected = [(-2.0, '>', 1), (-1.0, '<', 2), (1.0, '>', 2), (2.0, '<', 1)];
    assert_eq!(along_x(tree()), expected);
    let csg = compiled(tree());
    let ray = Ray::new(DVec3::ZERO, DVec3::X);
    let hit = csg
        .closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
        .expect("the wall of the hole");
    // The wall of the hole faces the hole.
    assert_eq!(csg.surface_at(&ray, &hit).n_geom, -DVec3::X);
    assert!(csg.contains(DVec3::splat(1.5)) && !csg.contains(DVec3::ZERO));
}

/// As POV-Ray 3.7 renders them. The surface of a box counts as inside, that of a cylinder does not.
#[test]
fn flush_faces_show_as_in_povray() {
    let rod = |x0: f64, x1: f64, radius: f64, tag: u32| {
        CsgNode::leaf(Cylinder::new(DVec3::X * x0, DVec3::X * x1, radius), tag)
    };
    // The pocket begins exactly in the face of the block: the face of the subtracted solid is inside of the box, as a lid.
    let flush = CsgNode::difference([slab(-1.0, 1.0, 2.0, 1), slab(-1.0, 0.0, 1.0, 2)]);
    let pocket = [(0.0, '>', 2), (1.0, '<', 1)];
    assert_eq!(along_x(flush), [(-1.0, '|', 2), pocket[0], pocket[1]]);
    let through = CsgNode::difference([slab(-1.0, 1.0, 2.0, 1), slab(-1.0, 1.0, 1.0, 2)]);
    assert_eq!(along_x(through), [(-1.0, '|', 2), (1.0, '|', 2)]);
    // `difference { cylinder { -y, y, 1 } cylinder { -0.9 * y, y, 0.8 } }` keeps its lid, which is not inside of the second
    // cylinder.
    let cup = CsgNode::difference([rod(-1.0, 1.0, 2.0, 1), rod(-1.0, 0.0, 1.0, 2)]);
    assert_eq!(along_x(cup), [(-1.0, '|', 1), pocket[0], pocket[1]]);
    let both = CsgNode::difference([slab(-1.0, 1.0, 2.0, 1), rod(-1.0, 0.0, 1.0, 2)]);
    assert_eq!(along_x(both), [(-1.0, '|', 2), pocket[0], pocket[1]]);
    let neither = CsgNode::difference([rod(-1.0, 1.0, 2.0, 1), slab(-1.0, 0.0, 1.0, 2)]);
    assert_eq!(along_x(neither), pocket);
    // Side by side.
    let touching = CsgNode::intersection([slab(-1.0, 0.0, 1.0, 1), slab(0.0, 1.0, 1.0, 2)]);
    assert_eq!(along_x(touching), [(0.0, '|', 2)]);
    let touching = CsgNode::intersection([rod(-1.0, 0.0, 1.0, 1), rod(0.0, 1.0, 1.0, 2)]);
    assert_eq!(along_x(touching), []);
    let (left, right) = ((-1.0, '>', 1), (1.0, '<', 2));
    let joined = CsgNode::merge([slab(-1.0, 0.0, 1.0, 1), slab(0.0, 1.0, 1.0, 2)]);
    assert_eq!(along_x(joined), [left, right]);
    let joined = CsgNode::merge([rod(-1.0, 0.0, 1.0, 1), rod(0.0, 1.0, 1.0, 2)]);
    assert_eq!(along_x(joined), [left, (0.0, '|', 2), right]);
    let kept = CsgNode::union([slab(-1.0, 0.0, 1.0, 1), slab(0.0, 1.0, 1.0, 2)]);
    assert_eq!(along_x(kept), [left, (0.0, '|', 1), right]);
    // The same face.
    for order in [true, false] {
        let solids = || {
            let (a, b) = (slab(-1.0, 1.0, 2.0, 1), rod(-1.0, 1.0, 1.0, 2));
            if order { [a, b] } else { [b, a] }
        };
        let inside = CsgNode::intersection(solids());
        assert_eq!(along_x(inside), [(-1.0, '>', 2), (1.0, '<', 2)]);
        let outside = CsgNode::merge(solids());
        assert_eq!(along_x(outside), [(-1.0, '>', 1), (1.0, '<', 1)]);
    }
}

#[test]
fn faces_that_coincide_up_to_rounding_are_one() {
    // 0.1 + 0.2 differs from 0.3 in the last bit; the boxes are in spaces rotated about the axis perpendicular to the faces.
    let mut random = Random::new(3);
    for _ in 0..2000 {
        let turn = Transform::rotate(DVec3::X, random.between(0.0, 6.0));
        let everything = Transform::rotate(random.direction(), random.between(0.0, 6.0))
            .then(&Transform::translate(random.cube() * 5.0));
        let csg = compiled(
            CsgNode::difference([
                slab(0.1 + 0.2, 1.0, 2.0, 1),
                slab(0.3, 0.7, 1.0, 2).transformed(turn),
            ])
            .transformed(everything),
        );
        let target = DVec3::new(0.3, random.between(-0.6, 0.6), random.between(-0.6, 0.6));
        let origin = target + DVec3::new(-3.0, random.between(-3.0, 3.0), 0.4);
        let ray = Ray::new(
            everything.point_to_world(origin),
            everything.vector_to_world(target - origin),
        );
        let mut scratch = Scratch::default();
        let hit = csg.closest_hit(&ray, Interval::FORWARD, None, &mut scratch);
        let is_lid = |hit: &PrimHit| (hit.t - 1.0).abs() < 1e-9 && hit.surface.element == 1;
        assert!(hit.is_some_and(|hit| is_lid(&hit)), "{hit:?}");
    }
}

#[test]
fn rounding_of_maps_counts_for_coincidence() {
    // Rays from far away at a flat angle: rounding of their origins in the two spaces moves `t` by more than the error bounds of
    // the boxes.
    let mut random = Random::new(4);
    let thrice = Transform::try_scale(DVec3::new(3.0, 1.0, 1.0)).expect("regular");
    for _ in 0..2000 {
        let everything = Transform::rotate(random.direction(), random.between(0.0, 6.0));
        let csg = compiled(
            CsgNode::difference([
                slab(0.0, 1.0, 2.0, 1),
                slab(0.0, 0.2, 1.5, 2).transformed(thrice),
            ])
            .transformed(everything),
        );
        let target = DVec3::new(0.0, random.between(-1.4, 1.4), random.between(-1.4, 1.4));
        let origin = target + DVec3::new(-1e-3, 1e3, 0.0);
        let ray = Ray::new(
            everything.point_to_world(origin),
            everything.vector_to_world(target - origin),
        );
        let range = Interval::new(0.999, 1.0001);
        let hit = csg.closest_hit(&ray, range, None, &mut Scratch::default());
        assert!(hit.is_some_and(|hit| hit.surface.element == 1), "{hit:?}");
    }
}

#[test]
fn of_coincident_faces_an_intersection_shows_the_last_and_a_union_the_first() {
    for (a, b) in [(1, 2), (2, 1)] {
        let same = CsgNode::intersection([cube(-1.0, 1.0, a), cube(-1.0, 1.0, b)]);
        assert_eq!(along_x(same), [(-1.0, '>', b), (1.0, '<', b)]);
        let same = CsgNode::union([cube(-1.0, 1.0, a), cube(-1.0, 1.0, b)]);
        assert_eq!(along_x(same), [(-1.0, '>', a), (1.0, '<', a)]);
    }
}

#[test]
fn unions_keep_inner_surfaces_and_merges_drop_them() {
    let balls = || [ball(-1.0, 2.0, 1), ball(1.0, 2.0, 2)];
    let (left, right) = ((-3.0, '>', 1), (3.0, '<', 2));
    let inner = [(-1.0, '|', 2), (1.0, '|', 1)];
    assert_eq!(
        along_x(CsgNode::union(balls())),
        [left, inner[0], inner[1], right]
    );
    assert_eq!(along_x(CsgNode::merge(balls())), [left, right]);
    // As in POV-Ray: an intersection with an object around them keeps them, ...
    let around = CsgNode::intersection([cube(-5.0, 5.0, 3), CsgNode::union(balls())]);
    assert_eq!(along_x(around), [left, inner[0], inner[1], right]);
    // ... so does a merge with an object beside them, ...
    let beside = CsgNode::merge([CsgNode::union(balls()), ball(6.0, 1.0, 3)]);
    assert_eq!(along_x(beside)[..4], [left, inner[0], inner[1], right]);
    // ... and a merge with an object around them removes them.
    let within = CsgNode::merge([CsgNode::union(balls()), cube(-5.0, 5.0, 3)]);
    assert_eq!(along_x(within), [(-5.0, '>', 3), (5.0, '<', 3)]);
}

#[test]
fn what_is_taken_out_leaves_no_ghosts() {
    // Inner surfaces of a union lie outside of its complement. Checked against POV-Ray 3.7.
    let balls = || CsgNode::union([ball(-1.0, 2.0, 1), ball(1.0, 2.0, 2)]);
    let expected = [(-5.0, '>', 3), (-3.0, '<', 1), (3.0, '>', 2), (5.0, '<', 3)];
    assert_eq!(
        along_x(CsgNode::difference([cube(-5.0, 5.0, 3), balls()])),
        expected
    );
    let twice = CsgNode::intersection([cube(-5.0, 5.0, 3), balls().inverted().inverted()]);
    assert_eq!(along_x(twice), [(-3.0, '>', 1), (3.0, '<', 2)]);
    let lens = CsgNode::intersection([ball(-1.0, 2.0, 1), ball(1.0, 2.0, 2)]);
    let expected = [(-5.0, '>', 3), (-1.0, '<', 2), (1.0, '>', 1), (5.0, '<', 3)];
    assert_eq!(
        along_x(CsgNode::difference([cube(-5.0, 5.0, 3), lens])),
        expected
    );
}

#[test]
fn inverses_nest() {
    let hole = compiled(ball(0.0, 1.0, 1).inverted());
    assert_eq!(hole.bounds(), Aabb::EVERYTHING);
    let ray = Ray::new(DVec3::new(-10.0, 0.0, 0.0), DVec3::X);
    let crossings = list(&hole, &ray, Interval::LINE);
    assert!(crossings.inside_at_start && crossings.list.len() == 2);
    assert_eq!(
        hole.surface_at(&ray, &crossings.list[0].hit).n_geom,
        DVec3::X
    );
    assert!(hole.contains(DVec3::splat(3.0)) && !hole.contains(DVec3::ZERO));

    let shell = |tag: u32| CsgNode::difference([ball(0.0, 2.0, tag), ball(0.0, 1.0, tag + 1)]);
    let expected = [(-2.0, '>', 1), (-1.0, '<', 2), (1.0, '>', 2), (2.0, '<', 1)];
    assert_eq!(along_x(shell(1).inverted().inverted()), expected);
    let complement = compiled(shell(1).inverted());
    assert!(complement.contains(DVec3::ZERO) && complement.contains(DVec3::splat(9.0)));
    assert!(!complement.contains(DVec3::new(1.5, 0.0, 0.0)));
    // The outside of two objects is the part outside of both.
    let outside = CsgNode::Inverse(vec![ball(-1.0, 2.0, 1), ball(1.0, 2.0, 2)].into());
    assert_eq!(along_x(outside), [(-3.0, '<', 1), (3.0, '>', 2)]);
}

#[test]
fn a_clipped_object_has_no_cap() {
    let half = || CsgNode::clip(ball(0.0, 2.0, 1), [slab(-9.0, 0.5, 9.0, 2)]);
    assert_eq!(along_x(half()), [(-2.0, '>', 1), (0.5, 'o', 2)]);
    let csg = compiled(half());
    let ray = Ray::new(DVec3::new(10.0, 0.0, 0.0), -DVec3::X);
    let hit = csg.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
    assert_eq!(hit.map(|hit| hit.t), Some(12.0), "through the open end");
    assert!(csg.contains(DVec3::ZERO) && !csg.contains(DVec3::X));
}

#[test]
fn the_complement_of_a_clipped_object_is_clipped() {
    let half = |high| CsgNode::clip(ball(0.0, 2.0, 1), [slab(-9.0, high, 9.0, 2)]);
    // The other object is cut by the slab as well, which leaves no surface.
    let rest = |high| CsgNode::difference([cube(-5.0, 5.0, 3), half(high)]);
    assert_eq!(along_x(rest(0.5)), [(-5.0, '>', 3), (-2.0, '<', 1)]);
    let beyond = [(-5.0, '>', 3), (-2.0, '<', 1), (2.0, '>', 1), (3.0, 'o', 2)];
    assert_eq!(along_x(rest(3.0)), beyond);
    // A second inversion restores the object.
    assert_eq!(along_x(half(0.5).inverted().inverted()), along_x(half(0.5)));
}

#[test]
fn open_surfaces_are_cut() {
    let csg = compiled(CsgNode::clip(screen(0.0, 1), [ball(0.0, 2.0, 2)]));
    assert!(csg.as_solid().is_none());
    let hit = |y: f64| {
        let ray = Ray::new(DVec3::new(-10.0, y, 0.0), DVec3::X);
        csg.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
            .map(|hit| hit.t)
    };
    assert_eq!((hit(1.9), hit(2.1)), (Some(10.0), None));
    assert!((csg.bounds().max.y - 2.0).abs() < 1e-12);
    // An intersection keeps the part inside, a difference the part outside. The open surface has no inside, and no outside that
    // could keep a surface.
    let inside = CsgNode::intersection([screen(0.0, 1), ball(0.0, 2.0, 2)]);
    assert_eq!(along_x(inside), [(0.0, '|', 1)]);
    let outside = CsgNode::difference([screen(0.0, 1), ball(0.0, 2.0, 2)]);
    assert_eq!(along_x(outside), []);
    let scratched = CsgNode::difference([ball(0.0, 2.0, 2), screen(0.0, 1)]);
    assert_eq!(along_x(scratched), [(0.0, '|', 1)]);
    let both = CsgNode::union([screen(5.0, 1), ball(0.0, 2.0, 2)]);
    assert_eq!(
        along_x(both),
        [(-2.0, '>', 2), (2.0, '<', 2), (5.0, '|', 1)]
    );
    let merged = CsgNode::merge([screen(0.0, 1), screen(5.0, 3), ball(0.0, 2.0, 2)]);
    assert_eq!(
        along_x(merged),
        [(-2.0, '>', 2), (2.0, '<', 2), (5.0, '|', 3)]
    );
}

#[test]
fn rays_may_start_inside_and_on_surfaces() {
    let csg = compiled(CsgNode::difference([cube(-2.0, 2.0, 1), ball(0.0, 1.0, 2)]));
    let scratch = &mut Scratch::default();
    let mut start = |x: f64, dx: f64, from: Option<SurfaceId>| {
        let ray = Ray::new(DVec3::new(x, 0.0, 0.0), DVec3::new(dx, 0.0, 0.0));
        let mut out = Crossings::default();
        csg.crossings(&ray, Interval::FORWARD, from, scratch, &mut out);
        let ts = out.list.iter().map(|c| c.hit.t).collect::<Vec<_>>();
        (out.inside_at_start, ts)
    };
    let on = |element, facet| Some(SurfaceId { element, facet });
    assert_eq!(start(1.5, 1.0, None), (true, vec![0.5]));
    assert_eq!(start(0.0, 1.0, None), (false, vec![1.0, 2.0]));
    // On the wall of the hole, into the material and into the hole.
    assert_eq!(start(1.0, 1.0, on(1, 0)), (true, vec![1.0]));
    assert_eq!(start(1.0, -1.0, on(1, 0)), (false, vec![2.0, 3.0]));
    // On the face of the box.
    assert_eq!(start(2.0, 1.0, on(0, 1)), (false, vec![]));
    assert_eq!(start(2.0, -1.0, on(0, 1)), (true, vec![1.0, 3.0, 4.0]));
}

#[test]
fn a_start_on_coincident_faces_counts_as_passed_for_both() {
    let csg = compiled(CsgNode::merge([
        slab(-1.0, 0.1 + 0.2, 1.0, 1),
        slab(0.3, 2.0, 0.5, 2),
    ]));
    // Rounding puts the second face behind the first by one unit; a ray from there starts inside.
    let ray = Ray::new(DVec3::new(0.3f64.next_down(), 0.1, 0.1), DVec3::X);
    let from = Some(SurfaceId {
        element: 0,
        facet: 1,
    });
    let mut out = Crossings::default();
    csg.crossings(
        &ray,
        Interval::FORWARD,
        from,
        &mut Scratch::default(),
        &mut out,
    );
    assert!(out.inside_at_start);
    assert_eq!(out.list.len(), 1);
}

#[test]
fn elements_lead_back_to_leaves() {
    let shell = compiled(CsgNode::difference([
        ball(0.0, 2.0, 70),
        ball(0.0, 1.0, 71),
    ]));
    let nested: Arc<Csg> = Arc::new(shell);
    let csg = compiled(CsgNode::union([
        ball(0.0, 1.0, 5),
        CsgNode::intersection([
            CsgNode::leaf(nested, 6),
            CsgNode::merge([ball(1.0, 1.0, 7), ball(2.0, 1.0, 8)]),
        ]),
    ]));
    assert_eq!((csg.elements(), csg.leaves()), (5, 4));
    let leaves = (0..5)
        .map(|element| csg.leaf_of(element))
        .collect::<Vec<_>>();
    assert_eq!(leaves, [(0, 0), (1, 0), (1, 1), (2, 0), (3, 0)]);
    let tags = (0..5).map(|leaf| csg.leaf_tag(leaf)).collect::<Vec<_>>();
    assert_eq!(tags, [5, 6, 7, 8, 0]);
    assert_eq!(csg.leaf_shape(1).map(Primitive::kind), Some("csg"));
}

#[test]
fn a_tree_within_a_tree_is_the_same_solid() {
    let shell = || CsgNode::difference([ball(0.0, 2.0, 1), ball(0.5, 1.0, 2)]);
    let flat = CsgNode::difference([cube(-3.0, 3.0, 3), shell()]);
    let inner = Arc::new(compiled(shell()));
    let nested = CsgNode::difference([cube(-3.0, 3.0, 3), CsgNode::leaf(inner, 4)]);
    let places = |tree| {
        along_x(tree)
            .into_iter()
            .map(|c| (c.0, c.1))
            .collect::<Vec<_>>()
    };
    assert_eq!(places(flat), places(nested));
}

#[test]
fn impossible_trees_are_refused() {
    let empty = CsgNode::union([]);
    let error = Csg::try_new(CsgNode::difference([ball(0.0, 1.0, 1), empty]));
    let message = error.err().map(|e| e.to_string());
    assert_eq!(
        message.as_deref(),
        Some("the union is degenerate: it has no operands; give at least one")
    );
    let bad = Csg::try_new(CsgNode::merge([ball(0.0, 1.0, 1), ball(0.0, f64::NAN, 2)]));
    assert!(matches!(bad, Err(GeometryError::NotFinite { .. })));
}

#[test]
fn a_thousand_holes_are_found_by_their_boxes() {
    let hole = |i: u32| ball(f64::from(i) * 4.0, 1.0, i + 1);
    let plate = slab(-2.0, 4000.0, 1.5, 0);
    let csg = compiled(CsgNode::difference(
        std::iter::once(plate).chain((0..1000).map(hole)),
    ));
    let ray = Ray::new(DVec3::new(2400.5, -9.0, 0.0), DVec3::Y);
    let crossings = list(&csg, &ray, Interval::FORWARD);
    let tags: Vec<u32> = crossings
        .list
        .iter()
        .map(|c| csg.leaf_tag(csg.leaf_of(c.surface().element).0))
        .collect();
    assert_eq!(tags, [0, 601, 601, 0]);
    let along = Ray::new(DVec3::new(-9.0, 0.0, 0.0), DVec3::X);
    assert_eq!(list(&csg, &along, Interval::FORWARD).list.len(), 2002);
}

/// A chain of alternating operations, so that nothing can be flattened.
fn chain(depth: u32) -> CsgNode {
    let mut tree = ball(0.0, 1.0, 0);
    for i in 1..=depth {
        let x = f64::from(i % 7) * 0.1;
        tree = match i % 4 {
            0 => CsgNode::union([tree, ball(x, 1.0, i)]),
            1 => CsgNode::difference([tree, ball(-x, 0.3, i)]),
            2 => CsgNode::merge([ball(x, 0.9, i), tree]),
            _ => CsgNode::intersection([ball(x, 1.4, i), tree.inverted()]).inverted(),
        };
    }
    tree
}

#[test]
fn depth_needs_no_stack() {
    let csg = compiled(chain(10_000));
    assert_eq!(csg.leaves(), 10_001);
    let ray = Ray::new(DVec3::new(-5.0, 0.05, 0.02), DVec3::X);
    let crossings = list(&csg, &ray, Interval::LINE);
    for pair in crossings.list.windows(2) {
        let t = 0.5 * (pair[0].hit.t + pair[1].hit.t);
        assert_eq!(csg.contains(ray.at(t)), crossings.inside_after(t));
    }
    assert!(!crossings.list.is_empty());
    // Neither does dropping a tree that is never compiled, or one whose compilation fails half-way.
    drop(chain(10_000));
    drop(CsgNode::clip(chain(10_000), [chain(10_000)]).transformed(Transform::IDENTITY));
    let bad = CsgNode::union([ball(0.0, f64::NAN, 1), chain(10_000)]);
    assert!(Csg::try_new(bad).is_err());
    assert_eq!(
        format!("{:?}", CsgNode::union([chain(10_000)])),
        "Union([1 operands])"
    );
}

#[test]
fn memory_is_used_again() {
    let csg = compiled(chain(50));
    let scratch = &mut Scratch::default();
    let ray = Ray::new(DVec3::new(-5.0, 0.05, 0.02), DVec3::X);
    let mut query = || csg.closest_hit(&ray, Interval::FORWARD, None, scratch);
    assert_eq!(query(), query());
    let lists = format!("{scratch:?}").matches("inside_at_start").count();
    query_again(&csg, &ray, scratch);
    assert_eq!(
        format!("{scratch:?}").matches("inside_at_start").count(),
        lists
    );
}

fn query_again(csg: &Csg, ray: &Ray, scratch: &mut Scratch) {
    for _ in 0..10 {
        csg.any_hit(ray, Interval::FORWARD, None, scratch);
    }
}

mod conformance {
    use super::*;

    crate::primitive_tests!(lens, || compiled(CsgNode::intersection([
        ball(-1.0, 2.0, 1),
        ball(1.0, 2.0, 2)
    ])));
    crate::primitive_tests!(hollowed_box, || compiled(CsgNode::difference([
        cube(-1.0, 1.0, 1),
        ball(0.0, 1.2, 2)
    ])));
    crate::primitive_tests!(union, || compiled(CsgNode::union([
        ball(-0.5, 1.0, 1),
        cube(0.0, 1.0, 2)
    ])));
    crate::primitive_tests!(flush, || compiled(CsgNode::difference([
        slab(-1.0, 1.0, 1.0, 1),
        slab(-1.0, 0.5, 0.5, 2),
    ])));
    crate::primitive_tests!(turned, || compiled(
        CsgNode::merge([
            CsgNode::difference([cube(-1.0, 1.0, 1), ball(0.0, 1.2, 2)])
                .transformed(Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 0.7)),
            ball(1.0, 0.7, 3)
                .transformed(Transform::try_scale(DVec3::new(1.0, 0.4, 2.0)).expect("regular")),
        ])
        .transformed(Transform::translate(DVec3::new(2.0, -1.0, 0.5)))
    ));
    crate::primitive_tests!(clipped, || compiled(CsgNode::clip(
        ball(0.0, 1.0, 1),
        [slab(-2.0, 0.3, 2.0, 2)]
    )));
    crate::primitive_tests!(bored_and_cut, || compiled(CsgNode::difference([
        ball(0.0, 1.0, 1),
        CsgNode::leaf(Cylinder::new(DVec3::NEG_Z * 2.0, DVec3::Z * 2.0, 0.4), 2),
        CsgNode::leaf(Plane::new(DVec3::Y * -0.3, DVec3::new(0.0, 1.0, 0.2)), 3),
    ])));
    crate::primitive_tests!(between_planes, || compiled(CsgNode::intersection(
        [
            DVec3::X,
            DVec3::new(-1.0, 0.3, 0.0),
            DVec3::Y,
            DVec3::NEG_Y,
            DVec3::Z,
            DVec3::NEG_Z
        ]
        .map(|n| CsgNode::leaf(Plane::new(n, n), 0))
    )));
}

/// As POV-Ray 3.7 renders them: `open` removes the visible caps, not the inside.
#[test]
fn open_cylinders_cones_and_discs_carve() {
    let tube = || CsgNode::leaf(Cylinder::open(DVec3::X * -5.0, DVec3::X, 1.0), 2);
    let carved = CsgNode::difference([slab(-2.0, 3.0, 2.0, 1), tube()]);
    assert_eq!(along_x(carved), [(1.0, 'i', 2), (3.0, '<', 1)]);
    let cone = CsgNode::leaf(crate::Cone::open(DVec3::X * -5.0, 2.0, DVec3::X, 1.0), 2);
    let carved = CsgNode::difference([slab(-2.0, 3.0, 2.0, 1), cone]);
    assert_eq!(along_x(carved), [(1.0, 'i', 2), (3.0, '<', 1)]);
    let kept = CsgNode::intersection([slab(-2.0, 3.0, 2.0, 1), tube()]);
    assert_eq!(along_x(kept), [(-2.0, '>', 1), (1.0, 'o', 2)]);
    // The inside of a disc is the half-space behind it.
    let disc =
        |normal: DVec3, hole: f64| CsgNode::leaf(crate::Disc::new(DVec3::X, normal, 3.0, hole), 2);
    let cut = CsgNode::intersection([slab(-2.0, 3.0, 2.0, 1), disc(DVec3::X, 0.0)]);
    assert_eq!(along_x(cut), [(-2.0, '>', 1), (1.0, '<', 2)]);
    let cut = CsgNode::difference([slab(-2.0, 3.0, 2.0, 1), disc(DVec3::X, 1.0)]);
    assert_eq!(along_x(cut), [(1.0, 'i', 2), (3.0, '<', 1)]);
    let cut = CsgNode::difference([slab(-2.0, 3.0, 2.0, 1), disc(-DVec3::X, 0.0)]);
    assert_eq!(along_x(cut), [(-2.0, '>', 1), (1.0, '<', 2)]);
}
