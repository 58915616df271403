//! Neither the number of rays that go through the stages together nor the rays before change a bit.

use super::{TraceSettings, TreeTracer};
use crate::compile::{CompileOptions, compile};
use crate::sampling::Sample;
use crate::scene::RenderScene;
use strahl_accel::PACKET;
use strahl_geometry::{Cuboid, Plane, Sphere};
use strahl_math::{DVec3, Ray};
use strahl_scene::{Background, BackgroundAlpha, Camera, ObjectExt, Scene};
use strahl_shade::normal::{NormalKind, PovNormal};
use strahl_shade::patterns::{Fractal, FractalKind, Pattern, PatternField};
use strahl_shade::pigment::{BlendMap, Pigment};
use strahl_shade::pov_finish::{PovFinish, PovReflection};
use strahl_shade::texture::{PlainTexture, Texture};
use strahl_shade::{AreaLight, Color, ColorFt, Light, Material};

/// A texture whose colours come from a fractal.
fn fractal(kind: FractalKind) -> Material {
    let fractal = Fractal {
        kind,
        ..Fractal::mandelbrot(40)
    };
    let colors = vec![
        (0.0, Color::new(0.1, 0.2, 0.6).into()),
        (1.0, Color::new(0.9, 0.7, 0.2).into()),
    ];
    let pigment = Pigment::ColorMap(Pattern::Fractal(fractal).into(), BlendMap::new(colors));
    let finish = PovFinish {
        ambient: Color::gray(0.8),
        ..PovFinish::default()
    };
    Material::textured(Texture::from(PlainTexture {
        pigment,
        finish: finish.into(),
        ..PlainTexture::default()
    }))
}

/// Granite under clouds that let it through in places, and with bumps.
fn stone() -> Material {
    let ramp = |pattern: Pattern, low: Pigment, high: Pigment| {
        let mut field = PatternField::from(pattern);
        field.modifiers.turbulence = DVec3::splat(0.3);
        Pigment::PigmentMap(
            Box::new(field),
            BlendMap::new(vec![(0.2, low), (0.8, high)]),
        )
    };
    let gray = |value: f64| Pigment::from(ColorFt::from(Color::gray(value)));
    let clear = Pigment::from(ColorFt::CLEAR);
    let granite = PlainTexture {
        pigment: ramp(Pattern::Granite, gray(0.1), gray(0.9)),
        normal: Some(Box::new(PovNormal::new(NormalKind::Height(
            Pattern::Bozo,
            None,
        )))),
        ..PlainTexture::default()
    };
    let clouds = PlainTexture {
        pigment: ramp(
            Pattern::Bozo,
            clear,
            ramp(Pattern::Leopard, gray(0.3), gray(0.7)),
        ),
        ..PlainTexture::default()
    };
    Material::textured(Texture::Layered(
        vec![Texture::Plain(granite), Texture::Plain(clouds)].into(),
    ))
}

/// Four layers that mirror into different octants: the light of more than two children is added in their order, whichever go together.
fn petals() -> Material {
    let layer = |k: u32| {
        let finish = PovFinish {
            reflection: PovReflection::constant(Color::new(0.2, 0.23, 0.17)),
            ..PovFinish::default()
        };
        let mut normal = PovNormal::new(NormalKind::Bumps);
        normal.amount = 0.7 + 0.3 * f64::from(k);
        let pigment = Pigment::from(ColorFt {
            transmit: 0.7,
            ..ColorFt::from(Color::gray(0.3))
        });
        Texture::Plain(PlainTexture {
            pigment,
            normal: Some(Box::new(normal)),
            finish: finish.into(),
        })
    };
    Material::textured(Texture::Layered((0..4).map(layer).collect()))
}

/// Every kind of ray: glass in glass, mirrors that face each other, an area light, light through tinted balls; and textures that are evaluated
/// together.
/// Without the wall behind them the balls stand in front of the background.
fn scene(walled: bool) -> RenderScene {
    let mirror = Material::shiny(Color::gray(0.2), 0.3, 20.0).with_reflection(Color::gray(0.6));
    let tinted =
        Material::matte(Color::gray(0.2)).with_transparency(Color::new(0.9, 0.4, 0.3), 0.7, 0.1);
    let mut lamp = Light::point(DVec3::new(3.0, 6.0, 4.0), Color::gray(0.7));
    lamp.area = Some(AreaLight {
        adaptive: Some(1),
        jitter: true,
        ..AreaLight::new(DVec3::X, DVec3::Z, 5, 5)
    });
    let wall = |x: f64| {
        let low = DVec3::new(x, -1.0, -3.0);
        Cuboid::new(low, low + DVec3::new(0.2, 3.0, 6.0)).material(mirror.clone())
    };
    let mut scene = Scene::new()
        .add(Plane::new(DVec3::Y * -1.0, DVec3::Y).material(mirror.clone()))
        .add(wall(-3.0))
        .add(wall(3.0))
        .add(Sphere::new(DVec3::ZERO, 1.0).material(Material::glass(1.5)))
        .add(Sphere::new(DVec3::ZERO, 0.5).material(Material::glass(1.2)))
        .light(lamp)
        .light(Light::point(DVec3::new(-2.0, 5.0, 3.0), Color::gray(0.4)))
        .background(Background::Solid(Color::new(0.1, 0.2, 0.4)))
        .camera(Camera::perspective(
            DVec3::new(0.3, 1.0, 7.0),
            DVec3::ZERO,
            DVec3::Y,
            0.8,
        ));
    scene.background_alpha = BackgroundAlpha::LeftOut;
    if walled {
        let wall = Plane::new(DVec3::Z * -3.0, DVec3::Z);
        scene = scene.add(wall.material(fractal(FractalKind::Magnet1)));
    }
    for k in 0..12 {
        let turn = f64::from(k) * 0.6;
        let center = DVec3::new(2.0 * turn.sin(), -0.6, 2.0 * turn.cos());
        let material = match k {
            0 => fractal(FractalKind::Power { exponent: 2 }),
            1 => fractal(FractalKind::Power { exponent: 3 }),
            2..=4 => stone(),
            5..=7 => petals(),
            _ => tinted.clone(),
        };
        scene = scene.add(Sphere::new(center, 0.4).material(material));
    }
    compile(&scene, &CompileOptions::default()).expect("a scene")
}

/// Traces a picture of the scene one by one and in batches, and returns what its rays see.
fn traced_in_batches<'s>(
    scene: &'s RenderScene,
    tracer: impl Fn(TraceSettings) -> TreeTracer<'s>,
) -> Vec<Sample> {
    let settings = TraceSettings::of(scene);
    let rays: Vec<Option<Ray>> = (0..32 * 24)
        .map(|k| {
            let (x, y) = (
                f64::from(k % 32) / 32.0 - 0.5,
                f64::from(k / 32) / 24.0 - 0.5,
            );
            let direction = DVec3::new(0.9 * x, -0.7 * y - 0.1, -1.0);
            // Some lanes have no ray.
            (k % 13 != 5).then(|| Ray::new(DVec3::new(0.3, 1.0, 7.0), direction))
        })
        .collect();
    // Shadow rays to the area light, too, go by themselves.
    let one_by_one = TraceSettings {
        packets: false,
        ..settings
    };
    let mut single = tracer(one_by_one);
    let alone: Vec<Sample> = rays
        .iter()
        .map(|ray| match ray {
            Some(ray) => single.trace(ray, &mut ()).sample(),
            None => Sample::BLACK,
        })
        .collect();
    // What a tracer keeps of the ray before changes nothing.
    for (ray, seen) in rays.iter().zip(&alone) {
        if let Some(ray) = ray {
            let first = tracer(one_by_one).trace(ray, &mut ()).sample();
            assert_eq!(first, *seen);
        }
    }
    for size in [1, 2, 3, 7, PACKET] {
        // Fewer primary rays whose branches wait for each other, and fewer of all rays.
        for (primary, batch) in [(size, PACKET), (PACKET, size)] {
            let mut tracer = tracer(TraceSettings { batch, ..settings });
            let together: Vec<Sample> = rays
                .chunks(primary)
                .flat_map(|rays| tracer.trace_packet(rays).to_vec())
                .collect();
            assert_eq!(together, alone, "{primary} {batch}");
            assert_eq!(tracer.counts, single.counts, "{primary} {batch}");
        }
    }
    assert!(single.counts.reflection > 500 && single.counts.refraction > 500);
    alone
}

#[test]
fn batches_of_any_size_have_the_same_bits() {
    let scene = scene(true);
    let samples = traced_in_batches(&scene, |settings| TreeTracer::new(&scene, settings));
    assert!(samples.iter().all(|sample| sample.clear == 0.0));
}

#[test]
fn batches_with_an_alpha_channel_have_the_same_bits() {
    let scene = scene(false);
    let tracer = |settings| TreeTracer::new(&scene, settings);
    let opaque = traced_in_batches(&scene, tracer);
    let clear = traced_in_batches(&scene, |settings| tracer(settings).with_alpha());
    let counts = |low: f64, high: f64| {
        let seen = clear.iter().filter(|s| s.clear >= low && s.clear < high);
        seen.count()
    };
    // Beside all things, through one of them, and nothing.
    assert!(counts(1.0, 2.0) > 100 && counts(0.01, 0.99) > 10 && counts(0.0, 1e-9) > 100);
    let background = Color::new(0.1, 0.2, 0.4);
    for (opaque, clear) in opaque.iter().zip(&clear) {
        // Through coloured balls the shares of red and blue differ.
        if clear.clear > 0.999 || clear.clear == 0.0 {
            let missing = opaque.color - clear.color - background * clear.clear;
            assert!(missing.map(f64::abs).max_component() < 1e-3, "{missing:?}");
        }
    }
}
