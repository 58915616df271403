//! Groups used again.

use crate::common::{compiled, rendered};
use strahl_geometry::{Cuboid, Cylinder, Plane, Quadric, Sphere};
use strahl_math::{DVec3, Ray, Transform};
use strahl_render::{RayTree, RenderScene, TraceSettings, trace::TreeTracer};
use strahl_scene::{Camera, CsgOp, Object, ObjectExt, Scene};
use strahl_shade::{AreaLight, Color, Light, Material};

/// Where a ray meets the scene first.
fn first(scene: &RenderScene, origin: DVec3, direction: DVec3) -> Option<f64> {
    let mut tracer = TreeTracer::new(scene, TraceSettings::of(scene));
    let sample = tracer.trace(&Ray::new(origin, direction), &mut RayTree::default());
    sample.first.map(|first| first.distance)
}

#[test]
fn what_is_unbounded_shows_in_instances() {
    let mut scene = Scene::new();
    let ball = Sphere::new(DVec3::Y * 3.0, 1.0);
    let inner = scene.add_group(vec![Plane::new(DVec3::ZERO, DVec3::Y).into(), ball.into()]);
    let quarter = Object::csg(
        CsgOp::Intersection,
        vec![
            Plane::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)).into(),
            Plane::new(DVec3::ZERO, DVec3::new(-1.0, 1.0, 0.0)).into(),
        ],
    );
    let outer = scene.add_group(vec![
        Object::instance(inner).translated(DVec3::Y * 10.0),
        quarter,
    ]);
    let scene = scene
        .add(Object::instance(outer).translated(DVec3::X * 100.0))
        .add(Object::instance(inner).translated(DVec3::new(0.0, -50.0, 0.0)));
    let scene = compiled(&scene);
    let down = |x: f64, y: f64| first(&scene, DVec3::new(x, y, 0.0), DVec3::NEG_Y);
    // The ball and the plane below it, moved twice.
    assert_eq!(down(100.0, 20.0), Some(6.0));
    assert_eq!(down(5000.0, 20.0), Some(10.0));
    // The roof below that plane.
    assert_eq!(down(100.0, 5.0), Some(5.0));
    // The other plane, from above and from below.
    assert_eq!(down(1.0, 5.0), Some(55.0));
    assert_eq!(
        first(&scene, DVec3::new(-3.0, -60.0, 0.0), DVec3::Y),
        Some(10.0)
    );
    // Only what is bounded counts for the size.
    let bounds = scene.bounds();
    let error = (bounds.min.y + 48.0).abs() + (bounds.max.y - 14.0).abs();
    assert!(error < 1e-12, "{bounds:?}");
}

/// A block with a hole, a ball and an egg, beside two groups of the same kind, half as large and turned: `depth` groups within each other.
fn nested(depth: u32) -> Scene {
    let mut scene = Scene::new();
    let drilled = Object::csg(
        CsgOp::Difference,
        vec![
            Cuboid::new(DVec3::splat(-0.5), DVec3::splat(0.5)).into(),
            Cylinder::new(DVec3::Z * -2.0, DVec3::Z * 2.0, 0.3).into(),
        ],
    );
    let egg = Quadric::new([4.0, 1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25]);
    let shiny = Material::matte(Color::new(0.7, 0.5, 0.3)).with_reflection(Color::gray(0.4));
    let mut inner = None;
    for _ in 0..depth {
        let mut objects = vec![
            drilled.clone().material(shiny.clone()),
            Object::from(Sphere::new(DVec3::new(0.0, 0.9, 0.0), 0.4)).material(shiny.clone()),
            Object::from(egg.clone()).translated(DVec3::new(0.0, -1.1, 0.2)),
        ];
        if let Some(inner) = inner {
            for side in [-1.0, 1.0] {
                let turn = Transform::rotate(DVec3::new(0.3, 1.0, side), 0.4);
                let half = Transform::try_scale(DVec3::splat(0.6)).expect("regular");
                let place = Transform::translate(DVec3::new(1.1 * side, 0.2, -0.3));
                objects.push(Object::instance(inner).transformed(&half.then(&turn).then(&place)));
            }
        }
        inner = Some(scene.add_group(objects));
    }
    let mut lamp = Light::point(DVec3::new(3.0, 8.0, 6.0), Color::gray(0.6));
    lamp.area = Some(AreaLight {
        adaptive: Some(1),
        ..AreaLight::new(DVec3::X, DVec3::Z, 5, 5)
    });
    let eye = DVec3::new(0.5, 0.6, 5.0);
    scene
        .add(Object::instance(inner.expect("some levels")))
        .add(Plane::new(DVec3::Y * -2.0, DVec3::Y))
        .light(lamp)
        .light(Light::point(DVec3::new(-4.0, 3.0, 2.0), Color::gray(0.5)))
        .camera(Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9))
}

/// Ten groups within each other are more than packets go through.
#[test]
fn packets_go_into_instances() {
    for depth in [1, 3, 10] {
        let scene = compiled(&nested(depth));
        let [with, without] = [true, false].map(|packets| {
            rendered(&scene, |o| {
                (o.width, o.height) = (90, 61);
                o.trace.packets = packets;
            })
        });
        assert!(with.film == without.film && with.rays == without.rays);
        assert_ne!(with.traversal, without.traversal);
        let rays = with.rays;
        assert!(
            rays.primary_hit > 2000 && rays.reflection_hit > 100,
            "{rays:?}"
        );
    }
}
