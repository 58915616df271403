//! Reflection, transparency and shadows against what can be computed by hand.

use crate::common::compiled;
use strahl_geometry::{Cuboid, Sphere};
use strahl_math::{DVec3, Interval, Ray};
use strahl_render::{
    BranchEnd, Intersector, RayKind, RayNode, RayTree, RenderOptions, TraceSettings, explain,
    trace::TreeTracer,
};
use strahl_scene::{Background, Camera, Object, ObjectExt, Scene};
use strahl_shade::interior::Interior;
use strahl_shade::{Color, Finish, Light, Material, Quality, ShadingModel};

fn slab(x0: f64, x1: f64) -> Cuboid {
    Cuboid::new(DVec3::new(x0, -100.0, -100.0), DVec3::new(x1, 100.0, 100.0))
}

fn follow(scene: &Scene, ray: Ray, change: impl FnOnce(&mut TraceSettings)) -> (Color, RayTree) {
    let scene = compiled(scene);
    let mut settings = TraceSettings::of(&scene);
    change(&mut settings);
    let mut tree = RayTree::default();
    let color = TreeTracer::new(&scene, settings)
        .trace(&ray, &mut tree)
        .color;
    (color, tree)
}

#[test]
fn ten_thousand_levels_between_two_mirrors() {
    // Each mirror keeps 0.9999 of the light and adds 0.0001 of its own: a sum that is known.
    let mirror = || {
        let finish = Finish {
            emission: Color::gray(1e-4),
            reflection: Color::gray(0.9999),
            ..Finish::BLACK
        };
        Material::with_finish(finish)
    };
    let scene = Scene::new()
        .add(slab(-2.0, -1.0).material(mirror()))
        .add(slab(1.0, 2.0).material(mirror()))
        .camera(Camera::perspective(DVec3::ZERO, DVec3::X, DVec3::Y, 1.0));
    let ray = Ray::new(DVec3::ZERO, DVec3::X);
    let (color, tree) = follow(&scene, ray, |s| {
        s.max_depth = 10_000;
        s.adc_bailout = 0.0;
    });
    assert_eq!(tree.nodes.len(), 10_000);
    let expected = 1.0 - 0.9999f64.powi(10_000);
    assert!((color.r - expected).abs() < 1e-9, "{} {expected}", color.r);
}

#[test]
fn snells_law_through_nested_media() {
    // Air, water, glass, water, air: the ray leaves parallel to how it came.
    let clear = |eta: f64| {
        let finish = Finish {
            transmission: Color::WHITE,
            ..Finish::BLACK
        };
        Material {
            eta,
            ..Material::with_finish(finish)
        }
    };
    let scene = Scene::new()
        .add(slab(0.0, 4.0).material(clear(1.33)))
        .add(slab(1.0, 2.0).material(clear(1.52)))
        .background(Background::Solid(Color::WHITE))
        .camera(Camera::perspective(DVec3::NEG_X, DVec3::X, DVec3::Y, 1.0));
    let direction = DVec3::new(1.0, 0.6, -0.3).normalize();
    let (color, tree) = follow(&scene, Ray::new(DVec3::NEG_X, direction), |_| {});
    let directions: Vec<DVec3> = tree.nodes.iter().map(|n| n.report.ray.direction).collect();
    assert_eq!(directions.len(), 5);
    let sine = |d: DVec3| DVec3::new(0.0, d.y, d.z).length();
    for (d, eta) in directions.iter().zip([1.0, 1.33, 1.52, 1.33, 1.0]) {
        assert!(
            (sine(*d) * eta - sine(direction)).abs() < 1e-14 && (d.length() - 1.0).abs() < 1e-14
        );
    }
    assert!((directions[4] - direction).length() < 1e-14);
    assert_eq!(color, Color::WHITE);
}

/// POV-Ray 3.7.0.10 shows seven steps where a slab of this glass divides a step from black to white, at these indices.
#[test]
fn dispersion_divides_light_into_its_spectrum() {
    let interior = Interior {
        ior: 1.5,
        dispersion: 1.5,
        ..Interior::default()
    };
    let glass = Material {
        eta: interior.ior,
        interior: Some(interior.into()),
        ..Material::with_finish(Finish {
            transmission: Color::WHITE,
            ..Finish::BLACK
        })
    };
    let scene = Scene::new()
        .add(slab(0.0, 4.0).material(glass))
        .background(Background::Solid(Color::WHITE))
        .camera(Camera::perspective(DVec3::NEG_X, DVec3::X, DVec3::Y, 1.0));
    let direction = DVec3::new(1.0, 0.7, 0.0).normalize();
    let (color, tree) = follow(&scene, Ray::new(DVec3::NEG_X, direction), |s| {
        s.adc_bailout = 1e-9;
    });
    let inside: Vec<&RayNode> = tree.nodes.iter().filter(|n| n.report.depth == 2).collect();
    let mut found: Vec<f64> = inside
        .iter()
        .map(|n| direction.y / n.report.ray.direction.y)
        .collect();
    found.sort_by(f64::total_cmp);
    let measured = [1.2607, 1.3359, 1.4156, 1.5001, 1.5896, 1.6843, 1.7848];
    assert_eq!(found.len(), measured.len());
    for (found, measured) in found.iter().zip(measured) {
        assert!((found - measured).abs() < 5e-4, "{found} is not {measured}");
    }
    // Each part leaves as it came, and is not divided again.
    let outside: Vec<&RayNode> = tree.nodes.iter().filter(|n| n.report.depth == 3).collect();
    assert_eq!(outside.len(), measured.len());
    for node in outside {
        assert!((node.report.ray.direction - direction).length() < 1e-12);
        assert!(!node.report.part.is_white());
    }
    // The shares sum to POV-Ray's white.
    let lost = Color::WHITE - color;
    assert!(
        lost.r > 0.0 && lost.map(f64::abs).max_component() < 0.007,
        "{color:?}"
    );
    let sum = tree.nodes[0]
        .children
        .iter()
        .fold(Color::BLACK, |sum, child| {
            sum + tree.nodes[*child as usize].total
        });
    assert!((sum - color).map(f64::abs).max_component() < 1e-15);
}

#[test]
fn an_index_of_one_does_not_bend_rays_at_all() {
    let clear = Material::with_finish(Finish {
        transmission: Color::gray(0.5),
        ..Finish::BLACK
    });
    let scene = Scene::new()
        .add(Sphere::new(DVec3::ZERO, 1.0).material(clear))
        .background(Background::Solid(Color::WHITE))
        .camera(Camera::perspective(
            DVec3::Z * 5.0,
            DVec3::ZERO,
            DVec3::Y,
            1.0,
        ));
    let direction = DVec3::new(0.1, 0.05, -1.0).normalize();
    let (color, tree) = follow(&scene, Ray::new(DVec3::Z * 5.0, direction), |_| {});
    assert!(
        tree.nodes
            .iter()
            .all(|n| n.report.ray.direction == direction)
    );
    assert_eq!((tree.nodes.len(), color), (3, Color::gray(0.25)));
}

#[test]
fn total_reflection_keeps_the_light_inside() {
    // Inside a glass block, 45 degrees on its face: beyond the critical angle of 41.8 degrees.
    let glass = Material {
        eta: 1.5,
        ..Material::with_finish(Finish {
            reflection: Color::gray(0.1),
            transmission: Color::gray(0.9),
            ..Finish::BLACK
        })
    };
    let scene = Scene::new()
        .add(slab(-1.0, 1.0).material(glass))
        .camera(Camera::perspective(DVec3::ZERO, DVec3::X, DVec3::Y, 1.0));
    let (_, tree) = follow(
        &scene,
        Ray::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0).normalize()),
        |s| {
            s.max_depth = 3;
        },
    );
    let kinds: Vec<RayKind> = tree.nodes.iter().map(|n| n.report.kind).collect();
    assert_eq!(
        kinds,
        [RayKind::Primary, RayKind::Reflection, RayKind::Reflection]
    );
    assert_eq!(
        tree.nodes[0].report.hit.as_ref().map(|h| h.reflection),
        Some(Color::WHITE)
    );
    assert_eq!(
        tree.nodes[0].ended,
        [(RayKind::Refraction, 0.0, BranchEnd::TotalReflection)]
    );
}

#[test]
fn light_is_absorbed_by_length() {
    let finish = Finish {
        transmission: Color::WHITE,
        ..Finish::BLACK
    };
    let absorption = Color::new(0.0, 0.5, 2.0);
    let scene = Scene::new()
        .add(slab(0.0, 3.0).material(Material {
            absorption,
            ..Material::with_finish(finish)
        }))
        .background(Background::Solid(Color::WHITE))
        .camera(Camera::perspective(DVec3::NEG_X, DVec3::X, DVec3::Y, 1.0));
    let (color, _) = follow(&scene, Ray::new(DVec3::NEG_X, DVec3::X), |_| {});
    assert_eq!(color.r, 1.0);
    assert!((color.g - (-1.5f64).exp()).abs() < 1e-14 && (color.b - (-6.0f64).exp()).abs() < 1e-14);
}

#[test]
fn shadows_are_filtered_by_what_is_transparent() {
    let filter = Material::with_finish(Finish {
        transmission: Color::new(0.5, 1.0, 0.0),
        ..Finish::BLACK
    });
    let lit = |blocker: Option<Object>| {
        let mut scene = Scene::new()
            .add(slab(-1.0, 0.0).material(Material::matte(Color::WHITE)))
            .ambient(Color::BLACK)
            .light(Light::point(DVec3::X * 8.0, Color::WHITE))
            .camera(Camera::perspective(DVec3::X, DVec3::ZERO, DVec3::Y, 1.0));
        scene.settings.shading = ShadingModel::Lambert;
        if let Some(object) = blocker {
            scene = scene.add(object);
        }
        follow(&scene, Ray::new(DVec3::X, DVec3::NEG_X), |_| {}).0
    };
    let ball = |material| Sphere::new(DVec3::X * 4.0, 1.0).material(material);
    assert_eq!(lit(None), Color::WHITE);
    // In at the front, out at the back: the filter counts twice.
    assert_eq!(lit(Some(ball(filter))), Color::new(0.25, 1.0, 0.0));
    assert_eq!(lit(Some(ball(Material::default()))), Color::BLACK);
    // Behind the light nothing casts a shadow.
    assert_eq!(
        lit(Some(
            Sphere::new(DVec3::X * 12.0, 1.0).material(Material::default())
        )),
        Color::WHITE
    );
}

#[test]
fn fresnel_divides_all_the_light() {
    let scene = Scene::new()
        .add(slab(0.0, 3.0).material(Material::glass(1.5)))
        .background(Background::Solid(Color::WHITE))
        .camera(Camera::perspective(DVec3::NEG_X, DVec3::X, DVec3::Y, 1.0));
    let (_, tree) = follow(&scene, Ray::new(DVec3::NEG_X, DVec3::X), |_| {});
    let hit = tree.nodes[0].report.hit.as_ref().expect("the glass");
    assert!((hit.reflection.r - 0.04).abs() < 1e-15 && (hit.transmission.r - 0.96).abs() < 1e-15);
}

#[test]
fn tiny_spheres_far_away_are_spheres() {
    // Radius 1e-6 at position 1e9, where f64 coordinates are 1.2e-7 apart: the reflections on a sphere and the
    // shadow terminator are still right because the scene gives the cluster a space of its own.
    let far = DVec3::new(1e9, -1e9, 1e9);
    let (r, r3) = (1e-6, 3e-6);
    let mut scene = Scene::new();
    for (i, offset) in [DVec3::ZERO, DVec3::X * r3, DVec3::Y * r3, DVec3::Z * r3]
        .into_iter()
        .enumerate()
    {
        let material = Material::mirror(Color::gray(0.9));
        scene = scene.add(
            Sphere::new(far + offset, r)
                .material(material)
                .named(&format!("ball {i}")),
        );
    }
    let scene = scene
        .background(Background::Solid(Color::WHITE))
        .light(Light::directional(
            DVec3::new(-1.0, -1.0, -1.0),
            Color::WHITE,
        ))
        .camera(Camera::perspective(
            far + DVec3::splat(16e-6),
            far,
            DVec3::Y,
            0.5,
        ));
    let compiled = compiled(&scene);
    assert_eq!(compiled.stats().instances, 1, "one space for the cluster");
    let options = RenderOptions::new(&compiled, 64, 64);
    let mut hits = 0;
    for y in 0..64 {
        for x in 0..64 {
            let pixel = explain(&compiled, &options, x, y).expect("exists");
            for node in &pixel.samples[0].tree.nodes {
                let Some(hit) = &node.report.hit else {
                    continue;
                };
                hits += 1;
                assert!((hit.n_geom.length() - 1.0).abs() < 1e-14);
                // A reflected ray never meets the sphere it left.
                if node.report.kind == RayKind::Reflection {
                    let parent = &pixel.samples[0].tree.nodes[node.report.parent as usize];
                    let before = parent.report.hit.as_ref().map(|h| h.object);
                    assert_ne!(before, Some(hit.object), "acne at {x},{y}");
                }
            }
        }
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn a_query_sees_both_surfaces_of_a_sphere_and_then_nothing() {
    let scene = compiled(&Scene::new().add(Sphere::new(DVec3::ZERO, 1.0)));
    let mut tracer = Intersector::new(&scene);
    let ray = Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z);
    let class = strahl_render::RayClass::Camera;
    let first = tracer
        .closest_hit(&ray, Interval::FORWARD, None, class)
        .expect("front");
    let second = tracer
        .closest_hit(&ray, Interval::new(first.t, f64::INFINITY), None, class)
        .expect("back");
    assert_eq!((first.t, second.t), (2.0, 4.0));
    assert_eq!(
        tracer.closest_hit(&ray, Interval::new(second.t, f64::INFINITY), None, class),
        None
    );
    assert!(tracer.any_opaque(&ray, Interval::FORWARD, None));
    assert!(!tracer.any_opaque(&ray, Interval::new(0.0, 2.0f64.next_down()), None));
}

#[test]
fn quality_leaves_out_light_shadows_transparency_and_reflection() {
    // A slab is seen along x; a light in front of it is behind a filtering ball.
    let filter = Finish {
        transmission: Color::gray(0.5),
        ..Finish::BLACK
    };
    let look = Finish {
        emission: Color::gray(0.1),
        diffuse: Color::gray(0.2),
        reflection: Color::gray(0.25),
        transmission: Color::gray(0.5),
        ..Finish::BLACK
    };
    let scene = |level: u8| {
        let mut scene = Scene::new()
            .add(slab(1.0, 2.0).material(Material::with_finish(look)))
            .add(
                Sphere::new(DVec3::new(-2.0, 2.0, 0.0), 0.5)
                    .material(Material::with_finish(filter)),
            )
            .light(Light::point(DVec3::new(-5.0, 4.0, 0.0), Color::WHITE))
            .background(Background::Solid(Color::WHITE))
            .camera(Camera::perspective(DVec3::ZERO, DVec3::X, DVec3::Y, 1.0));
        scene.settings.quality = Quality::new(level);
        scene
    };
    let ray = Ray::new(DVec3::ZERO, DVec3::X);
    let trees = [0, 2, 4, 6, 8, 9].map(|level| follow(&scene(level), ray, |_| {}));
    let seen = trees.each_ref().map(|(color, _)| color.r);
    let rays = trees.each_ref().map(|(_, tree)| tree.nodes.len());
    let cos = 6.0 / 52f64.sqrt();
    let [unlit, lit, shadowed] = [0.95, 0.1 + 0.2 * cos, 0.1 + 0.2 * cos * 0.25];
    for (seen, expected) in seen.iter().zip([unlit, lit, shadowed]) {
        assert!((seen - expected).abs() < 1e-12, "{seen} is not {expected}");
    }
    assert_eq!(rays[..3], [1, 1, 1]);
    // Straight through both faces, of which the second adds its own light.
    let behind = 0.5 * (0.1 + 0.5);
    assert!(seen[3] > shadowed + behind, "{}", seen[3]);
    assert_eq!(rays[3], 3);
    assert!(seen[4] > seen[3] + 0.25 && rays[4] > 4);
    assert_eq!((seen[4], rays[4]), (seen[5], rays[5]));
}
