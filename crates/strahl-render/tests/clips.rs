//! Shapes that are clipped.

use crate::common::compiled;
use strahl_geometry::{Cuboid, MeshData, Plane, Sphere, TriangleMesh};
use strahl_math::{DVec3, Transform};
use strahl_render::{RenderOptions, RenderScene, render};
use strahl_scene::{Camera, CsgOp, Object, ObjectExt, Scene};
use strahl_shade::{Color, Light, Material};

/// An object in front of a floor.
fn scene(object: Object) -> RenderScene {
    let grass = Material::matte(Color::new(0.2, 0.6, 0.1));
    compiled(
        &Scene::new()
            .add(object)
            .add(Plane::new(DVec3::Y * -1.0, DVec3::Y).material(grass))
            .light(Light::point(DVec3::new(3.0, 5.0, 4.0), Color::gray(0.9)))
            .camera(Camera::perspective(
                DVec3::new(0.0, 1.0, 6.0),
                DVec3::ZERO,
                DVec3::Y,
                0.7,
            )),
    )
}

/// A roof of two triangles.
fn roof() -> TriangleMesh {
    let vertices = [
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.2],
        [0.3, -0.8, 0.5],
    ];
    let data = MeshData::from_f64(&vertices, vec![[0, 1, 2], [1, 0, 3]]);
    TriangleMesh::try_new(data).expect("a mesh")
}

fn picture(scene: &RenderScene) -> Vec<[f32; 3]> {
    let rendered = render(scene, &RenderOptions::new(scene, 64, 48)).expect("a picture");
    rendered.film.pixels.clone()
}

fn clipped(shape: Object, by: Object) -> Object {
    let red = Material::matte(Color::new(0.8, 0.1, 0.1));
    Object::csg(CsgOp::Clip, vec![shape, by]).material(red)
}

#[test]
fn a_clip_that_cuts_nothing_off_is_left_out() {
    let around = |top: f64| {
        let corner = DVec3::new(3.0, top, 3.0);
        Object::from(Cuboid::new(-DVec3::splat(3.0), corner))
    };
    let shapes: [fn() -> Object; 2] =
        [|| Sphere::new(DVec3::X * 0.2, 1.0).into(), || roof().into()];
    for shape in shapes {
        let red = Material::matte(Color::new(0.8, 0.1, 0.1));
        let whole = scene(shape().material(red));
        let loose = scene(clipped(shape(), around(2e9)));
        let tight = scene(clipped(shape(), around(0.5)));
        // A clip that cuts is an object of its own.
        let objects = |scene: &RenderScene| scene.stats().objects;
        assert_eq!(objects(&loose), objects(&whole));
        assert_eq!(objects(&tight), objects(&whole) + 1);
        let [whole, loose, tight] = [&whole, &loose, &tight].map(picture);
        assert!(whole == loose);
        assert!(whole != tight);
        // A face of the clip lies where the shape ends: rounding decides what is seen there, as before.
        let touching = scene(clipped(shape(), around(1.0)));
        assert_eq!(objects(&touching), 3);
    }
}

#[test]
fn a_clip_is_left_out_only_where_the_shape_is() {
    let box_around = || Object::from(Cuboid::new(-DVec3::splat(1.5), DVec3::splat(1.5)));
    let ball = || Object::from(Sphere::new(DVec3::ZERO, 1.0));
    let objects = |object: Object| scene(object).stats().objects;
    // Both are moved.
    assert_eq!(
        objects(clipped(ball(), box_around()).translated(DVec3::X)),
        2
    );
    // Only one is.
    assert_eq!(
        objects(clipped(ball().translated(DVec3::X), box_around())),
        3
    );
    assert_eq!(
        objects(clipped(ball(), box_around().translated(DVec3::Y))),
        3
    );
    // The outside of a box is not convex, and a shape without an end lies in no box.
    let outside = Object::csg(CsgOp::Inverse, vec![box_around()]);
    assert_eq!(objects(clipped(ball(), outside)), 3);
    let floor = Object::from(Plane::new(DVec3::ZERO, DVec3::Y));
    assert_eq!(objects(clipped(floor, box_around())), 3);
    // Meshes that are moved stay in the tree, which needs no copy of them.
    let turned = Object::from(roof()).transformed(&Transform::rotate(DVec3::Y, 0.3));
    assert_eq!(objects(clipped(turned, box_around())), 3);
}
