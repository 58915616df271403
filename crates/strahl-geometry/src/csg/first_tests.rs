//! The search for the first surface against the general method with lists: it gives the same bits and is rarely undecided.

use super::evaluate::Evaluation;
use super::first::{Answer, all_visible, first_visible};
use super::search::Lists;
use super::{Csg, CsgNode};
use crate::conformance::Random;
use crate::{
    Cone, Crossings, Cuboid, Cylinder, Lathe, Plane, PrimHit, Primitive, Quadric, Scratch, Shape,
    Sphere, Spline, SurfaceId, Torus,
};
use std::sync::Arc;
use strahl_math::error::offset_origin;
use strahl_math::{DVec2, DVec3, Interval, Ray, Transform};

/// A leaf somewhere in the cube from -2 to 2.
fn leaf(random: &mut Random, lattice: bool, tag: u32) -> CsgNode {
    if lattice {
        // Faces coincide, and balls touch them.
        let corner = |random: &mut Random| {
            DVec3::from_array(std::array::from_fn(|_| random.below(4) as f64 - 2.0))
        };
        let at = corner(random);
        return match random.below(4) {
            0 => CsgNode::leaf(Sphere::new(at, 1.0), tag),
            1 => CsgNode::leaf(Cylinder::new(at, at + DVec3::Y * 2.0, 0.5), tag),
            _ => CsgNode::leaf(Cuboid::new(at, at + DVec3::ONE), tag),
        };
    }
    let center = random.cube() * 2.0;
    let size = random.between(0.2, 1.0);
    let shape: Shape = match random.below(10) {
        0 => Cuboid::new(center - DVec3::splat(size), center + DVec3::splat(size)).into(),
        1 => Cylinder::new(center, center + random.direction(), 0.5 * size).into(),
        2 => Cone::new(center, size, center + random.direction(), 0.1).into(),
        3 => Plane::new(center, random.direction()).into(),
        4 => Torus::new(center, random.direction(), size, 0.3 * size).into(),
        5 => {
            let halves = [
                CsgNode::leaf(Sphere::new(center, size), 0),
                CsgNode::leaf(Sphere::new(center + random.cube() * 0.5, size), 0),
            ];
            Arc::new(Csg::try_new(CsgNode::merge(halves)).expect("valid")).into()
        }
        6 => quadric(random, center, size),
        7 => {
            let point = |r: f64, y: f64| DVec2::new(r * size, y * size);
            let ring = [point(0.5, 0.0), point(1.0, 0.1), point(0.6, 0.8)];
            let closed = [ring[0], ring[1], ring[2], ring[0]];
            let lathe = Lathe::try_new(Spline::Linear, &closed).expect("valid");
            let place = Transform::translate(center);
            return CsgNode::leaf(lathe, tag).transformed(place);
        }
        _ => Sphere::new(center, size).into(),
    };
    let node = CsgNode::leaf(shape, tag);
    if random.below(4) > 0 {
        return node;
    }
    // With a space of its own.
    let stretch = Transform::try_scale(DVec3::new(1.0, 0.7, 1.2)).expect("regular");
    node.transformed(Transform::rotate(random.direction(), random.unit() * 6.0).then(&stretch))
}

/// An ellipsoid, a hyperboloid of one or two sheets, a cone, a paraboloid or an endless cylinder.
fn quadric(random: &mut Random, center: DVec3, size: f64) -> Shape {
    let mut sign = || [1.0, 1.0, -1.0, 0.0][random.below(4) as usize] * random.between(0.5, 2.0);
    let (a, b) = (sign(), sign());
    let (i, j) = if random.below(4) == 0 {
        (random.between(-1.0, 1.0), 0.0)
    } else {
        (0.0, -size * size * random.below(2) as f64)
    };
    let coefficients = [a, b, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, i, j];
    let quadric = Quadric::new(coefficients);
    let place = Transform::rotate(random.direction(), random.unit() * 6.0)
        .then(&Transform::translate(center));
    let placed = quadric.baked(&place).filter(|q| q.validate().is_ok());
    // Not if it is only a point.
    placed.unwrap_or_else(|| Sphere::new(center, size).into())
}

fn tree(random: &mut Random, depth: u32, lattice: bool) -> CsgNode {
    if depth == 0 || random.below(5) == 0 {
        let tag = random.below(9) as u32;
        return leaf(random, lattice, tag);
    }
    // Sometimes many operands, for which there is a hierarchy.
    let (count, depth) = match random.below(4) {
        0 => (10 + random.below(30), 0),
        _ => (2 + random.below(3), depth - 1),
    };
    let operands: Vec<CsgNode> = (0..count).map(|_| tree(random, depth, lattice)).collect();
    // On the lattice its faces coincide with those of leaves.
    let size = if lattice {
        DVec3::ONE
    } else {
        DVec3::splat(1.6) + random.cube() * 0.3
    };
    let big = CsgNode::leaf(Cuboid::new(-size, size * 1.5), 99);
    match random.below(7) {
        0 => CsgNode::union(operands),
        1 => CsgNode::merge(operands),
        2 if count < 9 => CsgNode::intersection(operands),
        3 => CsgNode::clip(CsgNode::merge(operands), [big]),
        4 => CsgNode::intersection([big, CsgNode::union(operands)]),
        5 => CsgNode::merge(operands).inverted(),
        _ => CsgNode::difference([big].into_iter().chain(operands)),
    }
}

fn deep(random: &mut Random, lattice: bool) -> CsgNode {
    tree(random, 4, lattice)
}

/// A few leaves, some of which are subtracted or only clip the others.
fn flat(random: &mut Random, lattice: bool) -> CsgNode {
    let leaves = |random: &mut Random, most: u64| -> Vec<CsgNode> {
        let count = random.below(most);
        (0..count).map(|_| leaf(random, lattice, 1)).collect()
    };
    let whole = CsgNode::leaf(Cuboid::new(-DVec3::ONE, DVec3::ONE), 0);
    let kept = CsgNode::intersection([whole].into_iter().chain(leaves(random, 3)));
    let rest = leaves(random, 4);
    match random.below(3) {
        0 => CsgNode::clip(
            kept,
            leaves(random, 2)
                .into_iter()
                .chain([leaf(random, lattice, 2)]),
        ),
        _ => CsgNode::difference([kept].into_iter().chain(rest)),
    }
}

/// Two groups of a few leaves, one in the other or beside it.
fn nested(random: &mut Random, lattice: bool) -> CsgNode {
    let mut group = |most: u64| {
        let count = 1 + random.below(most);
        let leaves: Vec<CsgNode> = (0..count).map(|_| leaf(random, lattice, 1)).collect();
        match random.below(5) {
            0 => CsgNode::merge(leaves).inverted(),
            1 => CsgNode::merge(leaves),
            2 => CsgNode::difference(leaves),
            _ => CsgNode::union(leaves),
        }
    };
    let (a, b) = (group(4), group(3));
    let c = leaf(random, lattice, 2);
    match random.below(6) {
        0 => CsgNode::clip(CsgNode::union([a, b]), [c]),
        1 => CsgNode::merge([a, CsgNode::intersection([b, c])]),
        2 => CsgNode::union([a, CsgNode::difference([c, b])]),
        3 => CsgNode::difference([CsgNode::union([a, b]), c]),
        4 => CsgNode::difference([CsgNode::merge([a, c]), b]),
        _ => CsgNode::intersection([CsgNode::merge([a, c]), b]),
    }
}

/// The number of decided searches, and their results.
#[derive(Debug, Default)]
struct Tally {
    sure: u32,
    unclear: u32,
    /// Searches that listed all visible surfaces.
    all: u32,
    /// Those with the table of a small tree.
    small: u32,
    small_unclear: u32,
    /// Those of merges.
    merged: u32,
    hits: u32,
}

/// Runs both methods; they must agree to the last bit.
fn compare(
    csg: &Csg,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    tally: &mut Tally,
) -> Option<PrimHit> {
    let (mut scratch, mut list) = (Scratch::default(), Crossings::default());
    Evaluation::run(csg, ray, range, from, &mut scratch, &mut list);
    let expected = list.list.iter().find(|c| c.visible).map(|c| c.hit);
    // A single leaf is no operation.
    let combined = csg.leaves() > 1;
    if combined {
        match first_visible(csg, ray, range, from, &mut Lists::default(), &mut scratch) {
            Answer::Certain(found) => {
                assert_eq!(found, expected, "{ray:?} {range:?} {from:?}\n{csg:?}");
                tally.sure += 1;
            }
            Answer::Unclear => tally.unclear += 1,
        }
    }
    let (lists, mut all) = (&mut Lists::default(), Vec::new());
    if combined && all_visible(csg, ray, range, from, lists, &mut scratch, &mut all).is_ok() {
        let visible = list.list.iter().filter(|c| c.visible).map(|c| c.hit);
        assert_eq!(
            all,
            visible.collect::<Vec<_>>(),
            "{ray:?} {range:?} {from:?}\n{csg:?}"
        );
        tally.all += 1;
    }
    if let Some(small) = csg.small() {
        let (from, leaves) = (from.map(|s| csg.leaf_surface(s)), csg.all_leaves());
        match small.first_visible(leaves, ray, range, from, &mut scratch, |_, _| true) {
            Answer::Certain(found) => {
                assert_eq!(found, expected, "{ray:?} {range:?} {from:?}\n{csg:?}");
                tally.small += 1;
                tally.merged += u32::from(small.is_merge);
            }
            Answer::Unclear => tally.small_unclear += 1,
        }
        let (scratch, mut all) = (&mut scratch, Vec::new());
        let seen = |_: &PrimHit, _: &mut Scratch| true;
        if small
            .all_visible(leaves, ray, range, from, scratch, seen, &mut all)
            .is_ok()
        {
            let visible = list.list.iter().filter(|c| c.visible).map(|c| c.hit);
            assert_eq!(
                all,
                visible.collect::<Vec<_>>(),
                "{ray:?} {range:?} {from:?}\n{csg:?}"
            );
        }
    }
    tally.hits += u32::from(expected.is_some());
    expected
}

/// Rays from outside that continue from surface to surface, as light does.
fn follow_rays(
    seed: u64,
    trees: u32,
    lattice: bool,
    tree: fn(&mut Random, bool) -> CsgNode,
) -> Tally {
    let (mut random, mut tally) = (Random::new(seed), Tally::default());
    for _ in 0..trees {
        let csg = Csg::try_new(tree(&mut random, lattice)).expect("valid");
        for _ in 0..30 {
            let mut origin = random.cube() * 4.0;
            let mut from = None;
            for _ in 0..4 {
                let mut direction = random.cube() - origin * random.unit();
                if lattice && random.below(2) == 0 {
                    direction.x = 0.0;
                }
                let ray = Ray::new(origin, direction);
                let until = Interval::new(0.0, 2.0 * random.unit());
                compare(&csg, &ray, until, from, &mut tally);
                // Through all surfaces, as light through glass.
                let (mut t, mut crossed) = (0.0, 0);
                while let Some(hit) = compare(&csg, &ray, Interval::new(t, 9.0), from, &mut tally)
                    && crossed < 5
                {
                    t = hit.t;
                    crossed += 1;
                }
                let hit = compare(&csg, &ray, Interval::FORWARD, from, &mut tally);
                let Some(hit) = hit else {
                    break;
                };
                let surface = csg.surface_at(&ray, &hit);
                let bare = csg.bare_surface_at(&ray, &hit);
                assert_eq!(
                    (bare.position, bare.n_geom, bare.position_error),
                    (surface.position, surface.n_geom, surface.position_error)
                );
                let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
                origin = offset_origin(
                    surface.position,
                    surface.position_error,
                    surface.n_geom * side,
                );
                from = Some(hit.surface);
            }
        }
    }
    tally
}

#[test]
fn the_first_surface_is_that_of_the_list() {
    let tally = follow_rays(21, 1500, false, deep);
    assert!(tally.hits > 60_000, "{tally:?}");
    // Only rays that touch two surfaces at once may be left to the general method.
    assert!(tally.unclear * 50 < tally.sure, "{tally:?}");
}

#[test]
fn coincident_and_touching_surfaces_are_left_to_the_general_way() {
    let tally = follow_rays(22, 1500, true, deep);
    assert!(tally.hits > 30_000 && tally.unclear > 10_000, "{tally:?}");
    assert!(tally.sure > 10_000, "{tally:?}");
}

#[test]
fn small_trees_have_the_same_first_surface() {
    let tally = follow_rays(25, 3000, false, nested);
    assert!(tally.small > 60_000 && tally.hits > 20_000, "{tally:?}");
    assert!(tally.small_unclear * 50 < tally.small, "{tally:?}");
    let tally = follow_rays(26, 3000, true, nested);
    assert!(
        tally.small > 20_000 && tally.small_unclear > 2_000,
        "{tally:?}"
    );
}

/// Bounds often are a single shape.
#[test]
fn single_leaves_have_the_same_first_surface() {
    let tally = follow_rays(27, 3000, false, |random, lattice| leaf(random, lattice, 0));
    assert!(tally.small > 30_000 && tally.hits > 20_000, "{tally:?}");
    assert!(tally.small_unclear * 50 < tally.small, "{tally:?}");
}

/// A merge of a few leaves that lines cross at most twice; some of them only clip.
fn merged(random: &mut Random, lattice: bool) -> CsgNode {
    let count = 2 + random.below(5);
    let leaves: Vec<CsgNode> = (0..count)
        .map(|tag| {
            let center = random.cube();
            let (size, quadratic) = (random.between(0.3, 1.2), random.below(3) == 0);
            if !lattice && quadratic {
                return CsgNode::leaf(quadric(random, center, size), tag as u32);
            }
            leaf(random, lattice, tag as u32)
        })
        .collect();
    match random.below(4) {
        0 => CsgNode::merge(leaves.into_iter().map(|leaf| CsgNode::merge([leaf]))),
        _ => CsgNode::merge(leaves),
    }
}

#[test]
fn merges_have_the_same_surfaces() {
    let tally = follow_rays(28, 3000, false, merged);
    assert!(tally.merged > 60_000 && tally.hits > 60_000, "{tally:?}");
    assert!(tally.small_unclear * 50 < tally.small, "{tally:?}");
    let tally = follow_rays(29, 3000, true, merged);
    assert!(
        tally.merged > 20_000 && tally.small_unclear > 2_000,
        "{tally:?}"
    );
}

#[test]
fn a_few_convex_shapes_have_the_same_first_surface() {
    let tally = follow_rays(23, 1500, false, flat);
    assert!(tally.small > 60_000 && tally.hits > 20_000, "{tally:?}");
    assert!(tally.small_unclear * 50 < tally.small, "{tally:?}");
    let tally = follow_rays(24, 1500, true, flat);
    assert!(
        tally.small > 20_000 && tally.small_unclear > 2_000,
        "{tally:?}"
    );
}

/// Operands that begin behind the surface found are not tested: the second of two tori costs nothing.
#[test]
fn a_thousand_holes_are_not_all_looked_at() {
    let holes = (0..1000).map(|i| {
        let (x, z) = (f64::from(i % 40) - 19.5, f64::from(i / 40) - 12.0);
        let base = DVec3::new(x, -2.0, z);
        CsgNode::leaf(Cylinder::new(base, base + DVec3::Y * 4.0, 0.4), 1)
    });
    let half = DVec3::new(25.0, 1.0, 15.0);
    let plate = CsgNode::leaf(Cuboid::new(-half, half), 0);
    let csg = Csg::try_new(CsgNode::difference([plate].into_iter().chain(holes))).expect("valid");
    let (mut lists, mut scratch) = (Lists::default(), Scratch::default());
    let mut random = Random::new(3);
    let (mut tally, mut looked_at) = (Tally::default(), 0);
    for _ in 0..500 {
        // Flat over the plate, so that many boxes are on the way.
        let origin = DVec3::new(-40.0, 3.0 + random.unit(), 20.0 * random.unit() - 10.0);
        let target = DVec3::new(
            random.between(-24.0, 24.0),
            1.0,
            random.between(-13.0, 13.0),
        );
        let ray = Ray::new(origin, target - origin);
        compare(&csg, &ray, Interval::FORWARD, None, &mut tally);
        first_visible(
            &csg,
            &ray,
            Interval::FORWARD,
            None,
            &mut lists,
            &mut scratch,
        );
        looked_at += lists.timeline.len();
    }
    assert!(tally.hits == 500 && tally.unclear < 5, "{tally:?}");
    assert!(looked_at < 500 * 12, "{looked_at} crossings");
}
