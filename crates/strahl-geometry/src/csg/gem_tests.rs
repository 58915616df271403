//! Gems: intersections of half-spaces, intersected in one pass or plane by plane.

use super::{Csg, CsgNode};
use crate::conformance::Random;
use crate::{Crossings, Plane, Primitive, Scratch, Solid, Sphere, SurfaceId};
use strahl_math::{Aabb, DVec3, Interval, Ray};

fn facet(point: DVec3, normal: DVec3) -> CsgNode {
    CsgNode::leaf(Plane::new(point, normal), 0)
}

fn gem(facets: impl IntoIterator<Item = CsgNode>) -> Csg {
    Csg::try_new(CsgNode::intersection(facets)).expect("a valid tree")
}

fn list(csg: &Csg, ray: &Ray, range: Interval, from: Option<SurfaceId>) -> Crossings {
    let mut out = Crossings::default();
    csg.crossings(ray, range, from, &mut Scratch::default(), &mut out);
    out
}

/// Facets around the origin; some lie in one plane, some are inverted, so that little or nothing is left.
fn random_facets(random: &mut Random, center: DVec3) -> Vec<CsgNode> {
    let count = 2 + random.below(30);
    let mut facets = vec![];
    let mut last = (DVec3::X, DVec3::X);
    for _ in 0..count {
        if random.below(6) > 0 {
            let normal = random.direction();
            let distance = if random.below(20) == 0 { -0.3 } else { 1.0 };
            last = (center + normal * distance, normal);
        }
        facets.push(facet(last.0, last.1));
    }
    if random.below(3) == 0 {
        facets.push(CsgNode::leaf(Sphere::new(center, 1.1), 0));
    }
    facets
}

#[test]
fn one_pass_and_plane_by_plane_give_the_same_bits() {
    let mut random = Random::new(11);
    let (mut crossed, mut inside) = (0, 0);
    for case in 0..400 {
        let center = random.direction() * (50 * random.below(3)) as f64;
        let seed = random.bits();
        let facets = || random_facets(&mut Random::new(seed), center);
        let (fast, slow) = (gem(facets()), gem(facets()).without_half_spaces());
        assert!(fast.node(0).is_some_and(|node| node.half_spaces.is_some()));
        for _ in 0..60 {
            let target = center + random.direction() * random.unit();
            let origin = center + random.direction() * 4.0 * random.unit();
            let mut ray = Ray::new(origin, target - origin);
            let ranges = [
                Interval::LINE,
                Interval::FORWARD,
                Interval::new(0.5 * random.unit(), 0.5 + random.unit()),
            ];
            let mut from = None;
            // Rays from outside onto the gem, through it and out again, as light does.
            for _ in 0..4 {
                for range in ranges {
                    let (a, b) = (
                        list(&fast, &ray, range, from),
                        list(&slow, &ray, range, from),
                    );
                    assert_eq!(a, b, "case {case}: {ray:?} {range:?} {from:?}");
                }
                let all = list(&fast, &ray, Interval::FORWARD, from);
                inside += usize::from(all.inside_at_start);
                let Some(first) = all.list.first() else {
                    break;
                };
                crossed += 1;
                let surface = fast.surface_at(&ray, &first.hit);
                ray = Ray::new(surface.position, ray.direction + random.direction() * 0.3);
                from = Some(first.hit.surface);
            }
        }
    }
    assert!(crossed > 10_000 && inside > 5_000, "{crossed} {inside}");
}

#[test]
fn edges_and_corners_are_left_to_the_general_way() {
    let cube = || {
        DVec3::AXES
            .into_iter()
            .flat_map(|axis| [facet(axis, axis), facet(-axis, -axis)])
    };
    let (fast, slow) = (gem(cube()), gem(cube()).without_half_spaces());
    let mut hits = 0;
    for i in 0..200 {
        let y = f64::from(i % 20) / 10.0;
        let z = f64::from(i / 20) / 5.0;
        for direction in [
            DVec3::X,
            DVec3::new(1.0, -y, -z),
            DVec3::new(1.0, 1e-9, 0.0),
        ] {
            let ray = Ray::new(DVec3::new(-2.0, y, z), direction);
            let found = list(&fast, &ray, Interval::FORWARD, None);
            assert_eq!(found, list(&slow, &ray, Interval::FORWARD, None), "{ray:?}");
            hits += found.list.len();
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn gems_have_tight_boxes() {
    let close = |a: Aabb, b: Aabb| {
        let error = (a.min - b.min).abs().max_element() + (a.max - b.max).abs().max_element();
        assert!(error < 1e-6, "{a:?} is not {b:?}");
    };
    let corner = DVec3::new(1.0, 1.0, 1.0).normalize();
    let signs = (0..8).map(|i: u32| {
        let sign = |bit: u32| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
        DVec3::new(sign(0), sign(1), sign(2))
    });
    let center = DVec3::new(100.0, -20.0, 3.0);
    let octahedron = gem(signs.map(|s| facet(center + s / 3.0, s)));
    close(
        octahedron.bounds(),
        Aabb::new(center - DVec3::ONE, center + DVec3::ONE),
    );
    // A roof without a floor: open below, and its corner is the highest point.
    let roof = gem([
        DVec3::Y,
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(-1.0, 1.0, 1.0),
        corner,
    ]
    .map(|n| facet(n, n)));
    let bounds = roof.bounds();
    assert!(
        bounds.min.y == f64::NEG_INFINITY && (bounds.max.y - 1.0).abs() < 1e-6,
        "{bounds:?}"
    );
    // Without a corner the bounds are unknown.
    let slab = gem([facet(DVec3::ZERO, corner), facet(-corner, -corner)]);
    assert_eq!(slab.bounds(), Aabb::EVERYTHING);
}
