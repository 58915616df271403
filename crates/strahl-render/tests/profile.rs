//! Profiles: what threads are doing while a picture is traced.

use crate::common::compiled;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use strahl_geometry::{Plane, Sphere, Torus};
use strahl_math::DVec3;
use strahl_render::{
    Activities, Profile, ProfilePart, ProfileReport, Progress, RenderOptions, RenderScene, render,
    render_watched,
};
use strahl_scene::{Camera, ObjectExt, Scene};
use strahl_shade::{Color, Light, Material};

/// A picture whose threads are sampled.
struct Sampled(Activities);

impl Progress for Sampled {
    fn activities(&self) -> Option<&Activities> {
        Some(&self.0)
    }
}

/// Mirroring tori over a floor, under two lights.
fn scene() -> RenderScene {
    let mut scene = Scene::new()
        .add(Plane::new(DVec3::ZERO, DVec3::Y).material(Material::matte(Color::gray(0.7))))
        .add(
            Sphere::new(DVec3::new(0.0, 1.0, 3.0), 0.5)
                .material(Material::glass(1.5))
                .named("ball"),
        )
        .light(Light::point(DVec3::new(4.0, 8.0, 6.0), Color::WHITE))
        .light(Light::point(DVec3::new(-4.0, 8.0, 6.0), Color::WHITE))
        .camera(Camera::perspective(
            DVec3::new(0.0, 2.0, 7.0),
            DVec3::Y,
            DVec3::Y,
            0.9,
        ));
    for x in -2..=2 {
        let torus = Torus::new(DVec3::new(f64::from(x), 0.3, 0.0), DVec3::Y, 0.4, 0.2);
        let mirror = Material::mirror(Color::gray(0.8));
        scene = scene.add(torus.material(mirror).named("ring"));
    }
    compiled(&scene)
}

/// The hash of a picture, and its profile. The picture is rendered until there are enough samples, which take their time on a busy
/// machine.
fn profile(scene: &RenderScene, options: &RenderOptions) -> (String, ProfileReport) {
    const ENOUGH: u32 = 5000;
    let (sampled, enough) = (Sampled(Activities::new()), AtomicBool::new(false));
    let mut profile = Profile::default();
    let hash = std::thread::scope(|threads| {
        let rendering = threads.spawn(|| {
            loop {
                let rendered = render_watched(scene, options, &sampled).expect("a picture");
                if enough.load(Ordering::Acquire) {
                    return rendered.film.sha256();
                }
            }
        });
        for _ in 0..ENOUGH {
            profile.sample(&sampled.0);
            std::thread::sleep(Duration::from_micros(200));
        }
        enough.store(true, Ordering::Release);
        rendering.join().expect("no panic")
    });
    // Nobody works any more.
    assert_eq!(sampled.0.now(), []);
    (hash, profile.report(scene))
}

fn sum(parts: &[ProfilePart]) -> u64 {
    parts.iter().map(|part| part.samples).sum()
}

#[test]
fn a_profile_names_what_takes_the_time_and_changes_no_pixel() {
    let scene = scene();
    let options = RenderOptions {
        threads: 2,
        ..RenderOptions::new(&scene, 120, 90)
    };
    let (hash, report) = profile(&scene, &options);
    let without = render(&scene, &options).expect("a picture");
    assert_eq!(hash, without.film.sha256());
    // Each sample has one phase and one ray; whatever else it has is a part of them.
    assert!(report.samples > 0);
    assert_eq!(sum(&report.phases), report.samples);
    assert_eq!(sum(&report.rays), report.samples);
    assert!(sum(&report.objects) <= report.samples);
    let has = |parts: &[ProfilePart], name: &str| {
        let found = parts.iter().find(|part| part.name == name);
        found
            .unwrap_or_else(|| panic!("no {name}: {parts:?}"))
            .samples
            > 0
    };
    assert!(has(&report.phases, "intersection") && has(&report.phases, "shading"));
    assert!(has(&report.rays, "primary rays") && has(&report.rays, "shadow rays"));
    assert!(has(&report.rays, "reflection rays"));
    // Quartics take longer than the plane.
    assert_eq!(report.primitives[0].name, "torus");
    let rings = report.objects.iter();
    let mut rings = rings.filter(|part| part.name == "torus \"ring\"");
    // Objects of one name and place are one row.
    assert_eq!(rings.next().map(|part| part.objects), Some(Some(5)));
    assert_eq!(rings.next(), None);
    let lights = report.lights.iter().map(|light| light.name.as_str());
    let mut lights: Vec<&str> = lights.collect();
    lights.sort_unstable();
    assert_eq!(lights, ["light 1, point light", "light 2, point light"]);
    for parts in [&report.phases, &report.objects, &report.lights] {
        assert!(parts.is_sorted_by(|a, b| a.samples >= b.samples));
        assert!(parts.iter().all(|part| (0.0..=1.0).contains(&part.share)));
    }
}
