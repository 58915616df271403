mod dense;
mod kept;

use super::*;
use crate::conformance::Random;
use crate::patch::BicubicPatch;
use crate::patch::tests::{in_parts, octant, wavy};
use crate::{Csg, CsgNode, Sphere, Torus};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

fn data(degree: [u32; 2], columns: usize, points: Vec<DVec3>) -> NurbsData {
    NurbsData::new(degree, columns, points)
}

/// A landscape over a square of side 2, of this many control points.
fn hills(degree: [u32; 2], columns: usize, rows: usize, seed: u64) -> NurbsData {
    let mut random = Random::new(seed);
    let points = (0..rows * columns).map(|k| {
        let at = |i: usize, count: usize| 2.0 * i as f64 / (count - 1) as f64 - 1.0;
        let (x, y) = (at(k % columns, columns), at(k / columns, rows));
        DVec3::new(x, y, random.between(-0.6, 0.6))
    });
    data(degree, columns, points.collect())
}

/// A full circle of four quarters, as a curve of degree 2: places and weights.
pub(super) fn circle() -> Vec<[f64; 3]> {
    [
        (1, 0),
        (1, 1),
        (0, 1),
        (-1, 1),
        (-1, 0),
        (-1, -1),
        (0, -1),
        (1, -1),
        (1, 0),
    ]
    .map(|(x, y)| {
        let w = if x != 0 && y != 0 { FRAC_1_SQRT_2 } else { 1.0 };
        [f64::from(x), f64::from(y), w]
    })
    .to_vec()
}

pub(super) const QUARTERS: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];

/// The surface that a profile `(radius, height, weight)` of degree 2 sweeps about the y axis.
pub(super) fn revolved(profile: &[[f64; 3]], knots: &[f64]) -> NurbsData {
    let (mut points, mut weights) = (vec![], vec![]);
    for [r, y, w] in profile {
        for [c, s, v] in circle() {
            points.push(DVec3::new(r * c, *y, r * s));
            weights.push(w * v);
        }
    }
    NurbsData {
        degree: [2, 2],
        knots: [QUARTERS.to_vec(), knots.to_vec()],
        points,
        weights,
    }
}

/// The unit sphere, collapsed at both poles.
pub(super) fn sphere() -> NurbsData {
    let profile = circle()[6..]
        .iter()
        .chain(&circle()[1..3])
        .copied()
        .collect::<Vec<_>>();
    revolved(&profile, &[0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0])
}

/// A torus of radii 1 and 0.4.
pub(super) fn torus() -> NurbsData {
    let profile: Vec<_> = circle()
        .iter()
        .map(|[x, y, w]| [1.0 + 0.4 * x, 0.4 * y, *w])
        .collect();
    revolved(&profile, &QUARTERS)
}

pub(super) fn nurbs(data: &NurbsData) -> Nurbs {
    Nurbs::try_new(data).unwrap()
}

/// A circle in the plane of parameters.
pub(super) fn ring(center: DVec2, radius: f64, is_hole: bool) -> TrimLoop {
    let curve = NurbsCurve {
        degree: 2,
        knots: QUARTERS.to_vec(),
        points: circle()
            .iter()
            .map(|[x, y, _]| center + DVec2::new(*x, *y) * radius)
            .collect(),
        weights: circle().iter().map(|p| p[2]).collect(),
    };
    TrimLoop {
        curves: vec![curve],
        is_hole,
    }
}

/// A landscape with a round border, a square hole and an island within it.
fn trimmed() -> Nurbs {
    let data = hills([3, 3], 6, 5, 3);
    let square = [(1.2, 0.7), (1.9, 0.7), (1.9, 1.4), (1.2, 1.4)].map(DVec2::from);
    let loops = [
        ring(DVec2::new(1.5, 1.0), 0.95, false),
        TrimLoop::polygon(square.to_vec(), true),
        ring(DVec2::new(1.55, 1.05), 0.2, false),
    ];
    Nurbs::try_trimmed(&data, &loops).unwrap()
}

crate::primitive_tests!(cubic_hills, || nurbs(&hills([3, 3], 7, 5, 1)));
crate::primitive_tests!(degrees_two_and_five, || nurbs(&hills([2, 5], 5, 8, 2)));
crate::primitive_tests!(degrees_nine_and_one, || nurbs(&hills([9, 1], 12, 3, 4)));
crate::primitive_tests!(degree_seven, || nurbs(&hills([6, 7], 8, 8, 5)));
crate::primitive_tests!(whole_sphere, || nurbs(&sphere()));
crate::primitive_tests!(whole_torus, || nurbs(&torus()));
crate::primitive_tests!(trimmed_hills, trimmed);
crate::primitive_tests!(trimmed_sphere, || {
    let band = [(0.5, 0.4), (3.7, 0.9), (3.1, 1.8), (1.0, 1.5)].map(DVec2::from);
    Nurbs::try_trimmed(&sphere(), &[TrimLoop::polygon(band.to_vec(), false)]).unwrap()
});

/// All hits of a line, one after the other.
pub(super) fn hits(shape: &dyn Primitive, ray: &Ray) -> Vec<PrimHit> {
    let scratch = &mut Scratch::default();
    let (mut range, mut list) = (Interval::LINE, vec![]);
    while let Some(hit) = shape.closest_hit(ray, range, None, scratch) {
        assert!(list.len() < 60, "{ray:?} {list:?}");
        list.push(hit);
        range.min = hit.t;
    }
    list
}

#[test]
fn spheres_and_tori_are_exact() {
    let (sphere_of, torus_of) = (
        Sphere::new(DVec3::ZERO, 1.0),
        Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.4),
    );
    let subjects: [(Nurbs, &dyn Primitive); 2] =
        [(nurbs(&sphere()), &sphere_of), (nurbs(&torus()), &torus_of)];
    let mut random = Random::new(21);
    for (ours, theirs) in &subjects {
        let mut found = 0;
        for round in 0..20_000 {
            let (from, to) = (random.cube() * 4.0, random.cube());
            // Also straight at the seam and the pole.
            let to = match round % 10 {
                0 => DVec3::new(1.0, to.y, 0.0),
                1 => DVec3::Y,
                _ => to,
            };
            let ray = Ray::new(from, to - from);
            let expected = hits(*theirs, &ray);
            let grazes = expected.iter().any(|hit| {
                let n = theirs.surface_at(&ray, hit).n_geom;
                n.dot(ray.direction.normalize()).abs() < 1e-3
            });
            if grazes {
                continue;
            }
            let list = hits(ours, &ray);
            assert_eq!(list.len(), expected.len(), "{ray:?} {list:?} {expected:?}");
            for (a, b) in list.iter().zip(&expected) {
                // The place of a pole, where all rows meet, is not as well known.
                let allowed = if round % 10 == 1 { 1e-8 } else { 1e-11 };
                assert!((a.t - b.t).abs() < allowed, "{ray:?} {a:?} {b:?}");
                let (n, m) = (
                    ours.surface_at(&ray, a).n_geom,
                    theirs.surface_at(&ray, b).n_geom,
                );
                assert!(n.dot(m).abs() > 1.0 - 1e-9, "{n} {m}");
            }
            found += list.len();
        }
        assert!(found > 5000, "{found}");
    }
}

/// A torus out of round, periodic in both directions.
fn periodic(degree: [u32; 2], random: &mut Random) -> NurbsData {
    let (columns, rows) = (9, 8);
    let loose: Vec<DVec3> = (0..columns * rows)
        .map(|k| {
            let angle = |i: usize, n: usize| TAU * i as f64 / n as f64;
            let (a, b) = (angle(k % columns, columns), angle(k / columns, rows));
            let r = 1.0 + 0.5 * b.cos();
            DVec3::new(r * a.cos(), 0.5 * b.sin(), r * a.sin()) + random.cube() * 0.05
        })
        .collect();
    // As many control points are repeated as the degree says, on even knots.
    let (wide, high) = (columns + degree[0] as usize, rows + degree[1] as usize);
    let points = (0..wide * high)
        .map(|k| loose[(k / wide % rows) * columns + k % wide % columns])
        .collect();
    let knots =
        |count: usize, degree: u32| (0..count + degree as usize + 1).map(|k| k as f64).collect();
    NurbsData {
        degree,
        knots: [knots(wide, degree[0]), knots(high, degree[1])],
        points,
        weights: vec![],
    }
}

/// Rays at the lines between patches, to the last bit: each meets the closed surface an even number of times, and at the place
/// aimed at once.
fn shoot(rays: usize, seed: u64) -> [usize; 2] {
    let mut random = Random::new(seed);
    let mut wrong = [0; 2];
    let mut surface = nurbs(&torus());
    for round in 0..rays {
        if round % 10_000 == 0 {
            // Of another degree each time.
            let degree = [2 + ((round / 10_000 + seed as usize) % 4) as u32, 3];
            surface = nurbs(&periodic(degree, &mut random));
        }
        let part = &surface.parts[random.below(surface.parts.len() as u64) as usize];
        let x = match random.below(3) {
            0 => 0.0,
            1 => random.below(8) as f64 / 8.0,
            _ => random.unit(),
        };
        let [u, v] = [[x, 0.0], [1.0, x], [x, 1.0], [0.0, x]][random.below(4) as usize];
        let [target, by_u, by_v] = part.patch.jet(u, v);
        let direction = random.direction();
        let n = by_u.cross(by_v).normalize();
        if direction.dot(n).abs() < 0.01 {
            continue;
        }
        let ray = Ray::new(target - direction * random.between(0.5, 3.0), direction);
        let list = hits(&surface, &ray);
        let near = list
            .iter()
            .filter(|hit| (ray.at(hit.t) - target).length() < 1e-9)
            .count();
        wrong[0] += usize::from(near != 1);
        wrong[1] += list.len() % 2;
    }
    wrong
}

#[test]
fn no_ray_slips_through_between_patches_or_meets_two() {
    assert_eq!(in_parts(100_000, 1, shoot), [0; 2]);
}

/// The long version, for releases: on all processors.
#[test]
#[ignore = "takes minutes; run it with --ignored"]
fn no_ray_of_ten_millions_slips_through_between_patches() {
    assert_eq!(in_parts(10_000_000, 2, shoot), [0; 2]);
}

#[test]
fn a_surface_of_one_bezier_patch_is_that_patch() {
    let points = wavy();
    let patch = BicubicPatch::try_new(points).unwrap();
    let surface = nurbs(&data([3, 3], 4, points.as_flattened().to_vec()));
    let mut random = Random::new(2);
    let scratch = &mut Scratch::default();
    let mut met = 0;
    for _ in 0..5000 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let ray = Ray::new(from, to - from);
        let a = patch.closest_hit(&ray, Interval::FORWARD, None, scratch);
        let b = surface.closest_hit(&ray, Interval::FORWARD, None, scratch);
        assert_eq!(a, b);
        let Some(hit) = a else { continue };
        let (p, q) = (patch.surface_at(&ray, &hit), surface.surface_at(&ray, &hit));
        // The usual front of NURBS surfaces is the other side.
        assert_eq!((p.position, p.n_geom, p.uv), (q.position, -q.n_geom, q.uv));
        assert_eq!((p.dpdu, p.dpdv), (q.dpdu, q.dpdv));
        met += 1;
    }
    assert!(met > 1000);
}

#[test]
fn a_hit_is_there_exactly_where_the_loops_say() {
    // A plane surface whose points are its parameters, so that the loops are seen from above.
    let grid: Vec<DVec3> = (0..12)
        .map(|k| DVec3::new((k % 4) as f64, (k / 4) as f64, 0.0))
        .collect();
    let plane = data([1, 1], 4, grid);
    let zigzag: Vec<DVec2> = (0..200)
        .map(|k| {
            let a = TAU * k as f64 / 200.0;
            let r = if k % 2 == 0 { 0.9 } else { 0.6 };
            DVec2::new(1.5, 1.0) + DVec2::from_angle(a) * r
        })
        .collect();
    let inside_zigzag = |p: DVec2| {
        let mut inside = false;
        for (k, a) in zigzag.iter().enumerate() {
            let b = zigzag[(k + 1) % zigzag.len()];
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    };
    let in_ring = |p: DVec2, center: (f64, f64), r: f64| (p - DVec2::from(center)).length() < r;
    type Oracle<'a> = Box<dyn Fn(DVec2) -> bool + 'a>;
    let cases: [(Vec<TrimLoop>, Oracle<'_>); 4] = [
        (
            vec![ring(DVec2::new(1.5, 1.0), 0.8, true)],
            Box::new(|p| !in_ring(p, (1.5, 1.0), 0.8)),
        ),
        (
            vec![TrimLoop::polygon(zigzag.clone(), false)],
            Box::new(inside_zigzag),
        ),
        // Loops that cross and reach beyond the surface.
        (
            vec![
                ring(DVec2::new(0.6, 1.0), 0.9, false),
                ring(DVec2::new(1.4, 1.2), 0.7, false),
                ring(DVec2::new(2.9, 0.1), 1.0, false),
            ],
            Box::new(|p| {
                in_ring(p, (0.6, 1.0), 0.9)
                    ^ in_ring(p, (1.4, 1.2), 0.7)
                    ^ in_ring(p, (2.9, 0.1), 1.0)
            }),
        ),
        // Nested.
        (
            (1..6)
                .map(|k| ring(DVec2::new(1.5, 1.0), 0.2 * f64::from(k), k % 2 == 0))
                .collect(),
            Box::new(|p| {
                (1..6)
                    .filter(|k| in_ring(p, (1.5, 1.0), 0.2 * f64::from(*k)))
                    .count()
                    % 2
                    == 1
            }),
        ),
    ];
    let mut random = Random::new(12);
    let scratch = &mut Scratch::default();
    for (number, (loops, oracle)) in cases.iter().enumerate() {
        // One knot span of the plane is one unit.
        let surface = Nurbs::try_trimmed(&plane, loops).unwrap();
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..20_000 {
            let p = DVec2::new(random.between(0.0, 3.0), random.between(0.0, 2.0));
            // Beside a border both are right.
            let near = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y]
                .iter()
                .any(|d| oracle(p + *d * 1e-9) != oracle(p));
            if near {
                continue;
            }
            let ray = Ray::new(p.extend(2.0), -DVec3::Z);
            let hit = surface.any_hit(&ray, Interval::FORWARD, None, scratch);
            assert_eq!(hit, oracle(p), "case {number} at {p}");
            inside += usize::from(hit);
            outside += usize::from(!hit);
        }
        assert!(
            inside > 1000 && outside > 1000,
            "{number}: {inside} {outside}"
        );
    }
}

/// A ray near a border of trimming is decided by its parameters alone, so one half is there and the other is not.
#[test]
fn the_border_of_a_trimmed_surface_is_sharp() {
    let grid = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
    let surface = Nurbs::try_trimmed(
        &data([1, 1], 2, grid),
        &[ring(DVec2::new(0.5, 0.5), 0.3, false)],
    )
    .unwrap();
    let scratch = &mut Scratch::default();
    for k in 0..1000 {
        let a = TAU * f64::from(k) / 1000.0;
        for (r, expected) in [(0.3 - 1e-13, true), (0.3 + 1e-13, false)] {
            let p = DVec2::splat(0.5) + DVec2::from_angle(a) * r;
            let ray = Ray::new(p.extend(1.0), -DVec3::Z);
            let hit = surface.any_hit(&ray, Interval::FORWARD, None, scratch);
            assert_eq!(hit, expected, "{p}");
        }
    }
}

#[test]
fn the_front_is_where_u_and_v_run_counter_clockwise() {
    let grid = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
    let knots = [2.0, 2.0, 6.0, 6.0].to_vec();
    let surface = nurbs(&NurbsData {
        knots: [knots.clone(), knots],
        ..data([1, 1], 2, grid)
    });
    let ray = Ray::new(DVec3::new(0.25, 0.5, 1.0), -DVec3::Z);
    let scratch = &mut Scratch::default();
    let hit = surface
        .closest_hit(&ray, Interval::FORWARD, None, scratch)
        .unwrap();
    let at = surface.surface_at(&ray, &hit);
    assert_eq!(at.n_geom, DVec3::Z);
    assert!((at.uv - DVec2::new(0.25, 0.5)).length() < 1e-15);
    assert!((at.dpdu - DVec3::X).length() < 1e-14 && (at.dpdv - DVec3::Y).length() < 1e-14);
    assert_eq!(surface.texture_uv(&hit, at.uv), Some(at.uv));
    let mirror = Transform::try_scale(DVec3::new(1.0, 1.0, -1.0)).unwrap();
    let baked = surface.baked(&mirror).unwrap();
    assert_eq!(baked.surface_at(&ray, &hit).n_geom, -DVec3::Z);
}

#[test]
fn hostile_surfaces_are_refused_or_harmless() {
    let good = hills([3, 2], 5, 4, 9);
    let refused = |change: &dyn Fn(&mut NurbsData)| {
        let mut data = good.clone();
        change(&mut data);
        Nurbs::try_new(&data).map(|_| ()).unwrap_err().to_string()
    };
    type Change<'a> = &'a dyn Fn(&mut NurbsData);
    let cases: [(Change<'_>, &str); 12] = [
        (
            &|d| d.degree[0] = 0,
            "degree of the NURBS surface along u must be from 1 to 9",
        ),
        (&|d| d.degree[1] = 77, "must be from 1 to 9, found 77"),
        (&|d| d.degree[1] = u32::MAX, "must be from 1 to 9"),
        (
            &|d| d.points[7].y = f64::NAN,
            "control point of the NURBS surface 7 is not finite",
        ),
        (
            &|d| d.points[7].y = 1e80,
            "must be at most 1e70 from the origin, found 1",
        ),
        (
            &|d| d.points.truncate(19),
            "19 control points of the NURBS surface given, 20 expected",
        ),
        (
            &|d| d.knots[1].truncate(6),
            "20 control points of the NURBS surface given, 15",
        ),
        (
            &|d| d.weights = vec![1.0; 3],
            "3 weights of the NURBS surface given, 20",
        ),
        (
            &|d| (d.weights, d.weights[3]) = (vec![1.0; 20], 0.0),
            "weight of the NURBS surface 3 must be greater than 0, found 0",
        ),
        (
            &|d| (d.weights, d.weights[3]) = (vec![1.0; 20], -2.0),
            "must be greater than 0, found -2",
        ),
        (
            &|d| (d.weights, d.weights[3]) = (vec![1.0; 20], 1e10),
            "at most 1e9 times the least",
        ),
        (
            &|d| d.points = (0..20).map(|k| DVec3::X * f64::from(k)).collect(),
            "lie on a line",
        ),
    ];
    for (change, expected) in cases {
        let message = refused(change);
        assert!(message.contains(expected), "{message}: {expected}");
    }
    let with = |loops: &[TrimLoop]| Nurbs::try_trimmed(&good, loops).map(|_| ());
    let line = |points: &[(f64, f64)]| {
        NurbsCurve::polyline(points.iter().map(|p| DVec2::from(*p)).collect())
    };
    let open = |curves| TrimLoop {
        curves,
        is_hole: false,
    };
    for (loops, expected) in [
        (
            open(vec![line(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])]),
            "does not end where it begins",
        ),
        (
            open(vec![
                line(&[(0.0, 0.0), (1.0, 0.0)]),
                line(&[(1.0, 1.0), (0.0, 0.0)]),
            ]),
            "curve 1 of trim loop 0",
        ),
        (open(vec![]), "it has no curves"),
        (
            open(vec![line(&[(0.0, 0.0)])]),
            "1 control points of the trimming curve given",
        ),
        (
            TrimLoop::polygon(
                vec![DVec2::new(f64::INFINITY, 0.0), DVec2::X, DVec2::Y],
                false,
            ),
            "control point of the trimming curve 0 is not finite",
        ),
        (
            TrimLoop::polygon(
                [(9.0, 9.0), (9.5, 9.0), (9.0, 9.5)]
                    .map(DVec2::from)
                    .to_vec(),
                false,
            ),
            "leave nothing of it",
        ),
    ] {
        let message = with(&[loops]).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}: {expected}");
    }
    // Collapsed to a point at one side, to a line at another, with knots of full multiplicity.
    let mut odd = good.clone();
    odd.knots = [
        vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0],
        vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0],
    ];
    for (k, p) in odd.points.iter_mut().enumerate() {
        match k / 5 {
            0 => *p = DVec3::ZERO,
            3 => p.y = 0.4,
            _ => {}
        }
    }
    let surface = nurbs(&odd);
    let mut random = Random::new(31);
    for _ in 0..5000 {
        let target = random.cube() * if random.below(3) == 0 { 0.0 } else { 1.0 };
        let direction = random.direction();
        let ray = Ray::new(target - direction * 3.0, direction);
        for hit in hits(&surface, &ray) {
            let at = surface.surface_at(&ray, &hit);
            assert!(at.n_geom.is_finite() && (at.position - ray.at(hit.t)).length() < 1e-9);
        }
    }
}

/// A net of 300 x 300 points, cut by a polygon of 10000 corners: quickly made, and rays find their way.
#[test]
fn large_surfaces_are_met_in_time() {
    let start = std::time::Instant::now();
    let corners: Vec<DVec2> = (0..10_000)
        .map(|k| {
            let a = TAU * f64::from(k) / 10_000.0;
            DVec2::splat(148.0) + DVec2::from_angle(a) * (120.0 + 20.0 * (50.0 * a).sin())
        })
        .collect();
    let data = hills([3, 3], 300, 300, 40);
    let surface = Nurbs::try_trimmed(&data, &[TrimLoop::polygon(corners, false)]).unwrap();
    let (mut random, mut met) = (Random::new(4), 0);
    for _ in 0..2000 {
        let at = random.cube();
        let ray = Ray::new(at.with_z(3.0), (at - random.cube() * 0.1).with_z(-3.0));
        met += hits(&surface, &ray).len();
    }
    assert!(met > 500, "{met}");
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
    // Larger ones are refused.
    let data = hills([9, 9], 400, 400, 40);
    let message = Nurbs::try_new(&data).unwrap_err().to_string();
    assert!(message.contains("number of pieces"), "{message}");
}

#[test]
fn an_eighth_of_a_sphere_has_the_same_bits_as_a_patch() {
    let patch = octant();
    let weights = patch.weights().as_flattened().to_vec();
    let surface = nurbs(&NurbsData {
        weights,
        ..data([3, 3], 4, patch.points().as_flattened().to_vec())
    });
    let mut random = Random::new(3);
    let scratch = &mut Scratch::default();
    for _ in 0..2000 {
        let (from, to) = (random.cube() * 3.0, random.cube().abs());
        let ray = Ray::new(from, to - from);
        let a = patch.closest_hit(&ray, Interval::FORWARD, None, scratch);
        let b = surface.closest_hit(&ray, Interval::FORWARD, None, scratch);
        assert!(
            a.zip(b).is_none_or(|(a, b)| (a.t - b.t).abs() < 1e-13) && a.is_some() == b.is_some()
        );
    }
}

#[test]
fn parts_of_curves_and_surfaces_are_the_same_curves_and_surfaces() {
    let mut random = Random::new(14);
    for (data, ranges) in [
        (torus(), [[0.3, 2.7], [1.0, 3.5]]),
        (hills([4, 2], 9, 7, 3), [[1.0, 3.25], [0.0, 4.4]]),
        (hills([3, 9], 4, 14, 5), [[0.0, 1.0], [0.4, 0.6]]),
    ] {
        let whole = nurbs(&data);
        let part = nurbs(&data.between(ranges).unwrap());
        let domain = data.patches().unwrap().domain;
        let at = |surface: &Nurbs, [u, v]: [f64; 2]| {
            let within =
                |p: &&Part| p.from[0] <= u && u <= p.to[0] && p.from[1] <= v && v <= p.to[1];
            let p = surface.parts.iter().find(within).unwrap();
            let local = [(u, 0), (v, 1)].map(|(x, k)| (x - p.from[k]) / (p.to[k] - p.from[k]));
            p.patch.jet(local[0], local[1])[0]
        };
        for _ in 0..500 {
            let x = [random.unit(), random.unit()];
            let own: [f64; 2] = std::array::from_fn(|k| {
                let t = ranges[k][0] + (ranges[k][1] - ranges[k][0]) * x[k];
                (t - domain[k][0]) / (domain[k][1] - domain[k][0])
            });
            let (a, b) = (at(&part, x), at(&whole, own));
            assert!((a - b).length() < 1e-12, "{a} {b}");
        }
        let message = data
            .between([[-1.0, 0.5], [0.0, 1.0]])
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("between its first and its last parameter, found -1"),
            "{message}"
        );
    }
    // A quarter of a circle is one, and an end that is rounded is that of the curve.
    let circle = &ring(DVec2::ZERO, 1.0, false).curves[0];
    let quarter = circle.between([1.0, 2.000_01]).unwrap();
    assert_eq!(quarter.points.first(), Some(&DVec2::new(0.0, 1.0)));
    for p in [
        circle.between([0.5, 2.5]).unwrap(),
        circle.between([3.9, 4.000_01]).unwrap(),
    ] {
        for end in [p.points[0], p.points[p.points.len() - 1]] {
            assert!((end.length() - 1.0).abs() < 1e-15, "{end}");
        }
    }
    assert!(circle.between([2.0, 1.0]).is_err());
}

#[test]
fn closed_surfaces_are_solids() {
    let ball = nurbs(&sphere());
    let exact = Sphere::new(DVec3::ZERO, 1.0);
    // The same with rows in the opposite order, whose normals pointed inwards.
    let mut turned = sphere();
    let rows: Vec<Vec<DVec3>> = turned.points.chunks(9).map(<[DVec3]>::to_vec).collect();
    turned.points = rows.into_iter().rev().flatten().collect();
    let mut random = Random::new(6);
    let scratch = &mut Scratch::default();
    for surface in [&ball, &nurbs(&turned)] {
        let solid = surface.as_solid().expect("a closed surface");
        for _ in 0..2000 {
            let point = random.cube() * 1.2;
            if (point.length() - 1.0).abs() > 1e-9 {
                assert_eq!(solid.contains(point), exact.contains(point), "{point}");
            }
            let ray = Ray::new(random.cube() * 2.0, random.direction());
            let Some(hit) = surface.closest_hit(&ray, Interval::FORWARD, None, scratch) else {
                continue;
            };
            let at = surface.surface_at(&ray, &hit);
            assert!(at.n_geom.dot(at.position) > 0.99, "{at:?}");
        }
    }
    assert!(nurbs(&torus()).as_solid().is_some());
    for open in [
        nurbs(&hills([3, 3], 5, 5, 1)),
        trimmed(),
        Nurbs::try_trimmed(&sphere(), &[ring(DVec2::new(2.0, 1.0), 0.3, true)]).unwrap(),
        // A tube without ends.
        nurbs(&revolved(
            &[[1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [1.0, 2.0, 1.0]],
            &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        )),
    ] {
        assert!(open.as_solid().is_none());
    }
}

/// A torus of NURBS cut from a ball of NURBS is the same as the exact torus cut from the exact ball.
#[test]
fn closed_surfaces_are_cut_from_each_other() {
    let tree = |ball: Shape, ring: Shape| {
        let (ball, ring) = (CsgNode::leaf(ball, 0), CsgNode::leaf(ring, 1));
        Csg::try_new(CsgNode::difference([ball, ring])).expect("solids")
    };
    let ours = tree(nurbs(&sphere()).into(), nurbs(&torus()).into());
    let theirs = tree(
        Sphere::new(DVec3::ZERO, 1.0).into(),
        Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.4).into(),
    );
    let (mut random, mut met) = (Random::new(61), 0);
    for _ in 0..10_000 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let ray = Ray::new(from, to - from);
        let (a, b) = (hits(&ours, &ray), hits(&theirs, &ray));
        let grazes = b.iter().any(|hit| {
            let n = theirs.surface_at(&ray, hit).n_geom;
            n.dot(ray.direction.normalize()).abs() < 1e-3
        });
        if grazes {
            continue;
        }
        assert_eq!(a.len(), b.len(), "{ray:?} {a:?} {b:?}");
        for (a, b) in a.iter().zip(&b) {
            assert!((a.t - b.t).abs() < 1e-10, "{ray:?} {a:?} {b:?}");
        }
        met += a.len();
    }
    assert!(met > 5000, "{met}");
}
