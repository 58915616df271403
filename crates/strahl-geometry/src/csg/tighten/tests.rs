use super::*;
use crate::conformance::Random;
use crate::primitives::{Plane, Quadric, Sphere};
use crate::{Blob, BlobComponent, Csg, CsgNode, Cuboid, Cylinder, Primitive, Torus};

fn intersection(shapes: Vec<Shape>) -> Csg {
    let leaves = shapes
        .into_iter()
        .enumerate()
        .map(|(i, shape)| CsgNode::Leaf {
            shape,
            transform: None,
            tag: i as u32,
        });
    Csg::try_new(CsgNode::Intersection(leaves.collect())).expect("valid")
}

fn between(low: f64, high: f64) -> [Shape; 2] {
    [
        Plane::new(DVec3::Y * high, DVec3::Y).into(),
        Plane::new(DVec3::Y * low, DVec3::NEG_Y).into(),
    ]
}

fn assert_near(bounds: Aabb, low: DVec3, high: DVec3, slack: f64) {
    let outside = bounds.min.cmple(low).all() && bounds.max.cmpge(high).all();
    let close =
        (low - bounds.min).max_element() < slack && (bounds.max - high).max_element() < slack;
    assert!(outside && close, "{bounds:?} {low} {high}");
}

/// A chess piece's waist: a hyperboloid of one sheet between two planes.
#[test]
fn a_hyperboloid_between_planes_is_bounded() {
    let hyperboloid = Quadric::new([1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    let [top, bottom] = between(-1.0, 2.0);
    let bounds = intersection(vec![hyperboloid.into(), top, bottom]).bounds();
    let r = 5_f64.sqrt();
    assert_near(
        bounds,
        DVec3::new(-r, -1.0, -r),
        DVec3::new(r, 2.0, r),
        0.15,
    );
}

#[test]
fn endless_cylinders_cones_and_paraboloids_are_bounded_by_planes() {
    let [top, bottom] = between(0.0, 4.0);
    for (coefficients, r) in [
        ([1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -9.0], 3.0),
        ([1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 4.0),
        ([1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0], 2.0),
    ] {
        let shapes = vec![
            Quadric::new(coefficients).into(),
            top.clone(),
            bottom.clone(),
        ];
        let bounds = intersection(shapes).bounds();
        assert_near(bounds, DVec3::new(-r, 0.0, -r), DVec3::new(r, 4.0, r), 0.2);
    }
}

#[test]
fn a_bowl_needs_no_plane_below() {
    let [top, _] = between(0.0, 4.0);
    let bowl = Quadric::new([1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]);
    let bounds = intersection(vec![bowl.into(), top]).bounds();
    assert_near(
        bounds,
        DVec3::new(-2.0, 0.0, -2.0),
        DVec3::new(2.0, 4.0, 2.0),
        0.3,
    );
}

/// Rotated and moved parts are bounded as well, if not as tightly.
#[test]
fn a_turned_hyperboloid_is_bounded() {
    let map = Transform::rotate(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7)
        .then(&Transform::translate(DVec3::new(10.0, -20.0, 5.0)));
    let hyperboloid = Quadric::new([1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    let [top, bottom] = between(-1.0, 1.0);
    let leaves = [hyperboloid.into(), top, bottom].map(|shape| CsgNode::Leaf {
        shape,
        transform: Some(Box::new(map)),
        tag: 0,
    });
    let csg = Csg::try_new(CsgNode::Intersection(leaves.into_iter().collect())).expect("valid");
    let bounds = csg.bounds();
    let center = DVec3::new(10.0, -20.0, 5.0);
    assert!(bounds.is_bounded() && bounds.contains(center), "{bounds:?}");
    // The ball around it has the radius √3.
    assert!((bounds.size() * 0.5).max_element() < 2.2, "{bounds:?}");
}

#[test]
fn lenses_are_flat() {
    let ball = |z: f64| Sphere::new(DVec3::Z * z, 5.0).into();
    let bounds = intersection(vec![ball(4.5), ball(-4.5)]).bounds();
    let r = (25.0 - 4.5 * 4.5_f64).sqrt();
    assert_near(bounds, DVec3::new(-r, -r, -0.5), DVec3::new(r, r, 0.5), 0.4);
}

/// A leaf of a difference: what is subtracted from the first one.
fn difference(leaves: Vec<Shape>) -> Csg {
    let leaf = |shape| CsgNode::Leaf {
        shape,
        transform: None,
        tag: 0,
    };
    Csg::try_new(CsgNode::difference(leaves.into_iter().map(leaf))).expect("valid")
}

#[test]
fn what_is_subtracted_makes_boxes_smaller() {
    // A quarter of a ring.
    let ring = Torus::try_new(DVec3::ZERO, DVec3::Y, 0.8, 0.1).expect("a torus");
    let half = |normal: DVec3| Shape::from(Plane::new(DVec3::ZERO, normal));
    let quarter = difference(vec![ring.into(), half(DVec3::X), half(DVec3::Z)]);
    let (low, high) = (DVec3::new(0.0, -0.1, 0.0), DVec3::new(0.9, 0.1, 0.9));
    assert_near(quarter.bounds(), low, high, 0.03);
    // A ball without its lower part, which is a box.
    let ball = Sphere::new(DVec3::ZERO, 1.0);
    let lower = Cuboid::new(DVec3::splat(-2.0), DVec3::new(2.0, 0.5, 2.0));
    let cap = difference(vec![ball.clone().into(), lower.into()]).bounds();
    let r = 0.75_f64.sqrt();
    assert_near(cap, DVec3::new(-r, 0.5, -r), DVec3::new(r, 1.0, r), 0.08);
    // A hole changes nothing.
    let hole = Cylinder::new(-DVec3::Y, DVec3::Y, 0.5);
    let bounds = difference(vec![ball.into(), hole.into()]).bounds();
    assert_near(bounds, -DVec3::ONE, DVec3::ONE, 1e-6);
}

/// What a shape says of the side of a box is true of points in it.
#[test]
fn boxes_are_on_the_side_that_is_told() {
    let mut random = Random::new(3);
    let tilted = DVec3::new(0.3, 1.0, -0.5).normalize();
    let torus = |minor| Torus::try_new(DVec3::X * 0.2, tilted, 1.0, minor).expect("a torus");
    let squeezed = Transform::try_scale(DVec3::new(1.0, 0.6, 1.3)).expect("regular");
    let blob = Blob::new(
        0.4,
        vec![
            BlobComponent::sphere(DVec3::ZERO, 1.2, 1.0),
            BlobComponent::cylinder(DVec3::NEG_X, tilted, 0.8, 0.9).transformed(&squeezed),
            BlobComponent::sphere(DVec3::X * 0.5, 0.7, -0.8),
        ],
    );
    let shapes: [Shape; 3] = [torus(0.4).into(), torus(1.3).into(), blob.into()];
    for shape in &shapes {
        let solid = shape.as_solid().expect("a solid");
        let mut told = [0; 2];
        for _ in 0..3000 {
            let half = (random.cube() + DVec3::splat(1.01)) * random.magnitude(-2.5, -0.5);
            let center = random.cube() * 2.0;
            let cell = Aabb::new(center - half, center + half);
            let Some(side) = solid.side_of(&cell) else {
                continue;
            };
            told[usize::from(side)] += 1;
            for _ in 0..20 {
                let point = center + half * random.cube();
                assert_eq!(solid.contains(point), side, "{shape:?} {cell:?} {point}");
            }
            assert!(side || cell.corners().into_iter().all(|c| !solid.contains(c)));
        }
        assert!(told.iter().all(|count| *count > 50), "{told:?}");
    }
}

#[test]
fn blobs_are_cut_where_their_field_is_low() {
    let component =
        |x: f64, radius, strength| BlobComponent::sphere(DVec3::X * x, radius, strength);
    let blob = Blob::try_new(
        0.5,
        vec![component(0.0, 1.0, 1.0), component(0.03, 0.6, -1.0)],
    );
    let floor = Plane::new(DVec3::ZERO, DVec3::Y);
    let cap = difference(vec![blob.expect("a blob").into(), floor.into()]).bounds();
    // A thin cap on the side where the second field is weaker.
    assert!(cap.max.x < -0.1 && cap.min.x > -0.6, "{cap:?}");
    assert!(cap.min.y > -0.05 && cap.max.y < 0.52, "{cap:?}");
}

#[test]
fn what_is_endless_stays_so() {
    let cylinder = Quadric::new([1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    let [top, _] = between(0.0, 1.0);
    let bounds = intersection(vec![cylinder.into(), top]).bounds();
    assert!(!bounds.is_bounded(), "{bounds:?}");
}
