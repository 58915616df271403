//! Random trees against brute force: the logic of the tree evaluated point by point, POV-Ray's rule surface by surface.

use super::{Csg, CsgNode};
use crate::conformance::Random;
use crate::{
    Cone, Crossings, Cuboid, Cylinder, Plane, Primitive, Quadric, Scratch, Shape, Side, Solid,
    Sphere, Torus,
};
use std::sync::Arc;
use strahl_math::{DVec3, Interval, Ray, Transform};

/// A tree that is evaluated directly.
enum Model {
    Leaf(u32),
    Node(Operation, Vec<Model>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Union,
    Merge,
    Intersection,
    Difference,
    Inverse,
    Clip,
}

impl Operation {
    const ALL: [Self; 6] = [
        Self::Union,
        Self::Merge,
        Self::Intersection,
        Self::Difference,
        Self::Inverse,
        Self::Clip,
    ];

    /// Whether the complement of an operand takes part in the operation, or in its complement.
    fn negates(self, operand: usize, negative: bool) -> bool {
        match self {
            Self::Difference => negative != (operand > 0),
            Self::Inverse => !negative,
            // What clips is never inverted.
            Self::Clip => negative && operand == 0,
            Self::Union | Self::Merge | Self::Intersection => negative,
        }
    }

    /// Whether it takes all operands to contain a point, by De Morgan's laws; otherwise one suffices.
    fn needs_all(self, negative: bool) -> bool {
        match self {
            Self::Clip => true,
            Self::Intersection | Self::Difference => !negative,
            // An inverse is a merge, inverted.
            Self::Inverse => !negative,
            Self::Union | Self::Merge => negative,
        }
    }
}

/// Shapes of a model, by number.
type Placed = (Shape, Transform);

impl Model {
    /// A random tree over new leaves; `leaf` makes one.
    fn random(
        random: &mut Random,
        depth: u32,
        leaves: &mut Vec<Placed>,
        leaf: &dyn Fn(&mut Random) -> Placed,
    ) -> Self {
        if depth == 0 || leaves.len() > 24 || random.below(6) == 0 {
            leaves.push(leaf(random));
            return Self::Leaf(leaves.len() as u32 - 1);
        }
        let operation = Operation::ALL[random.below(6) as usize];
        // Sometimes many leaves, for which there is a hierarchy of boxes.
        let (operands, depth) = match (operation, random.below(10)) {
            (Operation::Inverse, _) => (1, depth - 1),
            (_, 0) => (12, 0),
            _ => (1 + random.below(3), depth - 1),
        };
        let operand = |_| Self::random(random, depth, leaves, leaf);
        Self::Node(operation, (0..operands).map(operand).collect())
    }

    fn describe(&self, leaves: &[Placed]) -> CsgNode {
        match self {
            Self::Leaf(i) => {
                let (shape, map) = &leaves[*i as usize];
                CsgNode::leaf(shape.clone(), *i).transformed(*map)
            }
            Self::Node(operation, operands) => {
                let operands = operands.iter().map(|operand| operand.describe(leaves));
                match operation {
                    Operation::Union => CsgNode::union(operands),
                    Operation::Merge => CsgNode::merge(operands),
                    Operation::Intersection => CsgNode::intersection(operands),
                    Operation::Difference => CsgNode::difference(operands),
                    Operation::Inverse => CsgNode::Inverse(operands.collect()),
                    Operation::Clip => CsgNode::Clip(operands.collect()),
                }
            }
        }
    }

    /// Whether a point is inside of the model, or of its complement: in the language of [`Operation::negates`] and
    /// [`Operation::needs_all`].
    fn contains(&self, negative: bool, inside: &dyn Fn(u32) -> bool) -> bool {
        match self {
            Self::Leaf(i) => inside(*i) != negative,
            Self::Node(operation, operands) => {
                let mut answers = operands
                    .iter()
                    .enumerate()
                    .map(|(i, operand)| operand.contains(operation.negates(i, negative), inside));
                if operation.needs_all(negative) {
                    answers.all(|a| a)
                } else {
                    answers.any(|a| a)
                }
            }
        }
    }

    /// The leaves whose surface is visible at a point of the surface of leaf `crossed` (and of no other).
    ///
    /// POV-Ray's rule: an intersection keeps an operand's surface inside of all siblings, a merge outside of all siblings,
    /// a union keeps it anyway; complements by De Morgan's laws, without unions.
    fn shows(
        &self,
        crossed: u32,
        negative: bool,
        keeps: bool,
        inside: &dyn Fn(u32) -> bool,
    ) -> bool {
        match self {
            Self::Leaf(i) => *i == crossed,
            Self::Node(operation, operands) => {
                let negated = |i: usize| operation.negates(i, negative);
                let shown = operands.iter().enumerate().find(|(i, operand)| {
                    let clips = *operation == Operation::Clip && *i > 0;
                    let keeps = keeps && !negated(*i);
                    !clips && operand.shows(crossed, negated(*i), keeps, inside)
                });
                let Some((shown, _)) = shown else {
                    return false;
                };
                let all = operation.needs_all(negative);
                if *operation == Operation::Union && !negative && keeps {
                    return true;
                }
                let mut siblings = operands.iter().enumerate().filter(|(i, _)| *i != shown);
                siblings.all(|(i, sibling)| sibling.contains(negated(i), inside) == all)
            }
        }
    }
}

fn inside_leaf((shape, map): &Placed, point: DVec3) -> bool {
    shape
        .as_solid()
        .is_some_and(|solid| solid.contains(map.point_to_object(point)))
}

/// Every place where a line crosses a leaf: parameter, leaf.
fn leaf_crossings(leaves: &[Placed], ray: &Ray, scratch: &mut Scratch) -> Vec<(f64, u32)> {
    let mut places = Vec::new();
    for (i, (shape, map)) in leaves.iter().enumerate() {
        let mut list = scratch.take();
        if let Some(solid) = shape.as_solid() {
            solid.crossings(
                &map.ray_to_object(ray),
                Interval::LINE,
                None,
                scratch,
                &mut list,
            );
        }
        places.extend(list.list.iter().map(|c| (c.hit.t, i as u32)));
        scratch.give(list);
    }
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places
}

fn random_map(random: &mut Random) -> Transform {
    let scale = DVec3::new(
        random.magnitude(-0.5, 0.5),
        random.magnitude(-0.5, 0.5),
        random.magnitude(-0.5, 0.5) * if random.below(2) == 0 { 1.0 } else { -1.0 },
    );
    let turn =
        |random: &mut Random| Transform::rotate(random.direction(), random.between(0.0, 6.0));
    let linear = match random.below(4) {
        0 => Transform::IDENTITY,
        1 => turn(random),
        _ => turn(random)
            .then(&Transform::try_scale(scale).expect("regular"))
            .then(&turn(random)),
    };
    linear.then(&Transform::translate(random.cube()))
}

fn random_leaf(random: &mut Random) -> Placed {
    let map = random_map(random);
    let shape = match random.below(8) {
        0 => Cuboid::new(
            random.cube() - DVec3::splat(1.1),
            random.cube() + DVec3::splat(1.1),
        )
        .into(),
        1 => Plane::new(random.cube(), random.direction()).into(),
        2 => {
            // A leaf with several spans.
            let shell = CsgNode::difference([
                CsgNode::leaf(Sphere::new(DVec3::ZERO, 1.2), 0),
                CsgNode::leaf(Sphere::new(random.cube() * 0.2, 0.9), 1),
            ]);
            Arc::new(Csg::try_new(shell).expect("valid")).into()
        }
        3 => Cylinder::new(random.cube(), random.cube(), random.between(0.2, 1.0)).into(),
        4 => {
            let (base, apex) = (random.between(0.2, 1.0), random.between(0.0, 0.5));
            Cone::new(random.cube(), base, random.cube(), apex).into()
        }
        5 => {
            // Indefinite, so that there is a surface: hyperboloids and cones, unbounded inside and out.
            let mut coefficients = std::array::from_fn(|_| random.between(-1.0, 1.0));
            (coefficients[0], coefficients[2]) = (1.0, -1.0);
            Arc::new(Quadric::new(coefficients)).into()
        }
        6 => {
            let (major, minor) = (random.between(0.4, 1.0), random.between(0.1, 0.35));
            Torus::new(random.cube(), random.direction(), major, minor).into()
        }
        _ => Sphere::new(random.cube(), random.between(0.3, 1.5)).into(),
    };
    (shape, map)
}

/// The counts of a fuzzing run.
#[derive(Debug, Default)]
struct Tally {
    rays: u64,
    spans: u64,
    inner: u64,
    skipped: u64,
    starts: u64,
}

fn random_ray(random: &mut Random) -> Ray {
    let target = random.cube() * 1.5;
    let direction = random.direction();
    let distance = random.between(0.0, 5.0);
    Ray::new(
        target - direction * distance,
        direction * random.magnitude(-1.0, 1.0),
    )
}

/// Compares trees with brute force along rays.
fn fuzz(seed: u64, trees: u32, rays: u32) -> Tally {
    let (mut random, mut scratch, mut tally) =
        (Random::new(seed), Scratch::default(), Tally::default());
    for _ in 0..trees {
        let mut leaves = Vec::new();
        let model = Model::random(&mut random, 8, &mut leaves, &random_leaf);
        let csg = Csg::try_new(model.describe(&leaves)).expect("valid");
        for _ in 0..rays {
            let ray = random_ray(&mut random);
            tally.rays += 1;
            check_ray(&model, &leaves, &csg, &ray, &mut tally, &mut scratch);
            check_start(&csg, &ray, &mut random, &mut tally, &mut scratch);
        }
    }
    tally
}

fn check_ray(
    model: &Model,
    leaves: &[Placed],
    csg: &Csg,
    ray: &Ray,
    tally: &mut Tally,
    scratch: &mut Scratch,
) {
    let mut found = Crossings::default();
    csg.crossings(ray, Interval::LINE, None, scratch, &mut found);
    let places = leaf_crossings(leaves, ray, scratch);
    let mut ends: Vec<f64> = places.iter().map(|(t, _)| *t).collect();
    ends.insert(0, ends.first().map_or(0.0, |t| t - 10.0));
    ends.push(ends.last().map_or(0.0, |t| t + 10.0));

    // Between any two crossings of leaves the state is that of the tree's logic.
    let speed = ray.direction.length();
    let mut sure = true;
    for pair in ends.windows(2) {
        if (pair[1] - pair[0]) * speed < 1e-6 {
            tally.skipped += 1;
            sure = false;
            continue;
        }
        let t = 0.5 * (pair[0] + pair[1]);
        let point = ray.at(t);
        let inside = |i: u32| inside_leaf(&leaves[i as usize], point);
        let expected = model.contains(false, &inside);
        assert_eq!(
            found.inside_after(t),
            expected,
            "at {t} of {ray:?}: {found:?}"
        );
        assert_eq!(csg.contains(point), expected, "{point}");
        tally.spans += 1;
    }

    // Crossings ascend and alternate; the visible ones are those that POV-Ray's rule keeps.
    let mut inside = found.inside_at_start;
    for crossing in &found.list {
        match crossing.side {
            Side::Enter => assert!(!std::mem::replace(&mut inside, true), "{found:?}"),
            Side::Exit => assert!(std::mem::replace(&mut inside, false), "{found:?}"),
            Side::Inner => tally.inner += 1,
        }
        let normal = csg.surface_at(ray, &crossing.hit).n_geom;
        let approach = normal.dot(ray.direction) / speed;
        if approach.abs() > 1e-6 && crossing.side != Side::Inner {
            assert_eq!(
                approach < 0.0,
                crossing.side == Side::Enter,
                "{ray:?} {crossing:?}"
            );
        }
    }
    assert!(
        found
            .list
            .windows(2)
            .all(|pair| pair[0].hit.t <= pair[1].hit.t),
        "{found:?}"
    );
    if sure {
        let expected: Vec<u32> = places
            .iter()
            .filter(|(t, leaf)| {
                // The leaf itself counts as crossed; the others are tested at the point.
                let point = ray.at(*t);
                model.shows(*leaf, false, true, &|i| {
                    inside_leaf(&leaves[i as usize], point)
                })
            })
            .map(|(_, leaf)| *leaf)
            .collect();
        let visible = found.list.iter().filter(|c| c.visible);
        let tags: Vec<u32> = visible
            .map(|c| csg.leaf_tag(csg.leaf_of(c.surface().element).0))
            .collect();
        assert_eq!(tags, expected, "{ray:?}\n{found:?}");
    }
}

/// A part of the line gives a part of the list; a ray from a surface knows its side.
fn check_start(
    csg: &Csg,
    ray: &Ray,
    random: &mut Random,
    tally: &mut Tally,
    scratch: &mut Scratch,
) {
    let mut line = Crossings::default();
    csg.crossings(ray, Interval::LINE, None, scratch, &mut line);
    let a = random.between(-5.0, 5.0);
    let range = Interval::new(a, a + random.between(0.0, 5.0));
    let mut part = Crossings::default();
    csg.crossings(ray, range, None, scratch, &mut part);
    assert_eq!(
        part.inside_at_start,
        line.inside_after(range.min),
        "{ray:?} {range:?}"
    );
    line.list.retain(|c| range.accepts(c.hit.t));
    assert_eq!(part.list, line.list, "{ray:?} {range:?}");
    let first = line.list.iter().find(|c| c.visible).map(|c| c.hit);
    assert_eq!(csg.closest_hit(ray, range, None, scratch), first);

    let Some(crossing) = part
        .list
        .iter()
        .find(|c| c.visible && c.side != Side::Inner)
    else {
        return;
    };
    let surface = csg.surface_at(ray, &crossing.hit);
    let direction = random.direction();
    let cosine = direction.dot(surface.n_geom);
    if cosine.abs() < 1e-3 {
        return;
    }
    let side = surface.n_geom * cosine.signum();
    let origin = strahl_math::error::offset_origin(surface.position, surface.position_error, side);
    let leaving = Ray::new(origin, direction);
    let mut out = Crossings::default();
    csg.crossings(
        &leaving,
        Interval::FORWARD,
        Some(crossing.surface()),
        scratch,
        &mut out,
    );
    if out.list.first().is_none_or(|c| c.hit.t > 1e-6) {
        assert_eq!(
            out.inside_at_start,
            cosine < 0.0,
            "{leaving:?} from {crossing:?}: {out:?}"
        );
        tally.starts += 1;
    }
}

/// Trees of boxes on a small lattice, where nearly all faces coincide, seen through a map that makes them coincide only up to
/// rounding.
fn fuzz_lattice(seed: u64, trees: u32, rays: u32) -> Tally {
    let (mut random, mut scratch, mut tally) =
        (Random::new(seed), Scratch::default(), Tally::default());
    for tree in 0..trees {
        let mut leaves = Vec::new();
        let model = Model::random(&mut random, 5, &mut leaves, &lattice_box);
        let everything = match tree % 3 {
            0 => Transform::IDENTITY,
            1 => Transform::rotate(random.direction(), random.between(0.0, 6.0))
                .then(&Transform::translate(random.cube() * 10.0)),
            _ => random_map(&mut random),
        };
        let csg = Csg::try_new(model.describe(&leaves).transformed(everything)).expect("valid");
        for _ in 0..rays {
            let ray = random_ray(&mut random);
            let ray = Ray::new(ray.origin + random.cube(), ray.direction);
            check_lattice(
                &model,
                &leaves,
                &csg,
                &everything,
                &ray,
                &mut tally,
                &mut scratch,
            );
        }
    }
    tally
}

/// A box with corners on the lattice, made from another one by a map that is not exact.
fn lattice_box(random: &mut Random) -> Placed {
    let corner = |random: &mut Random| {
        DVec3::new(
            random.below(4) as f64 - 2.0,
            random.below(4) as f64 - 2.0,
            random.below(4) as f64 - 2.0,
        )
    };
    let min = corner(random);
    let size = DVec3::new(
        1.0 + random.below(2) as f64,
        1.0 + random.below(2) as f64,
        1.0 + random.below(2) as f64,
    );
    if random.below(3) == 0 {
        return (Cuboid::new(min, min + size).into(), Transform::IDENTITY);
    }
    // Exact up to rounding: thirds and sevenths, turned by quarters.
    let part = DVec3::new(1.0 / 3.0, 1.0 / 7.0, 0.3);
    let quarter = std::f64::consts::FRAC_PI_2;
    let axis = DVec3::AXES[random.below(3) as usize];
    let turn = Transform::rotate(axis, quarter * (1 + random.below(3)) as f64);
    let center = turn.vector_to_object(min + size * 0.5);
    let half = turn.vector_to_object(size * 0.5).abs();
    let map = Transform::try_scale(DVec3::ONE / part)
        .expect("regular")
        .then(&turn);
    let (low, high) = ((center - half).round_half(), (center + half).round_half());
    (Cuboid::new(low * part, high * part).into(), map)
}

/// Rounds to halves: lattice corners turned by a quarter.
trait RoundHalf {
    fn round_half(self) -> Self;
}

impl RoundHalf for DVec3 {
    fn round_half(self) -> Self {
        (self * 2.0).round() * 0.5
    }
}

fn check_lattice(
    model: &Model,
    leaves: &[Placed],
    csg: &Csg,
    everything: &Transform,
    ray: &Ray,
    tally: &mut Tally,
    scratch: &mut Scratch,
) {
    // The points where the ray hits planes of the lattice, not too close to edges.
    let mut planes: Vec<f64> = (0..3)
        .flat_map(|axis| {
            (-2..=4).map(move |k| (f64::from(k) - ray.origin[axis]) / ray.direction[axis])
        })
        .collect();
    planes.sort_by(f64::total_cmp);
    if planes
        .windows(2)
        .any(|pair| (pair[1] - pair[0]) * ray.direction.length() < 1e-6)
    {
        tally.skipped += 1;
        return;
    }
    tally.rays += 1;
    let state = |t: f64| {
        let point = ray.at(t);
        model.contains(false, &|i| inside_leaf(&leaves[i as usize], point))
    };
    let mut expected = Vec::new();
    let mut before = state(planes[0] - 1.0);
    for (i, t) in planes.iter().enumerate() {
        let next = planes.get(i + 1).map_or(t + 1.0, |next| 0.5 * (t + next));
        let after = state(next);
        if after != before {
            expected.push((*t, if after { Side::Enter } else { Side::Exit }));
        }
        before = after;
    }
    let outer = Ray::new(
        everything.point_to_world(ray.origin),
        everything.vector_to_world(ray.direction),
    );
    let mut found = Crossings::default();
    csg.crossings(&outer, Interval::LINE, None, scratch, &mut found);
    tally.inner += found.list.iter().filter(|c| c.side == Side::Inner).count() as u64;
    let changes: Vec<_> = found
        .list
        .iter()
        .filter(|c| c.side != Side::Inner)
        .collect();
    let same = changes.len() == expected.len()
        && changes
            .iter()
            .zip(&expected)
            .all(|(c, (t, side))| c.side == *side && (c.hit.t - t).abs() < 1e-9 * (1.0 + t.abs()));
    assert!(same, "{outer:?}: {found:?}\nexpected {expected:?}");
    tally.spans += changes.len() as u64;
}

#[test]
fn random_trees_agree_with_point_by_point_logic() {
    let tally = fuzz(1, 2000, 50);
    assert!(tally.rays == 100_000 && tally.spans > 500_000, "{tally:?}");
    assert!(tally.inner > 10_000 && tally.starts > 5_000, "{tally:?}");
    assert!(tally.skipped * 1000 < tally.spans, "{tally:?}");
}

#[test]
fn coincident_faces_leave_nothing_in_random_trees() {
    let tally = fuzz_lattice(2, 2000, 50);
    assert!(tally.rays > 95_000 && tally.spans > 20_000, "{tally:?}");
}

/// One more seed; the variable asks for more:
/// `STRAHL_FUZZ_SEEDS=100 cargo test --release -p strahl-geometry more_random_trees`.
#[test]
fn more_random_trees() {
    let seeds = std::env::var("STRAHL_FUZZ_SEEDS").map_or(1, |n| n.parse().expect("a number"));
    for seed in 10..10 + seeds {
        let (random, lattice) = (fuzz(seed, 500, 100), fuzz_lattice(seed, 500, 100));
        assert!(
            random.rays == 50_000 && lattice.rays > 45_000,
            "{random:?} {lattice:?}"
        );
    }
}
