//! Rays that leave a sphere along its surface: rounding must not decide differently in the block of an accelerator's leaf and in the
//! sphere's own test.

use strahl_accel::AcceleratorKind;
use strahl_geometry::Sphere;
use strahl_math::{DVec3, Interval, Ray};
use strahl_render::{Intersector, Origin, Prepared, RayClass, RenderScene};
use strahl_scene::{Object, Scene};

#[test]
fn rays_that_graze_what_they_start_on_meet_the_same_with_every_accelerator() {
    let mut scene = Scene::new();
    for i in 0..40 {
        let place = DVec3::new(f64::from(i % 7), f64::from(i % 5), f64::from(i % 3)) * 1.7;
        scene = scene.add(Object::from(Sphere::new(place, 0.9 + 0.01 * f64::from(i))));
    }
    let prepared = Prepared::new(&scene).expect("valid");
    let scenes: Vec<RenderScene> = AcceleratorKind::ALL
        .iter()
        .map(|kind| prepared.clone().build(*kind))
        .collect();
    let (mut again, mut all) = (0, 0);
    for i in 0..40u32 {
        let center = DVec3::new(f64::from(i % 7), f64::from(i % 5), f64::from(i % 3)) * 1.7;
        let up = DVec3::new(0.6, 0.0, 0.8);
        let start = center + up * (0.9 + 0.01 * f64::from(i));
        let from = Origin {
            id: u64::from(i),
            facet: 0,
            local: start,
        };
        // From far too flat to tell to clearly inwards and outwards.
        for step in -18..=18i32 {
            let angle = 10f64.powi(step.abs() - 19) * f64::from(step.signum());
            let ray = Ray::new(start, DVec3::new(0.8, 0.0, -0.6) - up * angle);
            let hits = scenes.iter().map(|scene| {
                let mut tracer = Intersector::new(scene);
                let range = Interval::FORWARD;
                let hit = tracer.closest_hit(&ray, range, Some(&from), RayClass::Secondary);
                let any = tracer.any_opaque(&ray, range, Some(&from));
                (hit.map(|hit| (hit.id, hit.t.to_bits())), any)
            });
            let hits: Vec<_> = hits.collect();
            assert!(
                hits.iter().all(|hit| *hit == hits[0]),
                "{i} {angle}: {hits:?}"
            );
            again += u32::from(hits[0].0.is_some_and(|(id, _)| id == u64::from(i)));
            all += 1;
        }
    }
    assert!(again > all / 4, "{again} of {all}");
}
