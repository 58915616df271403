//! Scenes that several tests render.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use strahl_geometry::{
    BicubicPatch, Brep, Cone, Cuboid, Cylinder, Disc, MeshData, Plane, Polygon, Primitive, Quadric,
    Shape, SmoothTriangle, Sphere, Torus, Triangle, TriangleMesh,
};
use strahl_math::{DVec3, Transform};
use strahl_render::{CompileOptions, RenderOptions, RenderScene, Rendered, compile, render};
use strahl_scene::{Background, Camera, CsgOp, Object, ObjectExt, Scene};
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

/// One of every shape, about of size 1.
fn shapes() -> Vec<Shape> {
    let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
    let square = |s: f64| [-x - y, x - y, x + y, y - x].map(|p| p * s);
    let tetrahedron = [o, x, y, z].map(|p| p - DVec3::splat(0.3));
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mesh = || {
        let data = MeshData::from_f64(&tetrahedron, faces.to_vec());
        TriangleMesh::try_new(data).expect("a tetrahedron")
    };
    let window = Polygon::try_with_holes(&square(0.8), &[square(0.4).to_vec()]);
    vec![
        Sphere::new(o, 0.8).into(),
        Plane::new(-z * 0.5, DVec3::new(0.1, 0.2, 1.0)).into(),
        Cuboid::new(-DVec3::splat(0.6), DVec3::new(0.5, 0.6, 0.7)).into(),
        Disc::new(o, DVec3::new(0.3, 0.2, 1.0), 0.8, 0.3).into(),
        Cylinder::new(-y * 0.7, y * 0.6, 0.4).into(),
        Cylinder::open(-x * 0.7, x * 0.6 + y * 0.3, 0.3).into(),
        Cone::new(-y * 0.8, 0.6, y * 0.8, 0.1).into(),
        Cone::open(-y * 0.8, 0.0, y * 0.8, 0.5).into(),
        Torus::new(o, DVec3::new(0.2, 0.5, 1.0), 0.6, 0.22).into(),
        Quadric::new([1.0, 2.0, 1.5, 0.3, 0.0, 0.1, 0.0, 0.0, 0.0, -0.5]).into(),
        Triangle::new(-x, x - y, y).into(),
        SmoothTriangle::new([-x, x - y, y], [z - x, z + x, z + y]).into(),
        window.expect("a window").into(),
        mesh().into(),
        Brep::try_new(mesh()).expect("closed").into(),
    ]
}

/// Every shape: as it is, with a skewed transformation, as an instance, and cut by a sphere where it is a solid; tiny ones
/// far away.
pub(crate) fn every_shape() -> Scene {
    let mut scene = Scene::new()
        .light(Light::point(DVec3::new(3.0, 5.0, 20.0), Color::gray(0.8)))
        .light(Light::directional(
            -DVec3::new(4.0, 2.0, 5.0),
            Color::gray(0.4),
        ))
        .background(Background::Solid(Color::new(0.1, 0.2, 0.3)))
        .camera(Camera::orthographic(
            DVec3::new(7.0, 3.0, 30.0),
            DVec3::new(7.0, 3.0, 0.0),
            DVec3::Y,
            10.0,
        ));
    let skewed = Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 0.8)
        .then(&Transform::try_scale(DVec3::new(0.9, 0.5, -0.7)).expect("regular"));
    let inner = scene.add_group(vec![Sphere::new(DVec3::X * 0.5, 0.2).into()]);
    for (i, shape) in shapes().into_iter().enumerate() {
        let column = i as f64;
        let color = Color::new(0.3 + 0.04 * column, 0.8 - 0.04 * column, 0.5);
        let material = || Material::shiny(color, 0.3, 20.0).with_reflection(Color::gray(0.2));
        let place = |row: f64| DVec3::new(column, row * 2.0, 0.0);
        let small = |object: Object| {
            let half = Transform::try_scale(DVec3::splat(0.5)).expect("regular");
            object.transformed(&half)
        };
        // A plane is everywhere: here as the inside of a ball.
        let ball = || Object::from(Sphere::new(DVec3::new(0.3, 0.2, 0.1), 0.9));
        let solid = shape.as_solid().is_some();
        let plane = matches!(shape, Shape::Plane(_));
        let cut = |shape: &Shape| {
            let op = if solid {
                CsgOp::Intersection
            } else {
                CsgOp::Clip
            };
            Object::csg(op, vec![shape.clone().into(), ball()])
        };
        let plain = if plane {
            cut(&shape)
        } else {
            shape.clone().into()
        };
        let group = scene.add_group(vec![
            plain.clone().material(material()),
            Object::instance(inner).material(material()),
        ]);
        let carved = if solid {
            Object::csg(CsgOp::Difference, vec![ball(), shape.clone().into()])
        } else {
            cut(&shape)
        };
        scene = scene
            .add(small(plain.clone().material(material())).translated(place(0.0)))
            .add(small(plain.material(material()).transformed(&skewed)).translated(place(1.0)))
            .add(small(Object::instance(group).transformed(&skewed)).translated(place(2.0)))
            .add(small(carved.material(Material::glass(1.2))).translated(place(3.0)));
    }
    for i in 0..5 {
        let place = DVec3::new(1e6 + 2e-6 * f64::from(i), 3.0, -1e6);
        scene = scene.add(Sphere::new(place, 1e-6).named("tiny"));
    }
    scene
}

/// A ball of glass and a curtain behind it, of Bezier patches with common borders, some of them turned and scaled.
pub(crate) fn patches() -> Scene {
    let mut scene = Scene::new()
        .light(Light::point(DVec3::new(3.0, 5.0, 9.0), Color::gray(0.8)))
        .light(Light::directional(
            -DVec3::new(4.0, 2.0, 5.0),
            Color::gray(0.4),
        ))
        .background(Background::Solid(Color::new(0.1, 0.2, 0.3)))
        .camera(Camera::orthographic(
            DVec3::new(0.3, 0.2, 9.0),
            DVec3::ZERO,
            DVec3::Y,
            3.2,
        ));
    // A quarter of a circle, nearly.
    let arc = [[1.0, 0.0], [1.0, 0.55], [0.55, 1.0], [0.0, 1.0]];
    for octant in 0..8 {
        let sign = |bit: usize| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let points = std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let ([c, s], [r, y]) = (arc[i], arc[j]);
                DVec3::new(sign(0) * r * c, sign(1) * y, sign(2) * r * s)
            })
        });
        let patch = BicubicPatch::try_new(points).expect("a patch");
        scene = scene.add(patch.material(Material::glass(1.1)));
    }
    let height = |i: usize, j: usize| [0.0, 0.9, -0.7, 0.3, -0.8, 0.6, 0.1][(3 * i + 2 * j) % 7];
    let turn = Transform::rotate(DVec3::new(1.0, 2.0, 0.5), 0.3)
        .then(&Transform::try_scale(DVec3::new(1.4, 1.2, -0.8)).expect("regular"))
        .then(&Transform::translate(DVec3::new(0.0, 0.0, -1.8)));
    for column in 0..2 {
        let points = std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let i = 3 * column + i;
                DVec3::new(i as f64 / 3.0 - 1.0, j as f64 * 0.6 - 0.9, height(i, j))
            })
        });
        let weights = std::array::from_fn(|j| {
            std::array::from_fn(|i| 1.0 + ((3 * column + i + j) % 3) as f64 * 0.5)
        });
        let patch = BicubicPatch::try_rational(points, weights).expect("a patch");
        let cloth = Material::matte(Color::new(0.8, 0.5, 0.3)).with_reflection(Color::gray(0.2));
        scene = scene.add(Object::from(patch).material(cloth).transformed(&turn));
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
    render(scene, &options).expect("renders")
}
