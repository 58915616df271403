//! POV-Ray's textures on objects: their space, layers and shadows.

use crate::common::{compiled, rendered};
use strahl_geometry::{Cuboid, MeshData, Shape, Sphere, TriangleMesh};
use strahl_math::{DVec3, Ray};
use strahl_render::{TraceSettings, trace::TreeTracer};
use strahl_scene::{Camera, CsgOp, Object, ObjectExt, Scene};
use strahl_shade::patterns::Pattern;
use strahl_shade::pigment::Pigment;
use strahl_shade::pov_finish::{PovFinish, PovReflection};
use strahl_shade::texture::{PlainTexture, Texture};
use strahl_shade::{Color, ColorFt, Finish, Light, Material};

fn material(texture: Texture) -> Material {
    Material {
        texture: Some(texture.into()),
        ..Material::default()
    }
}

fn plain(pigment: Pigment) -> PlainTexture {
    PlainTexture {
        pigment,
        ..PlainTexture::default()
    }
}

fn opaque(r: f64, g: f64, b: f64) -> Pigment {
    ColorFt::opaque(Color::new(r, g, b)).into()
}

/// What a camera at `eye`, looking along -z, sees in the middle of the picture.
fn seen(scene: Scene, eye: DVec3) -> [f32; 3] {
    let camera = Camera::perspective(eye, eye - DVec3::Z, DVec3::Y, 0.1);
    let scene = compiled(&scene.camera(camera).ambient(Color::WHITE));
    let film = rendered(&scene, |o| (o.width, o.height) = (1, 1)).film;
    film.pixels[0]
}

/// A box whose front shows red for x > 0, y > 0 of its own space, and green beside.
fn checkered() -> Object {
    let blocks = Pigment::Blocks(
        Pattern::Checker.into(),
        vec![opaque(0.0, 1.0, 0.0), opaque(1.0, 0.0, 0.0)].into(),
    );
    let texture = PlainTexture {
        finish: PovFinish {
            ambient: Color::WHITE,
            diffuse: 0.0,
            ..PovFinish::default()
        }
        .into(),
        ..plain(blocks)
    };
    let cube = Cuboid::new(DVec3::new(-0.9, -0.9, -0.9), DVec3::new(0.9, 0.9, 0.9));
    cube.material(material(texture.into()))
}

#[test]
fn a_texture_moves_with_its_object() {
    // Checker changes where any coordinate passes a whole number: the front is at z = 0.9.
    let colors = |object: Object, at: DVec3| {
        [(0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| {
            let scene = Scene::new().add(object.clone());
            seen(scene, at + DVec3::new(x, y, 9.0))
        })
    };
    let here = colors(checkered(), DVec3::ZERO);
    assert_ne!(here[0], here[1]);
    let (aside, farther) = (DVec3::new(3.5, 0.25, 0.0), DVec3::new(-1.0, 7.5, 0.5));
    let moved = checkered().translated(aside);
    assert_eq!(colors(moved.clone(), aside), here);
    let union = Object::csg(CsgOp::Union, vec![moved.clone()]).translated(farther);
    assert_eq!(colors(union, aside + farther), here);
    // In a solid that has the texture itself, its parts have none of their own.
    let bare = Object {
        material: None,
        ..checkered()
    };
    let ball = Sphere::new(DVec3::ZERO, 9.0).into();
    let solid = Object::csg(CsgOp::Intersection, vec![bare.translated(aside), ball]);
    let solid = Object {
        material: checkered().material,
        ..solid
    };
    let of_solid = colors(solid.translated(-aside), DVec3::ZERO);
    // The texture's space is the solid's: it starts half a block further left.
    assert_eq!(
        of_solid[0],
        colors(checkered(), DVec3::new(1.0, 0.0, 0.0))[1]
    );
    let mut scene = Scene::new();
    let inner = scene.add_group(vec![moved]);
    let outer = scene.add_group(vec![Object::instance(inner).translated(farther)]);
    for (place, color) in [(0.5, here[0]), (-0.5, here[1])] {
        let scene = scene.clone().add(Object::instance(outer).translated(aside));
        let eye = aside + aside + farther + DVec3::new(place, 0.5, 9.0);
        assert_eq!(seen(scene, eye), color);
    }
}

/// They are in spaces of their own.
#[test]
fn textures_of_objects_far_from_the_origin_stay_where_they_are() {
    let look = || checkered().material.expect("a material");
    // A whole number of blocks away.
    let place = DVec3::new(500_000.0, 5_400_000.0, 300.0);
    let square = |at: DVec3| {
        let corners = [(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)];
        let corners = corners.map(|(x, y)| at + DVec3::new(x, y, 0.9));
        let data = MeshData::from_f64(&corners, vec![[0, 1, 2], [0, 2, 3]]);
        Object::from(Shape::from(TriangleMesh::try_new(data).expect("a mesh")))
    };
    let ball = |at: DVec3| Object::from(Sphere::new(at, 0.95));
    let part = |at: DVec3| {
        let cut = Cuboid::new(at - 0.6, at + 0.93);
        Object::csg(CsgOp::Intersection, vec![ball(at), cut.into()])
    };
    let objects: [&dyn Fn(DVec3) -> Object; 3] = [&square, &ball, &part];
    for (number, object) in objects.into_iter().enumerate() {
        let with = |mut object: Object| {
            object.material = Some(look());
            object
        };
        let colors = |object: Object, at: DVec3| {
            [(0.4, 0.3), (-0.4, 0.3), (-0.4, -0.3)].map(|(x, y)| {
                let scene = Scene::new().add(object.clone());
                seen(scene, at + DVec3::new(x, y, 9.0))
            })
        };
        let near = colors(with(object(DVec3::ZERO)), DVec3::ZERO);
        assert_ne!(near[0], near[1]);
        // Made there, and carried there.
        assert_eq!(colors(with(object(place)), place), near, "{number}");
        let carried = with(object(DVec3::ZERO)).translated(place + 0.1);
        assert_eq!(colors(carried, place + 0.1), near, "{number}");
    }
}

#[test]
fn layers_mirrors_and_shadows_follow_the_formula() {
    let clear = ColorFt {
        rgb: Color::new(1.0, 0.5, 0.25),
        filter: 0.5,
        transmit: 0.25,
    };
    let top = plain(Pigment::from(clear));
    let bottom = |mirror: f64| PlainTexture {
        finish: PovFinish {
            reflection: PovReflection::constant(Color::gray(mirror)),
            ..PovFinish::default()
        }
        .into(),
        ..plain(opaque(0.2, 0.4, 0.8))
    };
    let layered =
        |mirror: f64| Texture::Layered(vec![bottom(mirror).into(), top.clone().into()].into());
    let wall = Cuboid::new(DVec3::new(-9.0, -9.0, -1.0), DVec3::new(9.0, 9.0, 0.0));
    let scene = |shade: bool| {
        let scene = Scene::new()
            .add(wall.material(material(layered(if shade { 0.0 } else { 0.5 }))))
            .light(Light::directional(DVec3::NEG_Z, Color::WHITE))
            .background(strahl_scene::Background::Solid(Color::new(0.3, 0.2, 0.1)));
        let sheet = Cuboid::new(DVec3::new(-9.0, -9.0, 20.0), DVec3::new(9.0, 9.0, 21.0));
        let sheet = sheet.material(material(plain(Pigment::from(clear)).into()));
        if shade { scene.add(sheet) } else { scene }
    };
    let expected = |light: Color| {
        // Ambient 0.1 and diffuse 0.6; the upper layer is opaque by 1/4.
        let above = Color::new(1.0, 0.5, 0.25) * 0.5 + Color::gray(0.25);
        let body = Color::new(1.0, 0.5, 0.25) * 0.25 + Color::new(0.2, 0.4, 0.8) * above;
        body * (Color::gray(0.1) + light * 0.6)
    };
    let close = |found: [f32; 3], color: Color| {
        let off = found.iter().zip(color.to_array());
        off.map(|(a, b)| (f64::from(*a) - b).abs())
            .fold(0.0, f64::max)
            < 1e-6
    };
    let mirrored = Color::new(0.3, 0.2, 0.1) * 0.5;
    let found = seen(scene(false), DVec3::new(0.0, 0.0, 9.0));
    assert!(close(found, expected(Color::WHITE) + mirrored), "{found:?}");

    // The sheet filters the light at both of its faces.
    let pass = clear.attenuation() * clear.attenuation();
    let found = seen(scene(true), DVec3::new(0.0, 0.0, 9.0));
    assert!(close(found, expected(pass)), "{found:?}");
}

/// What a ray knows of the blended textures of one hit must not reach the next, which has a finish without texture.
#[test]
fn glass_without_texture_behind_blended_textures() {
    let clear = |transmit: f64| {
        let color = ColorFt {
            rgb: Color::BLACK,
            filter: 0.0,
            transmit,
        };
        (1.0, Texture::from(plain(Pigment::from(color))))
    };
    let blended = Texture::Average(vec![clear(0.9), clear(0.5)].into(), Box::default());
    let glass = Material {
        finish: Finish {
            transmission: Color::new(0.25, 0.5, 1.0),
            ..Finish::BLACK
        }
        .into(),
        ..Material::default()
    };
    let sheet = |z: f64| Cuboid::new(DVec3::new(-9.0, -9.0, z), DVec3::new(9.0, 9.0, z + 1.0));
    let sky = Color::new(0.8, 0.6, 0.4);
    let scene = Scene::new()
        .add(sheet(2.0).material(material(blended)))
        .add(sheet(-2.0).material(glass))
        .background(strahl_scene::Background::Solid(sky));
    // Two faces each; the textures let 0.9 and 0.5 pass, 0.7 on average.
    let expected = sky * (0.7 * 0.7) * Color::new(0.25 * 0.25, 0.25, 1.0);
    let found = seen(scene, DVec3::new(0.0, 0.0, 9.0));
    for (found, expected) in found.iter().zip(expected.to_array()) {
        assert!(
            (f64::from(*found) - expected).abs() < 1e-6,
            "{found}, not {expected}"
        );
    }
}

#[test]
fn surfaces_that_show_no_lights_send_no_shadow_rays() {
    let shadow_rays = |finish: PovFinish| {
        let texture = PlainTexture {
            finish: finish.into(),
            ..plain(opaque(0.5, 0.5, 0.5))
        };
        let scene = Scene::new()
            .add(Sphere::new(DVec3::ZERO, 1.0).material(material(texture.into())))
            .light(Light::point(DVec3::new(0.0, 0.0, 9.0), Color::WHITE))
            .camera(Camera::perspective(
                DVec3::new(0.0, 0.0, 5.0),
                DVec3::ZERO,
                DVec3::Y,
                0.1,
            ));
        rendered(&compiled(&scene), |o| (o.width, o.height) = (1, 1))
            .rays
            .shadow
    };
    let dull = PovFinish {
        diffuse: 0.0,
        ..PovFinish::default()
    };
    assert_eq!(shadow_rays(dull), 0);
    let shiny = PovFinish { phong: 1.0, ..dull };
    assert_eq!(shadow_rays(shiny), 1);
    assert_eq!(shadow_rays(PovFinish::default()), 1);
}

#[test]
fn a_ray_does_not_see_what_the_ray_before_it_has_met() {
    // Materials of one colour, of a pattern and without a texture, in every order, on surfaces that turn.
    let ball =
        |x: f64, material: Material| Sphere::new(DVec3::new(x, 0.0, 0.0), 0.45).material(material);
    let scene = Scene::new()
        .camera(Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Y, 1.0))
        .light(Light::point(DVec3::new(1.0, 5.0, 9.0), Color::WHITE))
        .add(ball(0.0, material(plain(opaque(1.0, 0.2, 0.1)).into())))
        .add(ball(1.0, material(plain(opaque(0.1, 0.9, 0.3)).into())))
        .add(ball(2.0, Material::default()))
        .add(checkered().translated(DVec3::new(3.5, 0.0, 0.0)));
    let scene = compiled(&scene);
    let settings = TraceSettings::of(&scene);
    let mut reused = TreeTracer::new(&scene, settings);
    let ray = |x: f64, y: f64| Ray::new(DVec3::new(x, y, 5.0), DVec3::NEG_Z);
    let mut colors = Vec::new();
    for n in 0..600 {
        let x = f64::from(n * 7 % 45) * 0.1 - 0.2;
        let ray = ray(x, f64::from(n % 9 - 4) * 0.09);
        let color = reused.trace(&ray, &mut ()).color;
        let fresh = TreeTracer::new(&scene, settings).trace(&ray, &mut ()).color;
        assert_eq!(color, fresh, "{ray:?}");
        if !colors.contains(&color) {
            colors.push(color);
        }
    }
    assert!(colors.len() > 20, "{} colours", colors.len());
}
