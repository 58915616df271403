use super::*;
use crate::conformance::Random;

/// Samples of a function of the place of the sample.
fn sampled(samples: [u32; 3], options: GridOptions, f: impl Fn(DVec3) -> f64) -> GridIsosurface {
    let [x, y, z] = samples;
    let mut values = vec![];
    for i in 0..x {
        for j in 0..y {
            for k in 0..z {
                values.push(f(DVec3::new(f64::from(i), f64::from(j), f64::from(k))) as f32);
            }
        }
    }
    GridIsosurface::try_new(samples, values, options).unwrap()
}

/// A ball with bumps, which touches no wall.
fn bumpy(open: bool, smooth: bool) -> GridIsosurface {
    let options = GridOptions {
        level: 0.1,
        inside_below: true,
        open,
        smooth,
    };
    sampled([9, 8, 10], options, |p| {
        let q = p - DVec3::new(4.1, 3.4, 4.6);
        q.length() - 2.7 + 0.3 * ((p.x * 0.37).fract() - 0.5) * ((p.z * 0.71).fract())
    })
}

/// Hills that are cut by the walls.
fn cut(open: bool) -> GridIsosurface {
    let options = GridOptions {
        level: 0.35,
        open,
        ..GridOptions::default()
    };
    sampled([5, 4, 3], options, |p| {
        ((p.x * 0.37 + p.y * 0.59).fract() - 0.5) + (p.z * 0.83 + p.x * 0.21).fract() * 0.7
    })
}

crate::primitive_tests!(bumps, || bumpy(false, false));
crate::primitive_tests!(smooth_bumps, || bumpy(false, true));
crate::primitive_tests!(cut_by_walls, || cut(false));
crate::primitive_tests!(open_at_walls, || cut(true));

fn closest(shape: &GridIsosurface, ray: &Ray) -> Option<PrimHit> {
    shape.closest_hit(ray, Interval::FORWARD, None, &mut Scratch::default())
}

#[test]
fn a_linear_function_gives_a_plane() {
    let normal = DVec3::new(0.25, 0.5, -0.125);
    let options = GridOptions {
        level: 1.5,
        inside_below: true,
        ..GridOptions::default()
    };
    let shape = sampled([7, 6, 5], options, |p| p.dot(normal));
    let mut random = Random::new(3);
    for _ in 0..2000 {
        let origin = DVec3::new(3.0, 12.0, 2.0) + random.cube() * 2.0;
        let target = DVec3::new(3.0, 2.0, 2.0) + random.cube() * 0.5;
        let ray = Ray::new(origin, target - origin);
        let t = (1.5 - origin.dot(normal)) / ray.direction.dot(normal);
        let p = ray.at(t);
        if p.cmplt(DVec3::ONE * 0.01).any() || p.cmpgt(DVec3::new(5.99, 4.99, 3.99)).any() {
            continue;
        }
        let hit = closest(&shape, &ray).unwrap();
        assert!((hit.t - t).abs() < 1e-14, "{} {t}", hit.t);
        let surface = shape.surface_at(&ray, &hit);
        assert!((surface.n_geom - normal.normalize()).length() < 1e-12);
    }
}

#[test]
fn a_product_is_met_exactly() {
    // Along the diagonal xyz is t³.
    let options = GridOptions {
        level: 10.0,
        ..GridOptions::default()
    };
    let shape = sampled([5, 5, 5], options, |p| p.x * p.y * p.z);
    let ray = Ray::new(DVec3::splat(0.25), DVec3::ONE);
    let hit = closest(&shape, &ray).unwrap();
    assert!((hit.t + 0.25 - 10f64.cbrt()).abs() < 1e-14, "{}", hit.t);
}

#[test]
fn a_sphere_is_as_near_as_its_interpolation() {
    // Linear interpolation is off by at most 1/8 of the second derivative, along each axis.
    let (center, radius) = (DVec3::splat(16.0), 12.3);
    let options = GridOptions {
        level: radius,
        inside_below: true,
        ..GridOptions::default()
    };
    let shape = sampled([33; 3], options, |p| (p - center).length());
    let mut random = Random::new(8);
    for _ in 0..5000 {
        let origin = center + random.direction() * 30.0;
        let target = center + random.direction() * 0.9 * radius * random.unit();
        let ray = Ray::new(origin, (target - origin).normalize());
        let hit = closest(&shape, &ray).unwrap();
        let off = (ray.at(hit.t) - center).length() - radius;
        let largest = 3.0 / 8.0 / (radius - 2.0);
        assert!(off.abs() < largest, "{off}");
        let normal = shape.surface_at(&ray, &hit).n_geom;
        assert!(normal.dot((ray.at(hit.t) - center) / radius) > 0.98);
    }
}

#[test]
fn no_ray_slips_through_faces_edges_and_corners() {
    let shape = bumpy(false, false);
    let center = DVec3::new(4.0, 3.0, 5.0);
    assert!(shape.contains(center));
    let mut random = Random::new(4);
    for round in 0..20000 {
        // Through points with whole and half coordinates, which are on faces, edges and corners.
        let mut goal = (random.cube() * 9.0 + DVec3::splat(4.5)).round();
        if round % 2 == 0 {
            goal += DVec3::new(0.5, 0.0, 0.0);
        }
        let direction = goal - center;
        if direction == DVec3::ZERO {
            continue;
        }
        for ray in [
            Ray::new(center, direction),
            Ray::new(center + direction * 16.0, -direction),
        ] {
            let hit = closest(&shape, &ray);
            assert!(hit.is_some_and(|hit| hit.surface == SURFACE), "{ray:?}");
        }
    }
}

#[test]
fn the_pyramid_changes_nothing() {
    // Among few blocks and among many: one grid is a part of the other.
    let f = |p: DVec3| ((p.x * 0.31).fract() - 0.4) * ((p.y * 0.43).fract() - 0.6) - p.z * 0.01;
    let options = GridOptions::default();
    let small = sampled([6, 6, 6], options, f);
    let large = sampled([23, 19, 6], options, f);
    let mut random = Random::new(6);
    let mut hits = 0;
    for _ in 0..3000 {
        let target = DVec3::splat(2.5) + random.cube() * 2.0;
        let origin = DVec3::splat(2.5) + random.cube() * 2.4;
        let ray = Ray::new(origin, target - origin);
        // Within both grids.
        let range = Interval::new(0.0, 1.0);
        let find = |shape: &GridIsosurface| {
            let hit = shape.closest_hit(&ray, range, None, &mut Scratch::default());
            hit.map(|hit| hit.t)
        };
        let (a, b) = (find(&small), find(&large));
        match (a, b) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-12, "{ray:?} {a} {b}"),
            (a, b) => assert_eq!(a, b, "{ray:?}"),
        }
        hits += usize::from(a.is_some());
    }
    assert!(hits > 300, "{hits}");
}

#[test]
fn what_is_no_grid_is_refused() {
    let make = |samples, values| {
        let options = GridOptions {
            level: 0.5,
            ..GridOptions::default()
        };
        GridIsosurface::try_new(samples, values, options)
    };
    assert!(make([2, 2, 2], vec![1.0; 8]).is_ok());
    let few = make([1, 2, 2], vec![1.0; 4]);
    assert!(matches!(
        few,
        Err(GeometryError::OutOfRange { found: 1.0, .. })
    ));
    let short = make([2, 2, 2], vec![1.0; 7]);
    assert!(matches!(
        short,
        Err(GeometryError::WrongCount { expected: 8, .. })
    ));
    let mut values = vec![1.0; 8];
    values[5] = f32::NAN;
    let bad = make([2, 2, 2], values);
    assert!(matches!(
        bad,
        Err(GeometryError::NotFiniteAt { index: 5, .. })
    ));
    let empty = make([2, 2, 2], vec![0.25; 8]);
    assert!(matches!(empty, Err(GeometryError::Degenerate { .. })));
    let huge = make([1 << 30; 3], vec![]);
    assert!(matches!(huge, Err(GeometryError::WrongCount { .. })));
}
