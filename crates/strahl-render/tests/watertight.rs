//! No ray slips through between triangles: rays from inside a closed mesh, aimed as exactly as floats allow at points of its edges
//! and at its vertices, must hit it.
//!
//! `STRAHL_STRESS=10000000 cargo test --release -p strahl-render --test suite watertight` tries that many rays on each mesh.

use crate::common::compiled;
use std::collections::HashMap;
use strahl_geometry::{MeshData, Shape, TriangleMesh};
use strahl_math::{DVec3, Interval, Ray};
use strahl_render::{Intersector, RayClass, RenderScene};
use strahl_scene::{Object, Scene};

/// How many rays to try on each mesh.
fn rays() -> u32 {
    let asked = std::env::var("STRAHL_STRESS").ok();
    asked.map_or(10_000, |n| n.parse().expect("STRAHL_STRESS is a number"))
}

/// Numbers without pattern, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        // The multiplier of Knuth's MMIX.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 16
    }

    /// From 0 to 1.
    fn unit(&mut self) -> f64 {
        (self.next() & 0xffff_ffff) as f64 / 4_294_967_296.0
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0;
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// A closed mesh around the origin, seen from which every point is visible: an octahedron divided again and again, its vertices at
/// distances from 0.6 to 1 times `size`, and moved to `place`.
fn star(levels: u32, size: f64, place: DVec3) -> TriangleMesh {
    let mut points = vec![
        DVec3::X,
        DVec3::NEG_X,
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::NEG_Z,
    ];
    let mut triangles: Vec<[u32; 3]> = vec![];
    for (x, y, z) in (0..8).map(|i| (i & 1, (i >> 1) & 1, i >> 2)) {
        triangles.push([x, 2 + y, 4 + z]);
    }
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        let mut finer = vec![];
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let mut numbers = Numbers(1);
    for point in &mut points {
        *point = *point * (0.6 + 0.4 * numbers.unit()) * size + place;
    }
    TriangleMesh::try_new(MeshData::from_f64(&points, triangles)).expect("a mesh")
}

/// How many rays from inside a mesh at its edges and vertices miss it, or hit it far behind what they are aimed at.
fn lost(mesh: &TriangleMesh, scene: &RenderScene, place: DVec3, size: f64) -> u32 {
    let mut tracer = Intersector::new(scene);
    let mut numbers = Numbers(7);
    let mut lost = 0;
    for round in 0..rays() {
        let triangle = numbers.next() as u32 % mesh.triangle_count();
        let [a, b, _] = mesh.corners(triangle);
        let along = match round % 4 {
            0 => 0.0,
            1 => 0.5,
            _ => numbers.unit(),
        };
        let target = a + (b - a) * along;
        let origin = place + numbers.direction() * (0.05 * size * numbers.unit());
        let ray = Ray::new(origin, target - origin);
        let range = Interval::FORWARD;
        let hit = tracer.closest_hit(&ray, range, None, RayClass::Camera);
        let near = hit.is_some_and(|hit| hit.t <= 1.0 + 1e-3);
        let occluded = tracer.any_opaque(&ray, range, None);
        lost += u32::from(!near || !occluded);
    }
    lost
}

#[test]
fn no_ray_slips_through_an_edge() {
    let far = DVec3::new(1e9, -3e8, 7e8);
    for (levels, size, place) in [
        (1, 1.0, DVec3::ZERO),
        (5, 1.0, DVec3::ZERO),
        (5, 1e-6, DVec3::ZERO),
        (5, 1e9, DVec3::new(1.0, 2.0, 3.0)),
        (4, 1.0, DVec3::new(1000.0, 50.0, -2000.0)),
        (4, 1e-3, far),
    ] {
        let mesh = star(levels, size, place);
        let scene = compiled(&Scene::new().add(Object::from(Shape::from(mesh.clone()))));
        let lost = lost(&mesh, &scene, place, size);
        assert_eq!(lost, 0, "{levels} levels of size {size} at {place}");
    }
}

/// A scanned mesh of a few metres, given in the metres of a map.
#[test]
fn meshes_far_from_the_origin_cost_no_more_tests_than_those_near_it() {
    let tests = |places: &[DVec3]| {
        let meshes: Vec<_> = places.iter().map(|&p| star(5, 1.0, p)).collect();
        let scene = meshes.iter().fold(Scene::new(), |scene, mesh| {
            scene.add(Object::from(Shape::from(mesh.clone())))
        });
        let scene = compiled(&scene);
        let mut tracer = Intersector::new(&scene);
        let mut numbers = Numbers(3);
        for (&place, mesh) in places.iter().zip(&meshes) {
            for _ in 0..500 {
                let triangle = numbers.next() as u32 % mesh.triangle_count();
                let [a, b, c] = mesh.corners(triangle);
                let way = (a + b + c) / 3.0 - place;
                let ray = Ray::new(place + way * 1.5, -way);
                let hit = tracer.closest_hit(&ray, Interval::FORWARD, None, RayClass::Camera);
                let t = hit.map_or(f64::NAN, |hit| hit.t);
                assert!((t - 0.5).abs() < 1e-3, "{t} instead of 0.5 at {place}");
            }
        }
        tracer.stats.primitive_tests
    };
    let near = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 40.0];
    let place = DVec3::new(500_123.4, 5_412_345.6, 321.0);
    let few = tests(&near);
    let many = tests(&near.map(|p| p + place));
    assert!(many * 10 < few * 12, "{many} tests instead of {few}");
}
