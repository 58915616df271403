//! Groups used again.

mod common;

use common::compiled;
use strahl_geometry::{Plane, Sphere};
use strahl_math::{DVec3, Ray};
use strahl_render::{RayTree, RenderScene, TraceSettings, trace::TreeTracer};
use strahl_scene::{CsgOp, Object, ObjectExt, Scene};

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
