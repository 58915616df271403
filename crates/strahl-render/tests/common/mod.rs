//! Scenes that several tests render.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use strahl_geometry::{Cuboid, Sphere};
use strahl_math::DVec3;
use strahl_render::{CompileOptions, RenderOptions, RenderScene, Rendered, compile, render};
use strahl_scene::{Background, Camera, ObjectExt, Scene};
use strahl_shade::{Color, Light, Material};

/// Mirrors, nested glass, coloured lights, a floor: every kind of ray.
pub(crate) fn glass_and_mirrors() -> Scene {
    let glass = Material {
        absorption: Color::new(0.1, 0.3, 0.2),
        ..Material::glass(1.5)
    }
    .named("glass");
    let tinted =
        Material::matte(Color::gray(0.2)).with_transparency(Color::new(0.9, 0.4, 0.3), 0.7, 0.1);
    let floor =
        Material::shiny(Color::new(0.8, 0.8, 0.7), 0.3, 12.5).with_reflection(Color::gray(0.2));
    let cube = Cuboid::new(DVec3::new(-5.0, -1.2, -5.0), DVec3::new(5.0, -1.0, 5.0));
    let mut scene = Scene::new()
        .add(cube.material(floor).named("floor"))
        .add(
            Sphere::new(DVec3::new(0.0, 0.0, 0.0), 1.0)
                .material(glass)
                .named("glass ball"),
        )
        .add(
            Sphere::new(DVec3::new(0.0, 0.0, 0.0), 0.5)
                .material(Material::glass(1.0))
                .named("bubble"),
        )
        .add(
            Sphere::new(DVec3::new(-2.0, 0.0, -1.5), 1.0)
                .material(Material::mirror(Color::gray(0.9))),
        )
        .add(
            Sphere::new(DVec3::new(1.8, -0.3, 0.8), 0.7)
                .material(tinted)
                .named("tinted ball"),
        )
        .light(Light::point(
            DVec3::new(4.0, 6.0, 5.0),
            Color::new(0.8, 0.7, 0.6),
        ))
        .light(Light::directional(
            DVec3::new(1.0, -2.0, -0.5),
            Color::new(0.2, 0.3, 0.4),
        ))
        .light(Light::spot(
            DVec3::new(-3.0, 5.0, 4.0),
            DVec3::ZERO,
            0.3,
            0.5,
            Color::gray(0.7),
        ))
        .background(Background::Gradient {
            up: DVec3::Y,
            bottom: Color::gray(0.1),
            top: Color::new(0.3, 0.5, 0.9),
        })
        .camera(Camera::perspective(
            DVec3::new(0.5, 1.5, 6.0),
            DVec3::ZERO,
            DVec3::Y,
            0.7,
        ));
    // A field of small spheres gives the accelerator something to do.
    for i in 0..200 {
        let a = f64::from(i) * 0.7;
        let center = DVec3::new(a.sin() * (2.5 + a * 0.02), -0.9, a.cos() * (2.5 + a * 0.02));
        let color = Color::new(
            0.3 + 0.7 * (a * 1.3).sin().abs(),
            0.5,
            0.3 + 0.7 * (a * 0.4).cos().abs(),
        );
        scene = scene.add(Sphere::new(center, 0.12).material(Material::shiny(color, 0.4, 30.0)));
    }
    scene
}

/// Compiles a valid scene with the default accelerator.
pub(crate) fn compiled(scene: &Scene) -> RenderScene {
    compile(scene, &CompileOptions::default()).expect("a valid scene")
}

/// Renders with options changed by `change`.
pub(crate) fn rendered(scene: &RenderScene, change: impl FnOnce(&mut RenderOptions)) -> Rendered {
    let mut options = RenderOptions::new(scene, 96, 64);
    options.threads = 1;
    change(&mut options);
    render(scene, &options, &()).expect("renders")
}
