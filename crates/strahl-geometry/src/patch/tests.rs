use super::frame::Frame;
use super::piece::PatchPlace;
use super::*;
use crate::conformance::Random;
use crate::{GeometryError, PrimHit, Primitive, Scratch, Sphere, SurfaceId, Torus};
use strahl_math::{DVec2, DVec3, Interval, Ray, Transform};

/// Control points, `points[v][u]`.
pub(super) type Points = [[DVec3; 4]; 4];

/// A square of side 2 about the origin, with the heights of its control points.
pub(super) fn heights(z: [[f64; 4]; 4]) -> Points {
    std::array::from_fn(|j| {
        std::array::from_fn(|i| {
            DVec3::new(
                i as f64 * 2.0 / 3.0 - 1.0,
                j as f64 * 2.0 / 3.0 - 1.0,
                z[j][i],
            )
        })
    })
}

pub(super) fn wavy() -> Points {
    heights([
        [0.0, 0.6, -0.3, 0.2],
        [0.5, 1.3, -1.0, 0.1],
        [-0.4, 0.9, 0.8, -0.6],
        [0.1, -0.5, 0.7, 0.3],
    ])
}

/// A patch that hangs over, so that rays meet it up to nine times.
fn folded() -> Points {
    let mut random = Random::new(77);
    std::array::from_fn(|j| {
        std::array::from_fn(|i| {
            DVec3::new(i as f64 / 3.0, j as f64 / 3.0, 0.0) + random.cube() * 0.9
        })
    })
}

/// A quarter of a unit circle about the origin, from `x` to `y`, as a cubic of weighted points: a quadratic one, elevated.
const fn quarter() -> [[f64; 3]; 4] {
    const W: f64 = std::f64::consts::FRAC_1_SQRT_2;
    const A: f64 = (1.0 + 2.0 * W) / 3.0;
    const B: f64 = 2.0 * W / 3.0;
    [[1.0, 0.0, 1.0], [A, B, A], [B, A, A], [0.0, 1.0, 1.0]]
}

/// The quarter `[x >= 0, z >= 0]` of a surface of revolution about the y axis, of a profile of weighted points of the half
/// plane.
pub(super) fn revolved(profile: [[f64; 3]; 4]) -> BicubicPatch {
    let circle = quarter();
    let weights = std::array::from_fn(|j| std::array::from_fn(|i| profile[j][2] * circle[i][2]));
    let points = std::array::from_fn(|j| {
        std::array::from_fn(|i| {
            let [x, y, w] = profile[j];
            let [c, s, v] = circle[i];
            DVec3::new(x / w * (c / v), y / w, x / w * (s / v))
        })
    });
    BicubicPatch::try_rational(points, weights).unwrap()
}

/// An eighth of the unit sphere; its upper edge is collapsed.
pub(super) fn octant() -> BicubicPatch {
    revolved(quarter())
}

/// A part of a torus of radii 1 and 0.4.
fn bow() -> BicubicPatch {
    revolved(quarter().map(|[x, y, w]| [w + 0.4 * x, 0.4 * y, w]))
}

/// A petal: two opposite edges are collapsed.
fn petal() -> Points {
    let mut points = wavy();
    points[0] = [DVec3::new(0.0, -1.0, 0.2); 4];
    points[3] = [DVec3::new(0.1, 1.0, -0.2); 4];
    points
}

fn patch(points: Points) -> BicubicPatch {
    BicubicPatch::try_new(points).unwrap()
}

crate::primitive_tests!(hills, || patch(wavy()));
crate::primitive_tests!(flat, || patch(heights([[0.0; 4]; 4])));
crate::primitive_tests!(crumpled, || patch(folded()));
crate::primitive_tests!(leaf, || patch(petal()));
crate::primitive_tests!(part_of_a_sphere, octant);
crate::primitive_tests!(part_of_a_torus, bow);
crate::primitive_tests!(with_corners, || patch(wavy())
    .with_uv([
        DVec2::new(0.1, 0.2),
        DVec2::new(0.8, 0.1),
        DVec2::new(0.9, 0.9),
        DVec2::new(0.3, 0.7)
    ])
    .unwrap());

/// What 16 threads count, added up: each shoots its part of the rays, with a seed of its own.
pub(super) fn in_parts<const N: usize>(
    rays: usize,
    seed: u64,
    shoot: impl Fn(usize, u64) -> [usize; N] + Sync,
) -> [usize; N] {
    let mut sums = [0; N];
    std::thread::scope(|scope| {
        let start = |part| {
            scope.spawn({
                let shoot = &shoot;
                move || shoot(rays / 16, seed * 16 + part)
            })
        };
        let threads: Vec<_> = (0..16).map(start).collect();
        for thread in threads {
            let counts = thread.join().expect("no panic");
            sums.iter_mut()
                .zip(counts)
                .for_each(|(sum, count)| *sum += count);
        }
    });
    sums
}

/// All hits of a line, one after the other.
pub(super) fn hits(patch: &BicubicPatch, ray: &Ray) -> Vec<PrimHit> {
    let scratch = &mut Scratch::default();
    let (mut range, mut list) = (Interval::LINE, vec![]);
    while let Some(hit) = patch.closest_hit(ray, range, None, scratch) {
        assert!(list.len() < 40, "{ray:?} {list:?}");
        list.push(hit);
        range.min = hit.t;
    }
    list
}

#[test]
fn hits_are_those_of_the_sphere_and_the_torus() {
    let sphere = Sphere::new(DVec3::ZERO, 1.0);
    let torus = Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.4);
    let subjects: [(BicubicPatch, &dyn Primitive); 2] = [(octant(), &sphere), (bow(), &torus)];
    let (mut random, scratch) = (Random::new(9), &mut Scratch::default());
    for (ours, theirs) in subjects {
        let (mut found, mut missed) = (0, 0);
        for _ in 0..20_000 {
            let (from, to) = (random.cube() * 4.0, random.cube());
            let ray = Ray::new(from, to - from);
            let mut expected = vec![];
            let mut range = Interval::LINE;
            let mut is_clear = true;
            while let Some(hit) = theirs.closest_hit(&ray, range, None, scratch) {
                let at = theirs.surface_at(&ray, &hit);
                let p = at.position;
                let rim = if theirs.kind() == "torus" {
                    (p.x * p.x + p.z * p.z).sqrt() - 1.0
                } else {
                    1.0
                };
                let near = [p.x, p.y, p.z, rim].iter().any(|x| x.abs() < 1e-6);
                is_clear &= !near && at.n_geom.dot(ray.direction.normalize()).abs() > 1e-3;
                if p.min_element() > 0.0 && rim > 0.0 {
                    expected.push((hit.t, at.n_geom));
                }
                range.min = hit.t;
            }
            if !is_clear {
                continue;
            }
            let list = hits(&ours, &ray);
            assert_eq!(list.len(), expected.len(), "{ray:?}: {list:?} {expected:?}");
            for (hit, (t, normal)) in list.iter().zip(&expected) {
                assert!((hit.t - t).abs() < 1e-12, "{ray:?} {hit:?} {t}");
                let own = ours.surface_at(&ray, hit).n_geom;
                assert!(own.dot(*normal).abs() > 1.0 - 1e-10, "{own} {normal}");
            }
            found += list.len();
            missed += usize::from(list.is_empty());
        }
        assert!(found > 500 && missed > 500, "{found} {missed}");
    }
}

/// For every ray, also along the surface, the hits with their signs add up to the winding number of the border.
#[test]
fn hits_add_up_to_the_winding_number() {
    let subjects = [
        patch(wavy()),
        patch(folded()),
        patch(petal()),
        octant(),
        bow(),
    ];
    let mut random = Random::new(4);
    let mut counts = [0; 10];
    for (k, subject) in subjects.iter().enumerate() {
        for round in 0..20_000 {
            let target = {
                let [p, by_u, by_v] = subject.bezier.jet(random.unit(), random.unit());
                match round % 4 {
                    0 => subject.bounds().center() + subject.bounds().size() * 0.5 * random.cube(),
                    1 => p,
                    2 => p + by_u * random.magnitude(-14.0, 0.0),
                    _ => p + by_u.cross(by_v) * random.magnitude(-14.0, 0.0),
                }
            };
            let direction = match round % 5 {
                0 => {
                    let [p, by_u, by_v] = subject.bezier.jet(random.unit(), random.unit());
                    let tangent = by_u * random.between(-1.0, 1.0) + by_v;
                    if round % 2 == 0 { tangent } else { target - p }
                }
                1 => DVec3::AXES[random.below(3) as usize],
                _ => random.direction(),
            };
            let ray = Ray::new(target - direction * random.between(0.0, 4.0), direction);
            let Some(frame) = Frame::new(&ray) else {
                continue;
            };
            let all = subject.bezier.all(&frame, None);
            let sum: i32 = all.iter().map(|c| c.sign).sum();
            let expected = subject.bezier.winding(&frame);
            let unsure = all.iter().filter(|c| c.sign == 0).count() as i32;
            assert!(
                (sum - expected).abs() <= unsure,
                "patch {k} {ray:?}: {all:?}, {expected}"
            );
            let list = hits(subject, &ray);
            assert_eq!(list.len(), all.len(), "patch {k} {ray:?}: {list:?} {all:?}");
            counts[list.len().min(9)] += 1;
        }
    }
    assert!(counts[..5].iter().all(|c| *c > 20), "{counts:?}");
}

/// That a ray starts on the patch makes its own place no hit, and changes nothing else.
#[test]
fn rays_that_leave_a_patch_meet_the_rest_of_it() {
    let subjects = [
        patch(wavy()),
        patch(folded()),
        patch(petal()),
        patch(heights([[0.0, 0.02, 0.03, 0.0]; 4])),
        octant(),
        bow(),
    ];
    let mut random = Random::new(9);
    let (mut met, mut starts) = (0, 0);
    for round in 0..60_000 {
        let subject = &subjects[round % subjects.len()];
        let (u, v) = (random.unit(), random.unit());
        let [p, by_u, by_v] = subject.bezier.jet(u, v);
        let Some(normal) = by_u.cross(by_v).try_normalize() else {
            continue;
        };
        let towards = subject.bezier.jet(random.unit(), random.unit())[0] - p;
        let flat = towards - normal * towards.dot(normal);
        let direction = match round % 3 {
            0 => random.direction(),
            1 => towards,
            // At a low angle.
            _ => flat + normal * (flat.length() * random.magnitude(-6.0, 0.0)),
        };
        let surface = SurfaceId {
            element: 0,
            facet: PatchPlace::of([u, v]).facet(),
        };
        let error = crate::primitives::point_error(p, subject.bounds().max_abs(), 64);
        let off = normal * (error.length() * direction.dot(normal).signum());
        let ray = Ray::new(p + off, direction);
        let range = Interval::new(1e-6, random.magnitude(-2.0, 2.0));
        let scratch = &mut Scratch::default();
        let past = subject.closest_hit(&ray, range, None, scratch);
        let from = Some(surface);
        let found = subject.closest_hit(&ray, range, from, scratch);
        assert_eq!(found, past, "{round} {ray:?}");
        let any = subject.any_hit(&ray, range, from, scratch);
        assert_eq!(any, found.is_some(), "{round} {ray:?}");
        // With the hit at the start, if it is within the range.
        let range = Interval::new(f64::NEG_INFINITY, 1e-6);
        let all = |from| subject.closest_hit(&ray, range, from, &mut Scratch::default());
        starts += usize::from(all(None).is_some() && all(from).is_none());
        met += usize::from(any);
    }
    assert!(met > 5_000, "{met}");
    assert!(starts > 1_000, "{starts}");
}

/// Rays beside a tangent of the sphere, however near: with two hits that are nearly one, or none.
#[test]
fn rays_beside_a_tangent_meet_a_sphere_twice_or_never() {
    let octant = octant();
    let mut random = Random::new(12);
    let mut counts = [0; 2];
    for _ in 0..20_000 {
        let p = random.cube().abs() + DVec3::splat(0.3);
        let p = p.normalize();
        let along = p.cross(random.direction()).normalize();
        // Well above the rounding errors of the points.
        let off = random.magnitude(-11.0, -3.0);
        let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let start = random.between(0.5, 4.0);
        let ray = Ray::new(p * (1.0 + side * off) - along * start, along);
        let list = hits(&octant, &ray);
        if side > 0.0 {
            assert_eq!(list, [], "{ray:?} {off}");
            counts[0] += 1;
            continue;
        }
        assert_eq!(list.len(), 2, "{ray:?} {off}: {list:?}");
        let half = (off * (2.0 - off)).sqrt();
        for (hit, t) in list.iter().zip([start - half, start + half]) {
            assert!(
                (hit.t - t).abs() < 1e-14 / half,
                "{ray:?} {off} {hit:?} {t}"
            );
        }
        counts[1] += 1;
    }
    assert!(counts.iter().all(|c| *c > 5000), "{counts:?}");
}

#[test]
fn the_normal_of_a_collapsed_edge_is_that_of_the_surface_beside_it() {
    let (octant, scratch) = (octant(), &mut Scratch::default());
    for x in [0.0, 1e-300, 1e-17, 1e-12, 1e-9, 1e-6, 1e-3] {
        let ray = Ray::new(DVec3::new(x, 3.0, x), -DVec3::Y);
        let hit = octant.closest_hit(&ray, Interval::FORWARD, None, scratch);
        let Some(hit) = hit else {
            assert!(x < 1e-16, "nothing at {x}");
            continue;
        };
        assert!((hit.t - 2.0).abs() < 1e-5, "{hit:?}");
        let n = octant.surface_at(&ray, &hit).n_geom;
        assert!((n.y.abs() - 1.0).abs() < 1e-5 && n.is_finite(), "{x} {n}");
    }
    // Both edges are collapsed there.
    let petal = patch(petal());
    for uv in [[0.3, 0.0], [0.0, 0.0], [1.0, 1.0], [0.5, 1.0]] {
        let hit = PrimHit {
            uv,
            ..PrimHit::simple(1.0, 0)
        };
        let n = petal
            .surface_at(&Ray::new(DVec3::ZERO, DVec3::Z), &hit)
            .n_geom;
        assert!(n.z.abs() > 0.05 && (n.length() - 1.0).abs() < 1e-12, "{n}");
    }
}

#[test]
fn the_front_of_a_patch_is_where_rows_run_clockwise() {
    let points = heights([[0.0; 4]; 4]);
    let ray = Ray::new(DVec3::new(0.1, 0.2, 5.0), -DVec3::Z);
    let scratch = &mut Scratch::default();
    let patch = patch(points);
    let hit = patch
        .closest_hit(&ray, Interval::FORWARD, None, scratch)
        .unwrap();
    assert_eq!(patch.surface_at(&ray, &hit).n_geom, -DVec3::Z);
    let at = patch.surface_at(&ray, &hit);
    assert!((at.uv - DVec2::new(0.55, 0.6)).length() < 1e-15, "{at:?}");
    assert!((at.dpdu - DVec3::X * 2.0).length() < 1e-14, "{at:?}");
    let mirror = Transform::try_scale(DVec3::new(-1.0, 1.0, 1.0)).unwrap();
    let baked = patch.baked(&mirror).unwrap();
    assert_eq!(baked.surface_at(&ray, &hit).n_geom, -DVec3::Z);
}

#[test]
fn texture_coordinates_are_interpolated_between_the_corners() {
    let corners = [[0.1, 0.1], [0.9, 0.2], [0.7, 0.8], [0.2, 0.6]].map(DVec2::from_array);
    let patch = patch(heights([[0.0; 4]; 4])).with_uv(corners).unwrap();
    let at = |u, v| {
        let hit = PrimHit {
            uv: [u, v],
            ..PrimHit::simple(1.0, 0)
        };
        patch.surface_at(&Ray::new(DVec3::Z, -DVec3::Z), &hit)
    };
    let found = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| at(u, v).uv);
    for (a, b) in found.iter().zip(&corners) {
        assert!((*a - *b).length() < 1e-15, "{found:?}");
    }
    let middle = at(0.5, 0.5);
    let hit = PrimHit::simple(1.0, 0);
    assert_eq!(patch.texture_uv(&hit, middle.uv), Some(middle.uv));
    assert!((middle.uv - DVec2::new(0.475, 0.425)).length() < 1e-15);
    // One texture that is the same everywhere has no derivatives.
    let patch = patch_with_one_corner();
    let hit = PrimHit::simple(1.0, 0);
    let at = patch.surface_at(&Ray::new(DVec3::Z, -DVec3::Z), &hit);
    assert_eq!((at.uv, at.dpdu), (DVec2::ONE, DVec3::ZERO));
}

fn patch_with_one_corner() -> BicubicPatch {
    patch(wavy()).with_uv([DVec2::ONE; 4]).unwrap()
}

#[test]
fn hostile_control_points_are_refused_or_harmless() {
    let refused = |points: Points, weights: [[f64; 4]; 4]| {
        BicubicPatch::try_rational(points, weights)
            .map(|_| ())
            .unwrap_err()
    };
    let ones = [[1.0; 4]; 4];
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        let mut points = wavy();
        points[1][2].y = bad;
        assert!(matches!(
            refused(points, ones),
            GeometryError::NotFiniteAt { index: 6, .. }
        ));
        let mut weights = ones;
        weights[3][3] = bad;
        assert!(matches!(
            refused(wavy(), weights),
            GeometryError::NotFinite { .. }
        ));
    }
    for bad in [0.0, -1.0, 1e10] {
        let mut weights = ones;
        weights[0][1] = bad;
        assert!(matches!(
            refused(wavy(), weights),
            GeometryError::OutOfRange { .. }
        ));
    }
    let point = [[DVec3::new(1.0, 2.0, 3.0); 4]; 4];
    let line = heights([[0.0; 4]; 4]).map(|row| row.map(|p| DVec3::new(p.x + 0.3 * p.y, 0.0, 0.0)));
    for points in [point, line] {
        assert!(matches!(
            refused(points, ones),
            GeometryError::Degenerate { .. }
        ));
    }
    let huge = wavy().map(|row| row.map(|p| p * 1e80));
    assert!(matches!(
        refused(huge, ones),
        GeometryError::OutOfRange { .. }
    ));
    // A patch collapsed to a curve has no area, but is no line: rays at it find nothing, soon.
    let curve = wavy().map(|_| wavy()[0]);
    let curved = BicubicPatch::try_new(curve.map(|row| row)).unwrap();
    let mut random = Random::new(3);
    for _ in 0..2000 {
        let [p, ..] = curved.bezier.jet(random.unit(), 0.5);
        let direction = random.direction();
        let ray = Ray::new(p - direction * 3.0, direction);
        assert_eq!(hits(&curved, &ray), []);
    }
    // Rays within a plane patch, along it and across its sides.
    let flat = patch(heights([[0.0; 4]; 4]));
    for _ in 0..2000 {
        let at = random.cube().with_z(0.0);
        let direction = random.direction().with_z(0.0);
        assert_eq!(hits(&flat, &Ray::new(at, direction)), []);
    }
}

#[test]
fn huge_and_tiny_patches_are_met() {
    let scratch = &mut Scratch::default();
    for scale in [1e-60, 1e-20, 1e20, 1e60] {
        let patch = patch(wavy().map(|row| row.map(|p| p * scale)));
        let ray = Ray::new(DVec3::new(0.2, 0.1, 3.0) * scale, -DVec3::Z);
        let hit = patch
            .closest_hit(&ray, Interval::FORWARD, None, scratch)
            .unwrap();
        assert!((1.0..5.0).contains(&(hit.t / scale)), "{scale} {hit:?}");
    }
}

/// A range that ends behind the origin was taken as empty.
#[test]
fn hits_behind_the_origin_are_found_in_ranges_that_end_there() {
    let (patch, scratch) = (patch(wavy()), &mut Scratch::default());
    let ray = Ray::new(DVec3::new(0.2, 0.1, 3.0), DVec3::Z);
    let behind = Interval::new(f64::NEG_INFINITY, -0.5);
    assert!(patch.any_hit(&ray, behind, None, scratch));
    let hit = patch.closest_hit(&ray, behind, None, scratch).unwrap();
    assert!((-4.0..-2.0).contains(&hit.t), "{hit:?}");
}
