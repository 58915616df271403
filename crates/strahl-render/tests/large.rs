//! Long paths, large trees and large pictures.

use crate::common::{compiled, rendered};
use strahl_geometry::{Plane, Sphere};
use strahl_math::DVec3;
use strahl_render::{BatchMemory, RayCounts, RenderOptions, RenderScene, Rendered, TraceSettings};
use strahl_scene::{Camera, ObjectExt, Scene};
use strahl_shade::{Color, Finish, Material};

/// A surface that reflects and transmits these parts of the light, and adds some.
fn surface(emission: f64, reflection: f64, transmission: f64) -> Material {
    let finish = Finish {
        emission: Color::gray(emission),
        reflection: Color::gray(reflection),
        transmission: Color::gray(transmission),
        ..Finish::BLACK
    };
    Material {
        eta: 1.0,
        ..Material::with_finish(finish)
    }
}

/// A picture whose trees nothing but their depth limits, traced with and without packets.
fn deep(scene: &RenderScene, side: u32, depth: u32) -> Rendered {
    let options = |packets: bool| {
        move |o: &mut RenderOptions| {
            (o.width, o.height) = (side, side);
            o.trace.packets = packets;
            o.trace.max_depth = depth;
            o.trace.adc_bailout = 0.0;
            o.trace.max_tree_rays = 1 << 24;
        }
    };
    let together = rendered(scene, options(true));
    let alone = rendered(scene, options(false));
    assert_eq!(together.film.sha256(), alone.film.sha256());
    assert_eq!(together.rays, alone.rays);
    together
}

/// Paths of four pixels go through the stages together to their ends; those of sixteen have too many rays for that.
#[test]
fn pictures_between_two_mirrors_have_ten_thousand_levels() {
    // Each mirror keeps 0.9999 of the light and adds 0.0001 of its own: a sum that is known.
    let mirror = |x: f64| Plane::new(DVec3::X * x, DVec3::X).material(surface(1e-4, 0.9999, 0.0));
    let scene = Scene::new()
        .add(mirror(-1.0))
        .add(mirror(1.0))
        .camera(Camera::perspective(DVec3::ZERO, DVec3::X, DVec3::Y, 1.0));
    let scene = compiled(&scene);
    let expected = (1.0 - 0.9999f64.powi(10_000)) as f32;
    for side in [2, 4] {
        let picture = deep(&scene, side, 10_000);
        let pixels = u64::from(side * side);
        let counts = RayCounts {
            primary: pixels,
            primary_hit: pixels,
            reflection: 9_999 * pixels,
            reflection_hit: 9_999 * pixels,
            ..RayCounts::default()
        };
        assert_eq!(picture.rays, counts);
        for color in &picture.film.pixels {
            assert!((color[0] - expected).abs() < 1e-6, "{color:?} {expected}");
        }
    }
}

/// A ball that lets half of the light through and reflects the other half, inside of a ball that is a mirror: no ray leaves.
#[test]
fn a_tree_of_a_million_rays() {
    let (emission, mirror) = (0.1, 0.9);
    let scene = Scene::new()
        .add(Sphere::new(DVec3::ZERO, 1.0).material(surface(0.0, 0.5, 0.5)))
        .add(Sphere::new(DVec3::ZERO, 3.0).material(surface(emission, mirror, 0.0)))
        .camera(Camera::perspective(
            DVec3::new(0.0, 0.1, 0.3),
            DVec3::X,
            DVec3::Y,
            0.1,
        ));
    let scene = compiled(&scene);
    let depth = 28;
    // Rays of a level that start inside of the inner ball, between the balls at the inner one, and there at the outer one. Each passes the
    // centre at the same distance as the one that sent it, so it meets what the next line says.
    let (mut inside, mut outwards, mut inwards) = (1, 0, 0);
    let (mut rays, mut reflected) = (1, 0);
    // The light along such rays if this is their last level.
    let mut light = (0.0, emission, 0.0);
    for _ in 1..depth {
        (inside, outwards, inwards) = (inside + inwards, inside + inwards, outwards);
        rays += inside + outwards + inwards;
        // Of the rays that the inner ball sends, one half is reflected.
        reflected += (inside + outwards) / 2 + inwards;
        let sent = 0.5 * (light.0 + light.1);
        light = (sent, emission + mirror * light.2, sent);
    }
    assert!(rays > 1_000_000, "{rays}");
    let picture = deep(&scene, 1, depth);
    let counts = RayCounts {
        primary: 1,
        primary_hit: 1,
        reflection: reflected,
        reflection_hit: reflected,
        refraction: rays - 1 - reflected,
        refraction_hit: rays - 1 - reflected,
        ..RayCounts::default()
    };
    assert_eq!(picture.rays, counts);
    // A node has more than 100 bytes, and the list of nodes is not larger than the bound of all lists of rays.
    let settings = |rays: u64| TraceSettings {
        max_tree_rays: rays as u32,
        ..TraceSettings::of(&scene)
    };
    let bytes = picture.batches.rays as u64;
    assert!(bytes > 100 * rays, "{bytes}");
    assert!(
        bytes <= BatchMemory::most_for_rays(&settings(rays)) as u64,
        "{bytes}"
    );
    let seen = picture.film.pixels[0][0];
    assert!((f64::from(seen) - light.0).abs() < 1e-6, "{seen} {light:?}");
    // Without a higher limit the tree is cut.
    let cut = rendered(&scene, |o| {
        (o.width, o.height) = (1, 1);
        (o.trace.max_depth, o.trace.adc_bailout) = (depth, 0.0);
    });
    assert!(cut.rays.cut_trees > 0);
    let most = BatchMemory::most_for_rays(&TraceSettings::of(&scene));
    assert!(cut.batches.rays < most && cut.batches.rays > most / 8);
    assert_eq!(cut.rays.total(), u64::from(TraceSettings::MAX_TREE_RAYS));
}
