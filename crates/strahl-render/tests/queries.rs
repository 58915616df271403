//! Rays and points asked one by one or by the thousand.

use crate::common::{every_shape, glass_and_mirrors};
use std::sync::Arc;
use strahl_geometry::{Cuboid, Cylinder, MeshData, Plane, Sphere, TriangleMesh};
use strahl_math::{DVec3, Interval, Ray, Transform};
use strahl_render::{
    CompileOptions, Hit, Intersector, Output, RayClass, RenderScene, Session, Threads,
};
use strahl_scene::{CsgOp, Object, ObjectExt, Scene};
use strahl_shade::{Color, Material};

fn compile(session: &Session, description: &Scene) -> Arc<RenderScene> {
    let (scene, _) = session
        .compile(description, &CompileOptions::default())
        .expect("a valid scene");
    scene
}

fn session() -> Session {
    Session::new(Threads::Count(2)).expect("threads")
}

/// Numbers in -1..1 that look random.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) * size
    }
}

/// Rays in all directions, and rays of a camera, which are alike.
fn rays(scene: &Arc<RenderScene>) -> Vec<Ray> {
    let mut numbers = Numbers(7);
    let mut rays: Vec<Ray> = (0..3000)
        .map(|_| Ray::new(numbers.point(6.0), numbers.point(2.0)))
        .collect();
    let camera = scene.view(80, 50).rays().expect("a camera");
    for y in 0..50 {
        let row = (0..80).filter_map(|x| camera.ray(f64::from(x), f64::from(y)));
        rays.extend(row);
    }
    rays
}

#[test]
fn many_rays_are_answered_like_single_ones() {
    let session = session();
    for description in [glass_and_mirrors(), every_shape()] {
        let scene = compile(&session, &description);
        let rays = rays(&scene);
        for range in [Interval::FORWARD, Interval::new(0.5, 3.0)] {
            let mut tracer = Intersector::new(&scene);
            let single: Vec<Option<Hit>> = rays
                .iter()
                .map(|ray| tracer.closest_hit(ray, range, None, RayClass::Camera))
                .collect();
            let opaque: Vec<bool> = rays
                .iter()
                .map(|ray| tracer.any_opaque(ray, range, None))
                .collect();
            // All at once, and so few that one thread answers.
            for rays in [&rays[..], &rays[..700]] {
                let mut hits = vec![None; rays.len()];
                session.closest_hits(&scene, rays, range, &mut hits);
                assert!(hits == single[..rays.len()]);
                let mut occluded = vec![false; rays.len()];
                session.occluded(&scene, rays, range, &mut occluded);
                assert!(occluded == opaque[..rays.len()]);
            }
            let count = single.iter().flatten().count();
            assert!(20 < count && count < single.len(), "{count}");
            assert!(opaque.contains(&true) && opaque.contains(&false));
            assert!(single.iter().flatten().all(|hit| range.accepts(hit.t)));
        }
    }
}

#[test]
fn points_are_inside_of_solids() {
    let session = session();
    let drilled = Object::csg(
        CsgOp::Difference,
        vec![
            Cuboid::new(DVec3::splat(-1.0), DVec3::splat(1.0)).into(),
            Cylinder::new(DVec3::Y * -2.0, DVec3::Y * 2.0, 0.5).into(),
        ],
    );
    let corners = [DVec3::X * 20.0, DVec3::Y * 20.0, DVec3::Z * 20.0];
    let mesh =
        TriangleMesh::try_new(MeshData::from_f64(&corners, vec![[0, 1, 2]])).expect("a triangle");
    let mut description = Scene::new()
        .add(Plane::new(DVec3::Y * -3.0, DVec3::Y).named("ground"))
        .add(drilled.named("drilled"))
        .add(Sphere::new(DVec3::X * 4.0, 1.0).named("first"))
        .add(
            Object::from(Sphere::new(DVec3::ZERO, 1.0))
                .transformed(
                    &Transform::try_scale(DVec3::new(1.0, 3.0, 1.0))
                        .expect("not flat")
                        .then(&Transform::translate(DVec3::X * 4.5)),
                )
                .named("egg"),
        );
    description = description.add(Object::from(mesh));
    // Enough of them for the structure to matter.
    for n in 0..500 {
        let center = DVec3::new(f64::from(n % 25), 10.0 + f64::from(n / 25), 7.0);
        description = description.add(Sphere::new(center, 0.25));
    }
    let scene = compile(&session, &description);
    let name = |object: Option<u32>| {
        object.map(|o| {
            scene
                .objects()
                .get(o)
                .expect("an object")
                .name
                .map_or_else(String::new, |n| n.to_string())
        })
    };
    let expected = |p: DVec3| -> Option<&str> {
        let egg = (p - DVec3::X * 4.5) * DVec3::new(1.0, 1.0 / 3.0, 1.0);
        let round = DVec3::new(p.x, 0.0, p.z).length() < 0.5;
        let lattice = DVec3::new(
            p.x.round().clamp(0.0, 24.0),
            p.y.round().clamp(10.0, 29.0),
            7.0,
        );
        if (p - lattice).length() < 0.25 {
            Some("")
        } else if egg.length() < 1.0 {
            Some("egg")
        } else if (p - DVec3::X * 4.0).length() < 1.0 {
            Some("first")
        } else if p.abs().max_element() < 1.0 && !round {
            Some("drilled")
        } else if p.y < -3.0 {
            Some("ground")
        } else {
            None
        }
    };
    let mut numbers = Numbers(3);
    let mut points: Vec<DVec3> = (0..5000).map(|_| numbers.point(6.0)).collect();
    points.extend((0..5000).map(|_| numbers.point(4.0) + DVec3::new(12.0, 15.0, 7.0)));
    points.push(DVec3::splat(f64::NAN));
    let mut answers = vec![None; points.len()];
    session.inside(&scene, &points, &mut answers);
    let mut seen = vec![];
    for (point, answer) in points.iter().zip(&answers) {
        let answer = name(*answer);
        assert_eq!(answer.as_deref(), expected(*point), "{point}");
        seen.push(answer);
    }
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), 6, "{seen:?}");
    // A single point, and none.
    let mut answer = [None];
    session.inside(&scene, &[DVec3::X * 4.0], &mut answer);
    assert_eq!(name(answer[0]).as_deref(), Some("egg"));
    session.inside(&scene, &[], &mut []);
}

#[test]
fn hits_are_described() {
    let session = session();
    let description = Scene::new().add(Plane::new(DVec3::Y * -1.0, DVec3::Y)).add(
        Sphere::new(DVec3::ZERO, 1.0)
            .material(Material::matte(Color::WHITE).named("chalk"))
            .named("ball"),
    );
    let scene = compile(&session, &description);
    let ray = Ray::new(DVec3::Z * 5.0, DVec3::NEG_Z * 2.0);
    let mut hits = [None];
    session.closest_hits(&scene, &[ray], Interval::FORWARD, &mut hits);
    let info = scene.describe(&ray, &hits[0].expect("the ball"));
    assert_eq!(
        (info.t, info.name.as_deref(), info.kind),
        (2.0, Some("ball"), "sphere")
    );
    assert_eq!(
        (info.position, info.normal, info.shading_normal),
        (DVec3::Z, DVec3::Z, DVec3::Z)
    );
    assert_eq!(scene.material_name(info.material), "material \"chalk\"");
    assert_eq!((info.object, info.element), (1, 1));
    assert_eq!(scene.object_name(info.object), "sphere \"ball\"");
}

/// Questions may be asked while a picture is rendered, also by its sink.
#[test]
fn a_sink_may_ask() {
    let session = Session::new(Threads::Count(1)).expect("a thread");
    let scene = compile(&session, &glass_and_mirrors());
    let rays = rays(&scene);
    let mut alone = vec![None; rays.len()];
    session.closest_hits(&scene, &rays, Interval::FORWARD, &mut alone);
    let mut asked = 0;
    let outcome = session.render(
        &scene.view(64, 64),
        &Output::default(),
        &mut |_: &strahl_render::Tile<'_>| {
            let mut hits = vec![None; rays.len()];
            session.closest_hits(&scene, &rays, Interval::FORWARD, &mut hits);
            assert!(hits == alone);
            asked += 1;
            std::ops::ControlFlow::Continue(())
        },
    );
    assert!(outcome.expect("renders").finished().is_some());
    assert_eq!(asked, 4);
}

#[test]
#[should_panic(expected = "one answer for each question")]
fn lists_are_equally_long() {
    let session = session();
    let scene = compile(&session, &glass_and_mirrors());
    session.inside(&scene, &[DVec3::ZERO], &mut []);
}

#[test]
fn surfaces_of_many_hits_are_those_that_describe_names() {
    let session = session();
    for description in [glass_and_mirrors(), every_shape()] {
        let scene = compile(&session, &description);
        let rays = rays(&scene);
        let mut hits = vec![None; rays.len()];
        session.closest_hits(&scene, &rays, Interval::FORWARD, &mut hits);
        // All at once, and so few that one thread answers.
        for first in [0, rays.len() - 700] {
            let (rays, hits) = (&rays[first..], &hits[first..]);
            let mut surfaces = vec![None; rays.len()];
            session.surfaces(&scene, rays, hits, &mut surfaces);
            for ((ray, hit), surface) in rays.iter().zip(hits).zip(&surfaces) {
                assert_eq!(hit.is_some(), surface.is_some());
                let (Some(hit), Some(surface)) = (hit, surface) else {
                    continue;
                };
                assert_eq!(*surface, scene.surface(ray, hit));
                let info = scene.describe(ray, hit);
                assert_eq!(
                    (info.object, info.material, info.position, info.normal),
                    (
                        surface.object,
                        surface.material,
                        surface.position,
                        surface.normal
                    )
                );
                assert_eq!(
                    (info.shading_normal, info.uv),
                    (surface.shading_normal, surface.uv)
                );
                let size = ray.origin.length() + (ray.direction * hit.t).length();
                assert!((surface.position - ray.at(hit.t)).length() < 1e-6 * size);
                assert!((surface.normal.length() - 1.0).abs() < 1e-12);
            }
            let found = surfaces.iter().flatten().count();
            assert!(found > 20, "{found} of {}", rays.len());
        }
    }
    // A sphere says where the numbers come from.
    let blue = Material::matte(Color::new(0.0, 0.0, 1.0));
    let description = Scene::new()
        .add(Plane::new(DVec3::Y * -9.0, DVec3::Y))
        .add(Sphere::new(DVec3::ZERO, 2.0).material(blue));
    let scene = compile(&session, &description);
    let ray = [Ray::new(DVec3::Z * 5.0, -DVec3::Z)];
    let (mut hit, mut surface) = ([None], [None]);
    session.closest_hits(&scene, &ray, Interval::FORWARD, &mut hit);
    session.surfaces(&scene, &ray, &hit, &mut surface);
    let surface = surface[0].expect("a hit");
    assert_eq!((surface.object, surface.position), (1, DVec3::Z * 2.0));
    assert_eq!(surface.normal, DVec3::Z);
}

#[test]
fn lists_are_in_order_on_any_number_of_threads() {
    for threads in [Threads::Count(1), Threads::Count(3)] {
        let session = Session::new(threads).expect("threads");
        for count in [0, 7, 1024, 100_003] {
            let squares = session.list(count, |i| i * i);
            assert!(
                squares
                    .iter()
                    .enumerate()
                    .all(|(i, square)| *square == i * i)
            );
            assert_eq!(squares.len(), count);
        }
    }
}
