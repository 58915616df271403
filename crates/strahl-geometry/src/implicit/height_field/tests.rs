use super::*;
use crate::conformance::Random;

/// A hilly field: sums of products that repeat nowhere.
fn hills(width: u32, depth: u32) -> Vec<u16> {
    let height = |i: u32, j: u32| {
        let (x, z) = (
            f64::from(i) / f64::from(width),
            f64::from(j) / f64::from(depth),
        );
        let wave = |t: f64| 4.0 * t * (1.0 - t);
        let ridge = ((x * 3.0).fract() - 0.5).abs() * ((z * 2.0).fract() - 0.5).abs();
        (65535.0 * (0.2 + 0.5 * wave(x) * wave(z) + ridge)) as u16
    };
    let vertices = (0..depth).flat_map(|j| (0..width).map(move |i| (i, j)));
    vertices.map(|(i, j)| height(i, j)).collect()
}

fn field(width: u32, depth: u32, water: f64, smooth: bool) -> HeightField {
    HeightField::try_new(width, depth, hills(width, depth), water, smooth).unwrap()
}

crate::primitive_tests!(hilly, || field(7, 5, 0.0, false));
crate::primitive_tests!(smoothed, || field(6, 9, 0.0, true));
crate::primitive_tests!(island, || field(8, 8, 0.4, false));

fn closest(field: &HeightField, origin: DVec3, direction: DVec3) -> Option<PrimHit> {
    let ray = Ray::new(origin, direction);
    field.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
}

#[test]
fn rows_and_heights_are_where_povray_has_them() {
    // Three columns, two rows; the first row is at z = 1.
    let rows = vec![65535, 0, 0, 0, 0, 32768];
    let field = HeightField::try_new(3, 2, rows, 0.0, false).unwrap();
    let height = |x, z| closest(&field, DVec3::new(x, 2.0, z), -DVec3::Y).map(|hit| 2.0 - hit.t);
    assert_eq!(height(0.0, 1.0), Some(65535.0 / 65536.0));
    assert_eq!(height(1.0, 0.0), Some(0.5));
    assert_eq!(height(0.5, 0.0), Some(0.0));
    // The diagonal goes from (1, 0) to (0, 1): halfway along it both its ends count.
    assert_eq!(height(0.75, 0.5), Some(0.25));
    assert_eq!(height(0.25, 0.5), Some(65535.0 / 131_072.0));
}

#[test]
fn every_triangle_is_found_as_without_the_pyramid() {
    let field = field(37, 23, 0.0, false);
    let surface = &field.body.0;
    let mut random = Random::new(5);
    let mut met = 0;
    for round in 0..6000 {
        let (from, to) = (random.cube() * 2.0, (random.cube() + DVec3::ONE) * 0.5);
        let (i, j) = (random.below(37) as u32, random.below(23) as u32);
        let vertex = surface.grid.vertex(i, j, surface.grid.height(i, j));
        let ray = match round % 4 {
            0 | 1 => Ray::new(from, (to - from) * random.magnitude(-2.0, 2.0)),
            // Steep ones at vertices, from near and from far away.
            2 => {
                let slant = from.with_y(0.0) * random.magnitude(-18.0, 0.0);
                let way = slant - DVec3::Y;
                Ray::new(vertex - way * random.magnitude(-1.0, 9.0), way)
            }
            // Straight down, along rows and columns, and from where numbers end.
            _ => {
                let axis = DVec3::AXES[random.below(3) as usize];
                let away = [0.5, 3.0, 1e9, 1e300, 1.7e308][random.below(5) as usize];
                Ray::new(
                    vertex + axis * away,
                    -axis * random.magnitude(-300.0, 300.0),
                )
            }
        };
        let shear = RayShear::new(&ray);
        let mut best: Option<(f64, u32)> = None;
        for element in 0..surface.triangles() {
            let [a, b, c] = surface
                .triangle(element)
                .map(|(i, j)| shear.apply(&surface.grid.vertex(i, j, surface.grid.height(i, j))));
            if let Some(hit) = intersect_sheared(&shear, a, b, c)
                && Interval::FORWARD.accepts(hit.t)
                && best.is_none_or(|best| hit.t < best.0)
            {
                best = Some((hit.t, element));
            }
        }
        let found = field.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
        assert_eq!(
            found.map(|hit| (hit.t, hit.surface.element)),
            best,
            "{ray:?}"
        );
        met += u32::from(best.is_some());
    }
    assert!(met > 3000, "{met}");
}

#[test]
fn no_ray_slips_through_edges_and_vertices() {
    let field = field(9, 9, 0.0, false);
    let surface = &field.body.0;
    for (i, j) in (1..8).flat_map(|i| (1..8).map(move |j| (i, j))) {
        let target = surface.grid.vertex(i, j, surface.grid.height(i, j));
        for from in [
            DVec3::new(0.3, 5.0, 0.1),
            DVec3::new(3.0, 4.0, -7.0),
            target + DVec3::Y,
        ] {
            for step in [
                DVec3::ZERO,
                DVec3::new(0.0625, 0.0, 0.0),
                DVec3::new(0.03125, 0.0, -0.03125),
            ] {
                let mut goal = target + step;
                goal.y = surface.grid.height_at(goal.x, goal.z);
                assert!(
                    closest(&field, from, goal - from).is_some(),
                    "{i} {j} {from} {goal}"
                );
            }
        }
    }
}

#[test]
fn below_the_water_is_no_surface_but_inside() {
    let rows = vec![0, 65535, 0, 65535];
    let field = HeightField::try_new(2, 2, rows, 0.25, false).unwrap();
    assert!(closest(&field, DVec3::new(0.2, 2.0, 0.5), -DVec3::Y).is_none());
    assert!(closest(&field, DVec3::new(0.3, 2.0, 0.5), -DVec3::Y).is_some());
    assert_eq!(field.bounds().min.y, 0.25);
    let solid = field.as_solid().unwrap();
    for (x, y, inside) in [
        (0.1, 0.2, true),
        (0.1, -100.0, true),
        (0.1, 0.26, false),
        (0.9, 0.8, true),
        (0.9, 0.95, false),
        (1.1, 0.0, false),
    ] {
        assert_eq!(solid.contains(DVec3::new(x, y, 0.5)), inside, "{x} {y}");
    }
}

#[test]
fn walls_and_water_are_crossed_unseen() {
    let rows = vec![0, 65535, 0, 65535];
    let field = HeightField::try_new(2, 2, rows, 0.25, false).unwrap();
    let solid = field.as_solid().unwrap();
    let list = |origin, direction| {
        let mut out = Crossings::default();
        let ray = Ray::new(origin, direction);
        solid.crossings(
            &ray,
            Interval::LINE,
            None,
            &mut Scratch::default(),
            &mut out,
        );
        let of = |c: &crate::Crossing| (c.hit.t, c.visible);
        (
            out.inside_at_start,
            out.list.iter().map(of).collect::<Vec<_>>(),
        )
    };
    use crate::Crossings;
    let down = list(DVec3::new(0.125, 1.0, 0.5), -DVec3::Y);
    assert_eq!(down, (false, vec![(0.75, false)]));
    let along = list(DVec3::new(-1.0, 0.125, 0.5), DVec3::X);
    assert_eq!(along, (false, vec![(1.0, false), (2.0, false)]));
    let up = list(DVec3::new(0.75, 0.0, 0.5), DVec3::Y);
    assert_eq!(up, (true, vec![(0.75 * (65535.0 / 65536.0), true)]));
}

#[test]
fn normals_between_vertices_are_those_measured() {
    let f = |x: f64, y: f64| 0.2 + 0.3 * x * x + 0.4 * y * y * x;
    let rows =
        (0..16).map(|k| (65535.0 * f(f64::from(k % 4) / 3.0, f64::from(k / 4) / 3.0)) as u16);
    let field = HeightField::try_new(4, 4, rows.collect(), 0.0, true).unwrap();
    for (x, z, expected) in [
        (0.4, 0.45, [-0.370091810, 0.910935268, 0.182288203]),
        (0.6, 0.6, [-0.402050134, 0.897596554, 0.180765364]),
        (0.1, 0.05, [-0.461442815, 0.884876892, 0.063744912]),
    ] {
        let ray = Ray::new(DVec3::new(x, 5.0, z), -DVec3::Y);
        let hit = closest(&field, ray.origin, ray.direction).unwrap();
        let off = field.surface_at(&ray, &hit).n_shade - DVec3::from_array(expected);
        assert!(off.length() < 1e-6, "{x} {z}: {off}");
    }
}

#[test]
fn smooth_normals_are_those_measured() {
    // Heights and normals of a field in POV-Ray 3.7, row by row with ascending z (without y of the normals).
    let rows = [
        [13107, 17845, 6560, 14410],
        [13107, 17366, 14424, 23456],
        [13107, 16474, 29423, 41234],
        [13107, 19338, 45802, 61234],
    ];
    let field = HeightField::try_new(4, 4, rows.concat(), 0.0, true).unwrap();
    let normals = field.body.0.normals.as_ref().unwrap().vertices();
    assert_eq!(normals[0][1], 5);
    assert_eq!(normals[4][1], 9);
    assert_eq!(normals[8][1], 7);
    assert_eq!(normals[12][1], 6);
    let [x, y, z] = normals[1].map(f64::from);
    assert!(
        y == 3.0 && (x / z + 31585.89 / 8718.246).abs() < 1e-3,
        "{:?}",
        normals[1]
    );
}

#[test]
fn what_is_no_field_is_refused() {
    let make = |width, depth, count| HeightField::try_new(width, depth, vec![0; count], 0.0, false);
    assert!(matches!(
        make(1, 5, 5),
        Err(GeometryError::OutOfRange { found: 1.0, .. })
    ));
    assert!(matches!(
        make(5, 0, 0),
        Err(GeometryError::OutOfRange { found: 0.0, .. })
    ));
    assert!(matches!(
        make(3, 3, 8),
        Err(GeometryError::WrongCount { .. })
    ));
    assert!(matches!(
        make(1 << 16, 1 << 16, 8),
        Err(GeometryError::OutOfRange { .. })
    ));
    assert!(HeightField::try_new(2, 2, vec![0; 4], f64::NAN, false).is_err());
    assert!(make(2, 2, 4).is_ok());
}
