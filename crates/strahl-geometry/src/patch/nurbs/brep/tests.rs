use super::super::tests::{QUARTERS, circle, hits, nurbs, revolved, ring, sphere};
use super::super::{NurbsCurve, NurbsData, TrimLoop};
use super::*;
use crate::conformance::Random;
use crate::patch::tests::in_parts;
use crate::{Crossings, Csg, CsgNode, Cuboid, Cylinder, Shape, Side, Sphere};
use std::f64::consts::{FRAC_PI_2, TAU};
use strahl_math::{DVec3, Transform};

/// A parallelogram; its parameters run from 0 to 1 along both sides.
fn flat(corner: DVec3, along: DVec3, up: DVec3) -> NurbsData {
    NurbsData::new(
        [1, 1],
        2,
        vec![corner, corner + along, corner + up, corner + along + up],
    )
}

/// A square of side `2 reach` around a center, in the plane of x and z, with a round border or a hole.
fn round(center: DVec3, reach: f64, radius: f64, is_hole: bool) -> Arc<Nurbs> {
    let corner = center - DVec3::new(reach, 0.0, reach);
    let data = flat(corner, DVec3::X * (2.0 * reach), DVec3::Z * (2.0 * reach));
    let circle = ring(DVec2::splat(0.5), radius / (2.0 * reach), is_hole);
    Arc::new(Nurbs::try_trimmed(&data, &[circle]).unwrap())
}

/// The side of a cylinder about the y axis.
fn tube(radius: f64, from: f64, to: f64) -> Arc<Nurbs> {
    let profile = [from, 0.5 * (from + to), to].map(|y| [radius, y, 1.0]);
    Arc::new(nurbs(&revolved(&profile, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0])))
}

fn whole(data: &NurbsData) -> Arc<Nurbs> {
    Arc::new(nurbs(data))
}

/// A cylinder of radius 1 from y = -1 to 1 whose discs are larger by `gap`, or smaller.
fn can(gap: f64) -> Vec<Arc<Nurbs>> {
    let disc = |y: f64| round(DVec3::Y * y, 1.2, 1.0 + gap, false);
    vec![tube(1.0, -1.0, 1.0), disc(-1.0), disc(1.0)]
}

/// A can whose discs are polygons of so many corners: the gaps of files with straight lines for curves.
fn angular(corners: u32) -> Vec<Arc<Nurbs>> {
    let disc = |y: f64, turn: f64| {
        let corner = |k: u32| {
            let angle = TAU * (f64::from(k) + turn) / f64::from(corners);
            DVec2::splat(0.5) + DVec2::from_angle(angle) / 2.4
        };
        let data = flat(DVec3::new(-1.2, y, -1.2), DVec3::X * 2.4, DVec3::Z * 2.4);
        let polygon = TrimLoop::polygon((0..corners).map(corner).collect(), false);
        Arc::new(Nurbs::try_trimmed(&data, &[polygon]).unwrap())
    };
    vec![disc(1.0, 0.0), tube(1.0, -1.0, 1.0), disc(-1.0, 0.3)]
}

const HALF: DVec3 = DVec3::new(1.0, 0.6, 0.8);

/// The six faces of a box, each turned another way, without those across y.
fn walls() -> Vec<Arc<Nurbs>> {
    let DVec3 { x, y, z } = HALF * 2.0;
    let (low, high) = (-HALF, HALF);
    vec![
        whole(&flat(low, DVec3::X * x, DVec3::Y * y)),
        whole(&flat(high, DVec3::X * -x, DVec3::Y * -y)),
        whole(&flat(low, DVec3::Y * y, DVec3::Z * z)),
        whole(&flat(high, DVec3::Z * -z, DVec3::Y * -y)),
    ]
}

/// A face of the box across y, with a round hole.
fn lid(y: f64, radius: f64) -> Arc<Nurbs> {
    let corner = DVec3::new(-HALF.x, y, -HALF.z);
    let data = flat(corner, DVec3::X, DVec3::Z);
    let data = NurbsData {
        points: data
            .points
            .iter()
            .map(|p| corner + (*p - corner) * 2.0 * HALF)
            .collect(),
        // One unit of the parameters is one unit in space.
        knots: [HALF.x, HALF.z].map(|h| vec![-h, -h, h, h]),
        ..data
    };
    let hole = ring(DVec2::ZERO, radius, true);
    Arc::new(Nurbs::try_trimmed(&data, &[hole]).unwrap())
}

/// A box with a round bore along y; the holes of the box are larger than the bore by `gap`.
fn bored(gap: f64) -> Vec<Arc<Nurbs>> {
    let mut faces = walls();
    faces.extend([lid(-HALF.y, 0.4 + gap), lid(HALF.y, 0.4 + gap)]);
    faces.push(tube(0.4, -HALF.y, HALF.y));
    faces
}

fn exact_can() -> Shape {
    Cylinder::new(-DVec3::Y, DVec3::Y, 1.0).into()
}

fn exact_bored() -> Shape {
    let block = CsgNode::leaf(Cuboid::new(-HALF, HALF), 0);
    let bore = CsgNode::leaf(Cylinder::new(-DVec3::Y, DVec3::Y, 0.4), 1);
    Csg::try_new(CsgNode::difference([block, bore]))
        .unwrap()
        .into()
}

/// A box with rounded edges and corners: planes, quarters of cylinders and eighths of balls.
fn rounded() -> Vec<Arc<Nurbs>> {
    let inner = HALF - DVec3::splat(ROUND);
    let quarter = [0, 1, 2].map(|k| circle()[k]);
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let mut faces = vec![];
    for axis in 0..3 {
        let [a, b, c] = [axis, (axis + 1) % 3, (axis + 2) % 3].map(|k| DVec3::AXES[k]);
        let [ha, hb, hc] = [a, b, c].map(|d| inner.dot(d));
        for s in [-1.0, 1.0] {
            let corner = a * (s * (ha + ROUND)) - b * hb - c * hc;
            faces.push(whole(&flat(corner, b * (2.0 * hb), c * (2.0 * hc))));
            for t in [-1.0, 1.0] {
                let (mut points, mut weights) = (vec![], vec![]);
                for end in [-hc, hc] {
                    for [x, y, w] in quarter {
                        let round = a * (s * x) + b * (t * y);
                        points.push(a * (s * ha) + b * (t * hb) + c * end + round * ROUND);
                        weights.push(w);
                    }
                }
                faces.push(whole(&NurbsData {
                    degree: [2, 1],
                    knots: [knots.clone(), vec![0.0, 0.0, 1.0, 1.0]],
                    points,
                    weights,
                }));
            }
        }
    }
    for corner in 0..8 {
        let sign =
            DVec3::from_array([0, 1, 2].map(|k| if corner >> k & 1 == 0 { -1.0 } else { 1.0 }));
        let (mut points, mut weights) = (vec![], vec![]);
        for [r, y, v] in quarter {
            for [x, z, w] in quarter {
                let at = DVec3::new(r * x, y, r * z);
                points.push(sign * (inner + at * ROUND));
                weights.push(v * w);
            }
        }
        faces.push(whole(&NurbsData {
            degree: [2, 2],
            knots: [knots.clone(), knots.clone()],
            points,
            weights,
        }));
    }
    faces
}

const ROUND: f64 = 0.15;

/// How far a point is from the rounded box; negative inside.
fn off_rounded(p: DVec3) -> f64 {
    let q = p.abs() - (HALF - DVec3::splat(ROUND));
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - ROUND
}

fn brep(faces: &[Arc<Nurbs>]) -> NurbsBrep {
    NurbsBrep::try_new(faces).unwrap()
}

crate::primitive_tests!(cylinder, || brep(&can(0.0)));
crate::primitive_tests!(loose_cylinder, || brep(&can(1e-6)));
crate::primitive_tests!(bored_block, || brep(&bored(0.0)));
crate::primitive_tests!(rounded_block, || brep(&rounded()));
crate::primitive_tests!(two_balls, || {
    let small = NurbsData {
        points: sphere().points.iter().map(|p| *p * 0.5).collect(),
        ..sphere()
    };
    brep(&[whole(&sphere()), whole(&small)])
});

fn crossings(solid: &dyn Solid, ray: &Ray) -> Crossings {
    let mut list = Crossings::default();
    solid.crossings(
        ray,
        Interval::LINE,
        None,
        &mut Scratch::default(),
        &mut list,
    );
    list
}

/// The parts of a line within a solid.
fn spans(solid: &dyn Solid, ray: &Ray) -> Vec<[f64; 2]> {
    let mut list = crossings(solid, ray);
    // Within trees there are also surfaces that the line passes inside.
    list.list.retain(|crossing| crossing.side != Side::Inner);
    assert!(
        !list.inside_at_start && list.list.len().is_multiple_of(2),
        "{ray:?} {list:?}"
    );
    let mut all = vec![];
    for pair in list.list.chunks(2) {
        let [Side::Enter, Side::Exit] = [pair[0].side, pair[1].side] else {
            panic!("{ray:?} {list:?}");
        };
        all.push([pair[0].hit.t, pair[1].hit.t]);
    }
    all
}

/// How long a line is in one solid and not in the other.
fn difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let mut ends: Vec<(f64, usize)> = vec![];
    for (which, list) in [a, b].into_iter().enumerate() {
        ends.extend(list.as_flattened().iter().map(|t| (*t, which)));
    }
    ends.sort_by(|p, q| p.0.total_cmp(&q.0));
    let (mut inside, mut last, mut sum) = ([false; 2], f64::NEG_INFINITY, 0.0);
    for (t, which) in ends {
        if inside[0] != inside[1] {
            sum += t - last;
        }
        inside[which] = !inside[which];
        last = t;
    }
    sum
}

#[test]
fn solids_are_those_that_the_faces_close() {
    type Case = (Vec<Arc<Nurbs>>, Shape);
    let cases: [Case; 4] = [
        (can(0.0), exact_can()),
        (can(1e-7), exact_can()),
        (bored(0.0), exact_bored()),
        (bored(-1e-7), exact_bored()),
    ];
    let mut random = Random::new(3);
    for (number, (faces, exact)) in cases.iter().enumerate() {
        let ours = brep(faces);
        let theirs = exact.as_solid().unwrap();
        let mut length = 0.0;
        for _ in 0..5000 {
            let ray = Ray::new(random.cube() * 3.0, random.direction());
            let (a, b) = (spans(&ours, &ray), spans(theirs, &ray));
            let off = difference(&a, &b);
            assert!(off < 2e-3, "case {number}: {off} {ray:?} {a:?} {b:?}");
            length += b.iter().map(|[from, to]| to - from).sum::<f64>();
            for hit in hits(&ours, &ray) {
                let at = ours.surface_at(&ray, &hit);
                let enters = a.iter().any(|[from, _]| *from == hit.t);
                assert!(at.n_geom.dot(ray.direction) < 1e-6 || !enters);
            }
            let p = random.cube() * 1.2;
            let near = [1e-6, -1e-6].iter().any(|d| {
                DVec3::AXES
                    .iter()
                    .any(|axis| theirs.contains(p + *axis * *d) != theirs.contains(p))
            });
            assert!(near || ours.contains(p) == theirs.contains(p), "{p}");
        }
        assert!(length > 400.0, "{length}");
    }
}

#[test]
fn a_rounded_block_has_its_inside() {
    let ours = brep(&rounded());
    assert_eq!(ours.face_count(), 26);
    let mut random = Random::new(13);
    for _ in 0..10_000 {
        let p = random.cube() * 1.1;
        let off = off_rounded(p);
        assert!(
            off.abs() < 1e-9 || ours.contains(p) == (off < 0.0),
            "{p} {off}"
        );
        let ray = Ray::new(random.cube() * 2.0, random.direction());
        for [from, to] in spans(&ours, &ray) {
            for t in [from, to] {
                assert!(off_rounded(ray.at(t)).abs() < 1e-7, "{ray:?} {t}");
            }
        }
    }
}

/// A point of an edge of the can or of the bored block.
fn on_edge(random: &mut Random, is_can: bool) -> DVec3 {
    let sign = |random: &mut Random| if random.below(2) == 0 { -1.0 } else { 1.0 };
    // Also exactly on the seam and between patches.
    let angle = match random.below(4) {
        0 => FRAC_PI_2 * random.below(4) as f64,
        _ => TAU * random.unit(),
    };
    let on_circle = |r: f64, y: f64| DVec3::new(r * angle.cos(), y, r * angle.sin());
    if is_can {
        return match random.below(8) {
            // The seam.
            0 => DVec3::new(1.0, random.between(-1.0, 1.0), 0.0),
            _ => on_circle(1.0, sign(random)),
        };
    }
    match random.below(4) {
        0 | 1 => on_circle(0.4, HALF.y * sign(random)),
        2 => HALF * DVec3::new(sign(random), sign(random), sign(random)),
        _ => {
            let mut corner = HALF * DVec3::new(sign(random), sign(random), sign(random));
            corner[random.below(3) as usize] *= random.unit();
            corner
        }
    }
}

/// Lines at edges, at distances down to nothing: how many are inside of the solid for another length than they should be. `spans` panics if
/// one of them does not leave the solid as often as it enters.
fn shoot(rays: usize, seed: u64) -> [usize; 2] {
    let mut random = Random::new(seed);
    let gaps = [0.0, 1e-9, -1e-7, 2e-6, -1e-5];
    let gap = gaps[seed as usize % gaps.len()];
    let can = if seed.is_multiple_of(6) {
        angular(300)
    } else {
        can(gap)
    };
    let solids = [
        (brep(&can), exact_can()),
        (brep(&bored(gap)), exact_bored()),
    ];
    let smooth = brep(&rounded());
    let mut wrong = [0; 2];
    for round in 0..rays {
        let (ours, exact) = &solids[round % 2];
        let aside = match random.below(3) {
            0 => DVec3::ZERO,
            1 => random.cube() * ours.tolerance(),
            _ => random.cube() * random.magnitude(-16.0, -4.0),
        };
        let target = on_edge(&mut random, round % 2 == 0) + aside;
        let direction = random.direction();
        let ray = Ray::new(target - direction * random.between(0.0, 3.0), direction);
        let (a, b) = (spans(ours, &ray), spans(exact.as_solid().unwrap(), &ray));
        let off = difference(&a, &b);
        // A line at a low angle is longer in the solid by the root of what this is wider.
        let allowed = 1e-5 + 8.0 * (2.0 * ours.tolerance()).sqrt();
        if off > allowed {
            // A line along a flat face is in the solid or not, all of it. It is right if it is that of a line so near to it.
            let near = ours.reach();
            let is_near = (0..200).any(|_| {
                let moved = Ray::new(
                    ray.origin + random.cube() * near,
                    ray.direction + random.cube() * near,
                );
                difference(&a, &spans(exact.as_solid().unwrap(), &moved)) <= allowed
            });
            wrong[0] += usize::from(!is_near);
        }
        wrong[1] += usize::from(shoot_smooth(&smooth, &mut random, aside));
    }
    wrong
}

/// A line at an edge of the rounded block, where a plane goes over into a round without a kink: whether it is inside where it should be.
fn shoot_smooth(solid: &NurbsBrep, random: &mut Random, aside: DVec3) -> bool {
    let inner = HALF - DVec3::splat(ROUND);
    let mut target = random.cube() * inner;
    // Out of the plane, at an edge of the face.
    let out = random.below(3) as usize;
    let other = (out + 1 + random.below(2) as usize) % 3;
    target[out] = HALF[out];
    target[other] = inner[other];
    if random.below(4) == 0 {
        target[3 - out - other] = inner[3 - out - other];
    }
    let flip = DVec3::from_array(std::array::from_fn(|_| {
        [1.0, -1.0][random.below(2) as usize]
    }));
    let mut direction = random.direction();
    if random.below(4) == 0 {
        // Along the plane, nearly.
        direction[out] *= random.magnitude(-9.0, -1.0);
    }
    let ray = Ray::new(target * flip + aside - direction, direction);
    let spans = spans(solid, &ray);
    (0..60).any(|k| {
        let t = f64::from(k) / 20.0 - 1.0;
        let off = off_rounded(ray.at(t));
        off.abs() > 1e-6 && spans.iter().any(|[from, to]| *from < t && t < *to) != (off < 0.0)
    })
}

#[test]
fn lines_at_edges_leave_as_often_as_they_enter() {
    assert_eq!(in_parts(100_000, 1, shoot), [0; 2]);
}

/// The long version, for releases: on all processors.
#[test]
#[ignore = "takes minutes; run it with --ignored"]
fn ten_million_lines_at_edges_leave_as_often_as_they_enter() {
    assert_eq!(in_parts(10_000_000, 2, shoot), [0; 2]);
}

#[test]
fn a_shell_that_is_not_closed_says_where() {
    let message = |faces: &[Arc<Nurbs>]| NurbsBrep::try_new(faces).unwrap_err().to_string();
    assert_eq!(message(&[]), "the brep is degenerate: it has no faces");
    let all = bored(0.0);
    for missing in 0..all.len() {
        let mut faces = all.clone();
        faces.remove(missing);
        let text = message(&faces);
        assert!(text.contains("no other face has that border"), "{text}");
    }
    let text = message(&all[..1]);
    assert!(
        text.contains("face 0 (counted from 0) has a border at <"),
        "{text}"
    );
    for twice in 0..all.len() {
        let mut faces = all.clone();
        faces.push(faces[twice].clone());
        let text = message(&faces);
        assert!(text.contains("but 3 faces have it"), "{text}");
    }
    // A gap that is wide enough to be seen.
    let text = message(&can(1e-3));
    assert!(text.contains("brep is not closed"), "{text}");
    let ball = whole(&sphere());
    let text = message(&[ball.clone(), ball]);
    assert!(text.contains("but 3 faces have it"), "{text}");
    // Two sheets with nothing between them, and two boxes that cross.
    let sheet = round(DVec3::ZERO, 1.2, 1.0, false);
    let text = message(&[sheet.clone(), sheet]);
    assert!(text.contains("inside on both sides"), "{text}");
    let cube = |from: DVec3| {
        (0..6).map(move |k| {
            let [a, b, c] = [0, 1, 2].map(|i| DVec3::AXES[(k + i) % 3]);
            whole(&flat(from + a * (k / 3) as f64, b, c))
        })
    };
    let both = cube(DVec3::ZERO)
        .chain(cube(DVec3::new(0.5, 0.4, 0.6)))
        .collect::<Vec<_>>();
    let text = message(&both);
    assert!(text.contains("faces cross or lie on each other"), "{text}");
    // Beside each other they are one solid.
    let both = cube(DVec3::ZERO)
        .chain(cube(DVec3::X * 2.0))
        .collect::<Vec<_>>();
    let two = brep(&both);
    assert!(
        [0.5, 2.5]
            .iter()
            .all(|x| two.contains(DVec3::new(*x, 0.5, 0.5)))
    );
    assert!(!two.contains(DVec3::new(1.5, 0.5, 0.5)));
    let open = Nurbs::try_trimmed(&sphere(), &[ring(DVec2::new(2.0, 1.0), 0.3, true)]).unwrap();
    let text = message(&[Arc::new(open)]);
    assert!(text.contains("no other face has that border"), "{text}");
}

#[test]
fn faces_may_be_turned_either_way() {
    let flipped = |face: &Nurbs| {
        // Twice mirrored: at its place, with normals to the other side.
        let mirror = Transform::try_scale(DVec3::new(1.0, -1.0, 1.0)).unwrap();
        let Some(Shape::Nurbs(mirrored)) = face.baked(&mirror) else {
            panic!("not baked");
        };
        mirrored
    };
    let plain = bored(0.0);
    let mirrored: Vec<_> = plain.iter().map(|face| flipped(face)).collect();
    let mut random = Random::new(8);
    let (a, b) = (brep(&plain), brep(&mirrored));
    for (number, turn) in a.turns.iter().enumerate() {
        assert_eq!(*turn, -b.turns[number]);
    }
    for _ in 0..2000 {
        let ray = Ray::new(random.cube() * 2.0, random.direction());
        for hit in hits(&a, &ray) {
            let at = a.surface_at(&ray, &hit);
            assert!(!a.contains(at.position + at.n_geom * 1e-6));
            assert!(a.contains(at.position - at.n_geom * 1e-6));
        }
        let mirrored = Ray::new(
            ray.origin * DVec3::new(1.0, -1.0, 1.0),
            ray.direction * DVec3::new(1.0, -1.0, 1.0),
        );
        assert!(difference(&spans(&a, &ray), &spans(&b, &mirrored)) < 1e-6);
    }
}

/// Planes may be much larger than what is left of them, and shells far from the origin.
#[test]
fn large_planes_and_far_places_change_nothing() {
    let place = DVec3::new(3e5, -2e5, 1e5);
    let disc = |y: f64| round(DVec3::Y * y, 500.0, 1.0, false);
    let near = vec![tube(1.0, -1.0, 1.0), disc(-1.0), disc(1.0)];
    let moved = |face: &Arc<Nurbs>| match face.baked(&Transform::translate(place)) {
        Some(Shape::Nurbs(face)) => face,
        _ => panic!("not baked"),
    };
    let far: Vec<_> = can(0.0).iter().map(moved).collect();
    let (near, far) = (brep(&near), brep(&far));
    assert!(
        near.tolerance() < 1e-8 && far.tolerance() < 1e-7,
        "{near:?}"
    );
    let exact = exact_can();
    let mut random = Random::new(5);
    for _ in 0..3000 {
        let ray = Ray::new(random.cube() * 2.0, random.direction());
        let expected = spans(exact.as_solid().unwrap(), &ray);
        let apart = Ray::new(ray.origin + place, ray.direction);
        for found in [spans(&near, &ray), spans(&far, &apart)] {
            assert!(
                difference(&found, &expected) < 1e-3,
                "{ray:?} {found:?} {expected:?}"
            );
        }
    }
}

/// A loop along the sides of a surface and one beyond them leave all of it.
#[test]
fn loops_along_the_sides_and_beyond_them_are_borders_once() {
    let corners = |from: f64, to: f64| {
        let all = [(from, from), (to, from), (to, to), (from, to)];
        TrimLoop::polygon(all.map(DVec2::from).to_vec(), false)
    };
    for [from, to] in [[0.0, 1.0], [-0.5, 1.5], [0.0, 1.0 + 1e-8]] {
        let mut faces = vec![];
        for axis in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|k| DVec3::AXES[(axis + k) % 3]);
            for s in [0.0, 1.0] {
                let data = flat(a * s, b, c);
                faces.push(Arc::new(
                    Nurbs::try_trimmed(&data, &[corners(from, to)]).unwrap(),
                ));
            }
        }
        let cube = brep(&faces);
        let exact = Cuboid::new(DVec3::ZERO, DVec3::ONE);
        let mut random = Random::new(5);
        for _ in 0..2000 {
            let ray = Ray::new(random.cube() * 2.0, random.direction());
            assert!(difference(&spans(&cube, &ray), &spans(&exact, &ray)) < 1e-6);
        }
    }
}

#[test]
fn a_ball_is_cut_from_a_block() {
    let tree = |block: Shape| {
        let ball = CsgNode::leaf(Sphere::new(DVec3::new(0.8, 0.5, -0.6), 0.7), 1);
        Csg::try_new(CsgNode::difference([CsgNode::leaf(block, 0), ball])).unwrap()
    };
    let (ours, theirs) = (tree(brep(&bored(0.0)).into()), tree(exact_bored()));
    let (mut random, mut met) = (Random::new(61), 0);
    for _ in 0..5000 {
        let ray = Ray::new(random.cube() * 3.0, random.direction());
        let (a, b) = (hits(&ours, &ray), hits(&theirs, &ray));
        let is_wide = b.windows(2).all(|pair| pair[1].t - pair[0].t > 1e-3);
        if is_wide {
            assert_eq!(a.len(), b.len(), "{ray:?} {a:?} {b:?}");
            for (a, b) in a.iter().zip(&b) {
                assert!((a.t - b.t).abs() < 1e-6, "{ray:?} {a:?} {b:?}");
            }
            met += a.len();
        }
    }
    assert!(met > 1000, "{met}");
}

#[test]
fn curves_of_another_degree_are_the_same_border() {
    // The can's lids, bounded by two half circles in the opposite direction.
    let half = |at: f64| {
        let [a, b] = [at, at + 2.0];
        ring(DVec2::splat(0.5), 1.0 / 2.4, false).curves[0]
            .between([a, b])
            .unwrap()
    };
    let lid = |y: f64| {
        let corner = DVec3::new(-1.2, y, -1.2);
        let data = flat(corner, DVec3::X * 2.4, DVec3::Z * 2.4);
        let back = |curve: NurbsCurve| NurbsCurve {
            knots: curve.knots.iter().rev().map(|k| -k).collect(),
            points: curve.points.into_iter().rev().collect(),
            weights: curve.weights.into_iter().rev().collect(),
            ..curve
        };
        let curves = vec![back(half(2.0)), back(half(0.0))];
        let is_hole = false;
        Arc::new(Nurbs::try_trimmed(&data, &[TrimLoop { curves, is_hole }]).unwrap())
    };
    assert_eq!(QUARTERS.len(), 12);
    let ours = brep(&[lid(-1.0), tube(1.0, -1.0, 1.0), lid(1.0)]);
    assert!(ours.contains(DVec3::new(0.6, 0.9, -0.6)) && !ours.contains(DVec3::new(0.8, 0.9, 0.8)));
}
