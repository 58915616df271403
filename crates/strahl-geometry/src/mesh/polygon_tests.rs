use super::{Polygon, fan_triangles};
use crate::conformance::Random;
use crate::{GeometryError, PrimHit, Primitive, Scratch};
use strahl_math::{DVec2, DVec3, Interval, Ray, Transform, det};

/// Corners in the plane z = 0.
fn flat(points: &[(i32, i32)]) -> Vec<DVec3> {
    let corner = |&(x, y): &(i32, i32)| DVec3::new(f64::from(x), f64::from(y), 0.0);
    points.iter().map(corner).collect()
}

fn hit(polygon: &impl Primitive, ray: &Ray) -> Option<PrimHit> {
    polygon.closest_hit(ray, Interval::LINE, None, &mut Scratch::default())
}

fn down(x: f64, y: f64) -> Ray {
    Ray::new(DVec3::new(x, y, 3.0), -DVec3::Z)
}

/// A star of `n` spikes with corners on a grid, no three neighbours on a line.
fn star(n: u32) -> Vec<(i32, i32)> {
    let mut random = Random::new(u64::from(n));
    (0..2 * n)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(2 * n);
            let r = if i % 2 == 0 {
                30_000.0
            } else {
                random.between(3_000.0, 27_000.0)
            };
            ((r * det::cos(angle)) as i32, (r * det::sin(angle)) as i32)
        })
        .collect()
}

/// The exact position of an integer point: `None` on an edge, else whether the winding number of the rings is odd.
fn oracle(rings: &[Vec<(i32, i32)>], (x, y): (i32, i32)) -> Option<bool> {
    let mut winding = 0;
    for ring in rings {
        for (i, &(ax, ay)) in ring.iter().enumerate() {
            let (bx, by) = ring[(i + 1) % ring.len()];
            let cross =
                i64::from(ax - x) * i64::from(by - y) - i64::from(ay - y) * i64::from(bx - x);
            let between = (ax - x).signum() * (bx - x).signum() <= 0
                && (ay - y).signum() * (by - y).signum() <= 0;
            if cross == 0 && between {
                return None;
            }
            if ay <= y && by > y && cross > 0 {
                winding += 1;
            }
            if ay > y && by <= y && cross < 0 {
                winding -= 1;
            }
        }
    }
    Some(winding % 2 != 0)
}

#[test]
fn a_square_with_a_hole() {
    let hole = flat(&[(1, 1), (1, 3), (3, 3), (3, 1)]);
    let polygon =
        Polygon::try_with_holes(&flat(&[(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]), &[hole])
            .expect("flat");
    assert_eq!(polygon.corners().len(), 8);
    assert_eq!(polygon.rings().map(<[_]>::len).collect::<Vec<_>>(), [4, 4]);
    let ray = down(0.5, 2.0);
    let found = hit(&polygon, &ray).expect("a hit");
    assert_eq!(found, PrimHit::simple(3.0, 0));
    let point = polygon.surface_at(&ray, &found);
    assert_eq!(
        (point.position, point.n_geom),
        (DVec3::new(0.5, 2.0, 0.0), DVec3::Z)
    );
    assert_eq!(point.uv, DVec2::new(0.125, 0.5));
    assert_eq!((point.dpdu, point.dpdv), (DVec3::X * 4.0, DVec3::Y * 4.0));
    assert_eq!(hit(&polygon, &down(2.0, 2.0)), None);
    assert_eq!(hit(&polygon, &down(5.0, 2.0)), None);
    assert_eq!(
        hit(&polygon, &Ray::new(DVec3::new(-1.0, 2.0, 0.0), DVec3::X)),
        None,
        "edge-on"
    );
    let from = Some(found.surface);
    assert_eq!(
        polygon.closest_hit(&ray, Interval::FORWARD, from, &mut Scratch::default()),
        None
    );
}

#[test]
fn bad_polygons_are_refused() {
    let error = |corners: &[DVec3]| Polygon::try_new(corners).expect_err("bad");
    let degenerate = |corners: &[DVec3]| {
        assert!(
            matches!(error(corners), GeometryError::Degenerate { .. }),
            "{corners:?}"
        )
    };
    degenerate(&[]);
    degenerate(&flat(&[(0, 0), (1, 0), (1, 0), (0, 0)]));
    degenerate(&flat(&[(0, 0), (1, 1), (2, 2), (5, 5)]));
    degenerate(&flat(&[(0, 0), (2, 2), (2, 0), (0, 2)]));
    let third = DVec3::splat(1.0 / 3.0);
    degenerate(&[
        third,
        third + DVec3::new(0.1, 0.3, 0.7),
        third + DVec3::new(0.1, 0.3, 0.7) * 2.5,
    ]);
    let mut bent = flat(&[(0, 0), (1, 0), (1, 1), (0, 1)]);
    bent[2].z = 1e-4;
    assert!(matches!(error(&bent), GeometryError::OutOfRange { .. }));
    bent[2].z = 1e-6;
    assert!(Polygon::try_new(&bent).is_ok(), "six digits are enough");
    bent[3].x = f64::NAN;
    assert_eq!(
        error(&bent).to_string(),
        "corner of the polygon 3 is not finite"
    );
}

#[test]
fn inside_agrees_with_the_winding_number() {
    let concave = vec![
        (0, 0),
        (9, 0),
        (9, 7),
        (6, 7),
        (6, 3),
        (3, 3),
        (3, 9),
        (0, 9),
    ];
    // Touches itself in a corner and along an edge.
    let touching = vec![
        (0, 0),
        (8, 0),
        (4, 4),
        (8, 8),
        (0, 8),
        (4, 4),
        (2, 4),
        (4, 4),
    ];
    let with_hole = vec![
        vec![(-9, -9), (9, -9), (0, 9)],
        vec![(-1, -2), (2, -2), (0, 2)],
        vec![(-3, -6), (3, -6), (3, -4), (-3, -4)],
    ];
    let mut on_edges = 0;
    for rings in [vec![concave], vec![touching], with_hole] {
        let holes: Vec<_> = rings[1..].iter().map(|ring| flat(ring)).collect();
        let polygon = Polygon::try_with_holes(&flat(&rings[0]), &holes).expect("flat");
        for (x, y) in (-10..=10).flat_map(|x| (-10..=10).map(move |y| (x, y))) {
            let found = hit(&polygon, &down(f64::from(x), f64::from(y))).is_some();
            match oracle(&rings, (x, y)) {
                Some(inside) => assert_eq!(found, inside, "({x}, {y}) of {rings:?}"),
                None => on_edges += 1,
            }
        }
    }
    assert!(on_edges > 50);
}

#[test]
fn large_polygons_agree_with_the_winding_number() {
    for spikes in [17, 72, 2_000] {
        let rings = [star(spikes)];
        let polygon = Polygon::try_new(&flat(&rings[0])).expect("flat");
        let mut random = Random::new(7);
        let (mut inside, mut on_edges) = (0, 0);
        for i in 0..4_000 {
            let coordinate = |random: &mut Random| random.between(-30_000.0, 30_000.0) as i32;
            let (mut x, mut y) = (coordinate(&mut random), coordinate(&mut random));
            if i % 4 == 0 {
                // The height of a corner, or the corner.
                let corner = rings[0][random.below(rings[0].len() as u64) as usize];
                y = corner.1;
                x = if i % 8 == 0 { corner.0 } else { x };
            }
            let found = hit(&polygon, &down(f64::from(x), f64::from(y))).is_some();
            match oracle(&rings, (x, y)) {
                Some(expected) => assert_eq!(found, expected, "({x}, {y}), {spikes} spikes"),
                None => on_edges += 1,
            }
            inside += usize::from(found);
        }
        assert!(inside > 300 && on_edges > 300, "{inside} {on_edges}");
    }
}

#[test]
fn a_plate_with_many_holes() {
    let square = |x: i32, y: i32, size: i32| {
        vec![(x, y), (x + size, y), (x + size, y + size), (x, y + size)]
    };
    let mut rings = vec![square(0, 0, 101)];
    rings.extend((0..25).map(|i| square(i % 5 * 20 + 5, i / 5 * 20 + 5, 10)));
    let holes: Vec<_> = rings[1..].iter().map(|ring| flat(ring)).collect();
    let polygon = Polygon::try_with_holes(&flat(&rings[0]), &holes).expect("flat");
    assert!(polygon.runs.is_some());
    for (x, y) in (-1..=102).flat_map(|x| (-1..=102).map(move |y| (x, y))) {
        let found = hit(&polygon, &down(f64::from(x), f64::from(y))).is_some();
        if let Some(inside) = oracle(&rings, (x, y)) {
            assert_eq!(found, inside, "({x}, {y})");
        }
    }
}

#[test]
fn runs_and_projection_along_the_ray_agree() {
    // Slanted, with corners off the plane by as much as six digits leave them.
    let turn = Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 1.1);
    let mut random = Random::new(5);
    let corners: Vec<_> = star(40)
        .iter()
        .map(|&(x, y)| {
            turn.point_to_world(
                DVec3::new(f64::from(x), f64::from(y), random.between(-0.01, 0.01)) / 1e4,
            )
        })
        .collect();
    let long = Polygon::try_new(&corners).expect("flat enough");
    assert!(long.runs.is_some());
    let mut plain = long.clone();
    plain.runs = None;
    let mut hits = 0;
    for i in 0..40_000 {
        let k = random.below(80) as usize;
        let (a, b) = (corners[k], corners[(k + 1) % 80]);
        let target = match i % 3 {
            0 => a + (b - a) * random.between(0.0, 1.0),
            1 => a + (b - a) * 0.5 + random.cube() * 1e-15,
            _ => random.cube() * 3.0,
        };
        let origin = target + random.direction() * random.magnitude(-1.0, 4.0);
        let ray = Ray::new(origin, target - origin);
        let (fast, slow) = (hit(&long, &ray), hit(&plain, &ray));
        assert_eq!(fast.is_some(), slow.is_some(), "{ray:?}");
        hits += usize::from(fast.is_some());
    }
    assert!(hits > 10_000, "{hits}");
}

#[test]
fn exactly_one_of_two_neighbours_gets_a_ray_at_their_common_edge() {
    let mut random = Random::new(11);
    let (a, b) = (DVec3::new(0.1, 0.7, 0.3), DVec3::new(1.3, 0.2, 0.9));
    // Far beyond the edge's ends on both sides, in one plane and at an angle.
    let ahead = DVec3::new(-0.3, 1.1, 0.45);
    for behind in [
        -ahead,
        DVec3::new(0.2, -1.3, 0.8),
        DVec3::new(0.9, -0.2, -1.4),
    ] {
        let far = |way: DVec3| [b + way * 2.0 + (b - a), a + way * 2.0 - (b - a)];
        let [c, d] = far(ahead);
        let [e, f] = far(behind);
        let left = Polygon::try_new(&[a, b, c, d]).expect("flat");
        let right = Polygon::try_new(&[b, a, f, e]).expect("flat");
        for _ in 0..200_000 {
            let target = a + (b - a) * random.between(0.0, 1.0);
            // From a point that sees both side by side.
            let view =
                (ahead.cross(b - a).normalize() + behind.cross(a - b).normalize()).normalize();
            let origin = target + (view + random.cube() * 0.2) * random.magnitude(-2.0, 3.0);
            let ray = Ray::new(origin, target - origin);
            let count =
                usize::from(hit(&left, &ray).is_some()) + usize::from(hit(&right, &ray).is_some());
            assert_eq!(count, 1, "{ray:?}");
        }
    }
}

#[test]
fn fans_cover_convex_rings() {
    assert_eq!(
        fan_triangles(5).collect::<Vec<_>>(),
        [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
    );
    assert_eq!((fan_triangles(2).count(), fan_triangles(0).count()), (0, 0));
}

fn slanted(points: &[(i32, i32)], scale: f64) -> Vec<DVec3> {
    let turn = Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 1.1);
    flat(points)
        .iter()
        .map(|p| turn.point_to_world(*p * scale))
        .collect()
}

crate::primitive_tests!(concave, || Polygon::try_with_holes(
    &slanted(
        &[
            (0, 0),
            (9, 0),
            (9, 7),
            (6, 7),
            (6, 3),
            (3, 3),
            (3, 9),
            (0, 9)
        ],
        0.2
    ),
    &[slanted(&[(1, 1), (2, 1), (1, 2)], 0.2)],
)
.expect("flat"));
crate::primitive_tests!(spiky_star, || Polygon::try_new(&slanted(&star(72), 3e-5))
    .expect("flat"));
