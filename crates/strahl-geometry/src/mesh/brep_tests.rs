use super::samples::{Unbaked, cube, icosphere, torus};
use super::{Brep, MeshData, Polygon, TriangleMesh};
use crate::conformance::Random;
use crate::{Crossings, GeometryError, Primitive, Scratch, Side, Solid};
use std::sync::Arc;
use strahl_math::{DVec3, Interval, Ray, Transform};

fn solid(data: MeshData) -> Brep {
    Brep::try_new(TriangleMesh::try_new(data).expect("a mesh")).expect("closed")
}

fn crossings(brep: &Brep, ray: &Ray, range: Interval) -> Crossings {
    let mut out = Crossings::default();
    brep.crossings(ray, range, None, &mut Scratch::default(), &mut out);
    out
}

fn joined(a: MeshData, b: MeshData) -> MeshData {
    let start = a.positions.len() as u32;
    MeshData {
        positions: [a.positions, b.positions].concat(),
        indices: a
            .indices
            .into_iter()
            .chain(b.indices.into_iter().map(|t| t.map(|v| v + start)))
            .collect(),
        ..MeshData::default()
    }
}

fn moved(mut data: MeshData, offset: f32, scale: f32) -> MeshData {
    for p in data.positions.iter_mut().flatten() {
        *p = *p * scale + offset;
    }
    data
}

fn reversed(mut data: MeshData) -> MeshData {
    data.indices.iter_mut().for_each(|t| t.swap(0, 1));
    data
}

#[test]
fn open_and_inconsistent_meshes_are_refused() {
    let error = |data| {
        Brep::try_new(TriangleMesh::try_new(data).expect("a mesh"))
            .expect_err("not closed")
            .to_string()
    };
    let mut open = cube();
    open.indices.remove(0);
    assert_eq!(
        error(open),
        "brep is not closed: 3 edges have no counterpart in the other direction, the first is that from vertex 4 to vertex 0"
    );
    let mut inconsistent = cube();
    inconsistent.indices[0].swap(0, 1);
    assert!(error(inconsistent).contains("6 edges have no counterpart"));
    let flat = MeshData {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        indices: vec![[0, 1, 2], [0, 2, 1]],
        ..MeshData::default()
    };
    assert_eq!(error(flat), "the brep is degenerate: it encloses no volume");
}

#[test]
fn a_mesh_that_is_inside_out_is_turned() {
    for data in [cube(), reversed(cube())] {
        let brep = solid(data);
        let ray = Ray::new(DVec3::new(0.25, 0.5, -4.0), DVec3::Z);
        let list = crossings(&brep, &ray, Interval::LINE);
        let found: Vec<_> = list.list.iter().map(|c| (c.hit.t, c.side)).collect();
        assert_eq!(found, [(3.0, Side::Enter), (5.0, Side::Exit)]);
        assert_eq!(brep.surface_at(&ray, &list.list[0].hit).n_geom, -DVec3::Z);
        assert!(crossings(&brep, &ray, Interval::new(3.5, 4.5)).inside_at_start);
    }
}

#[test]
fn baking_a_mirror_keeps_the_inside() {
    let map = Transform::try_scale(DVec3::new(-1.0, 2.0, 0.5)).expect("regular");
    let brep = solid(torus(12, 8, 2.0, 0.7))
        .baked(&map)
        .expect("any map will do");
    let brep = brep.as_solid().expect("a solid");
    assert!(brep.contains(DVec3::new(2.0, 0.0, 0.0)) && !brep.contains(DVec3::ZERO));
    let ray = Ray::new(DVec3::new(-9.0, 0.1, 0.01), DVec3::X);
    let hit = brep
        .closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
        .expect("a hit");
    assert!(brep.surface_at(&ray, &hit).n_geom.x < -0.5);
}

#[test]
fn overlapping_parts_unite_and_reversed_shells_are_cavities() {
    let ray = Ray::new(DVec3::new(-9.0, 0.3, 0.4), DVec3::X);
    let sides = |brep: &Brep| {
        let list = crossings(brep, &ray, Interval::LINE);
        list.list
            .iter()
            .map(|c| (c.hit.t, c.side))
            .collect::<Vec<_>>()
    };
    // Cubes from -1 to 1 and from -0.5 to 1.5.
    let overlapping = solid(joined(cube(), moved(cube(), 0.5, 1.0)));
    assert_eq!(
        sides(&overlapping),
        [
            (8.0, Side::Enter),
            (8.5, Side::Inner),
            (10.0, Side::Inner),
            (10.5, Side::Exit)
        ]
    );
    assert!(overlapping.contains(DVec3::ZERO) && overlapping.contains(DVec3::splat(1.25)));
    let hollow = solid(joined(moved(cube(), 0.0, 2.0), reversed(cube())));
    assert_eq!(
        sides(&hollow),
        [
            (7.0, Side::Enter),
            (8.0, Side::Exit),
            (10.0, Side::Enter),
            (11.0, Side::Exit)
        ]
    );
    assert!(!hollow.contains(DVec3::ZERO) && hollow.contains(DVec3::splat(1.5)));
}

/// Checks that crossings alternate and pair up, whatever the ray grazes.
fn assert_alternating(brep: &Brep, ray: &Ray) -> usize {
    let list = crossings(brep, ray, Interval::LINE);
    let mut inside = false;
    for crossing in &list.list {
        match crossing.side {
            Side::Enter => assert!(!std::mem::replace(&mut inside, true), "{ray:?} {list:?}"),
            Side::Exit => assert!(std::mem::replace(&mut inside, false), "{ray:?} {list:?}"),
            Side::Inner => {}
        }
        assert!(crossing.t_error.is_finite() && crossing.t_error >= 0.0);
    }
    assert!(!inside && !list.inside_at_start, "{ray:?} {list:?}");
    list.list.len()
}

#[test]
fn rays_along_edges_and_through_corners_alternate() {
    let mut random = Random::new(5);
    let meshes = [
        cube(),
        torus(16, 8, 1.0, 0.4),
        icosphere(2, 0.0),
        icosphere(2, 0.1),
        moved(torus(8, 8, 2.0, 1.0), 100.0, 1.0),
    ];
    for data in meshes {
        let brep = solid(data);
        let count = u64::from(brep.mesh().triangle_count());
        let mut crossed = 0;
        for _ in 0..60_000 {
            let mut seam = || {
                let corners = brep.mesh().corners(random.below(count) as u32);
                let k = random.below(3) as usize;
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let part = [0.0, 0.5, random.unit()][random.below(3) as usize];
                (a + (b - a) * part, b - a)
            };
            // From seam to seam, along an edge, or past a seam.
            let ((p, edge), (q, _)) = (seam(), seam());
            let direction = match random.below(4) {
                0 => edge,
                1 => random.direction(),
                _ => q - p,
            };
            if direction != DVec3::ZERO {
                let origin =
                    p - direction * [0.0, 1.0, random.between(-2.0, 9.0)][random.below(3) as usize];
                crossed += assert_alternating(&brep, &Ray::new(origin, direction));
            }
        }
        assert!(crossed > 60_000, "{crossed}");
    }
}

#[test]
fn contains_agrees_with_what_is_known() {
    let mut random = Random::new(6);
    let (cube, ring) = (solid(cube()), solid(torus(64, 32, 1.0, 0.4)));
    let ball = solid(icosphere(4, 0.0));
    let mut inside = [0; 3];
    for _ in 0..20_000 {
        let p = random.cube() * 1.5;
        let in_cube = p.abs().max_element() <= 1.0;
        assert_eq!(cube.contains(p), in_cube, "{p}");
        inside[0] += usize::from(in_cube);
        // Facets keep within these distances of the round surfaces.
        let tube = (p.truncate().length() - 1.0).hypot(p.z);
        if !(0.39..=0.401).contains(&tube) {
            assert_eq!(ring.contains(p), tube < 0.4, "{p}");
            inside[1] += usize::from(tube < 0.4);
        }
        if !(0.99..=1.001).contains(&p.length()) {
            assert_eq!(ball.contains(p), p.length() < 1.0, "{p}");
            inside[2] += usize::from(p.length() < 1.0);
        }
    }
    assert!(inside.iter().all(|&n| n > 1_500), "{inside:?}");
}

#[test]
fn the_boundary_belongs_to_the_solid() {
    let mut random = Random::new(8);
    for brep in [
        solid(cube()),
        solid(torus(16, 8, 1.0, 0.4)),
        solid(moved(cube(), 1000.0, 1e-2)),
    ] {
        for i in 0..3_000 {
            let triangle = random.below(brep.mesh().triangle_count().into()) as u32;
            let [a, b, c] = brep.mesh().corners(triangle);
            let u = random.unit();
            let v = random.between(0.0, 1.0 - u);
            let point = match i % 3 {
                0 => a,
                1 => a + (b - a) * u,
                _ => a + (b - a) * u + (c - a) * v,
            };
            // Rounding may put a point of the surface out of the box.
            let point = point.clamp(brep.bounds().min, brep.bounds().max);
            assert!(brep.contains(point), "{point}");
        }
    }
}

#[test]
fn crossings_and_contains_agree_along_rays() {
    let mut random = Random::new(9);
    for brep in [solid(torus(20, 10, 1.0, 0.4)), solid(icosphere(3, 0.2))] {
        for _ in 0..5_000 {
            let (origin, target) = (random.direction() * 3.0, random.cube());
            let ray = Ray::new(origin, target - origin);
            let list = crossings(&brep, &ray, Interval::LINE);
            for _ in 0..4 {
                let t = random.between(0.0, 2.0);
                if list.list.iter().all(|c| (c.hit.t - t).abs() > 1e-9) {
                    assert_eq!(
                        brep.contains(ray.at(t)),
                        list.inside_after(t),
                        "{ray:?} {t}"
                    );
                }
            }
        }
    }
}

#[test]
fn polygons_make_a_solid() {
    let at = |i: [i32; 3]| DVec3::from(i.map(f64::from)) * 0.1;
    let quad = |corners: [[i32; 3]; 4]| Polygon::try_new(&corners.map(at)).expect("flat");
    // A box with a square tunnel along z, as STEP and CAD files describe it.
    let outer = [[0, 0], [8, 0], [8, 8], [0, 8]];
    let inner = [[2, 2], [2, 6], [6, 6], [6, 2]];
    let lift = |ring: [[i32; 2]; 4], z: i32| ring.map(|[x, y]| at([x, y, z])).to_vec();
    let top = Polygon::try_with_holes(&lift(outer, 5), &[lift(inner, 5)]).expect("flat");
    let mut bottom_ring = lift(outer, 0);
    bottom_ring.reverse();
    let bottom = Polygon::try_with_holes(&bottom_ring, &[lift(inner, 0)]).expect("flat");
    let mut faces = vec![top, bottom];
    for ring in [outer, inner] {
        for k in 0..4 {
            let ([ax, ay], [bx, by]) = (ring[k], ring[(k + 1) % 4]);
            faces.push(quad([[ax, ay, 0], [bx, by, 0], [bx, by, 5], [ax, ay, 5]]));
        }
    }
    let brep = Brep::try_from_polygons(&faces).expect("closed");
    assert_eq!(brep.mesh().positions().len(), 16);
    assert!(brep.contains(at([1, 1, 1])) && !brep.contains(at([4, 4, 2])));
    let ray = Ray::new(DVec3::new(-1.0, 0.35, 0.22), DVec3::X);
    let list = crossings(&brep, &ray, Interval::LINE);
    let found: Vec<_> = list
        .list
        .iter()
        .map(|c| (c.hit.t * 10.0).round() as i32)
        .collect();
    assert_eq!(found, [10, 12, 16, 18]);

    faces.pop();
    assert!(matches!(
        Brep::try_from_polygons(&faces),
        Err(GeometryError::NotClosed { .. })
    ));
}

#[test]
fn a_ray_leaves_its_own_triangle() {
    let brep = solid(cube());
    let ray = Ray::new(DVec3::new(0.25, 0.5, -4.0), DVec3::Z);
    let scratch = &mut Scratch::default();
    let hit = brep
        .closest_hit(&ray, Interval::FORWARD, None, scratch)
        .expect("a hit");
    let surface = brep.surface_at(&ray, &hit);
    for (direction, inside) in [(DVec3::Z, true), (-DVec3::Z, false)] {
        let mut out = Crossings::default();
        let leaving = Ray::new(surface.position, direction);
        brep.crossings(
            &leaving,
            Interval::LINE,
            Some(hit.surface),
            scratch,
            &mut out,
        );
        assert_eq!(out.inside_at_start, inside);
        assert_eq!(out.list.len(), usize::from(inside));
    }
}

fn unbaked(data: MeshData) -> Unbaked {
    Unbaked(Arc::new(solid(data)))
}

crate::primitive_tests!(cube_brep, || unbaked(cube()));
crate::primitive_tests!(torus_brep, || unbaked(torus(16, 8, 1.0, 0.4)));
crate::primitive_tests!(ball_brep, || unbaked(icosphere(3, 0.05)));
