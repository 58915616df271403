//! The size of a tile changes no bit, and no list that its rays are in.

use super::{PixelTracer, RenderOptions, Showing, render};
use crate::beam::BeamMask;
use crate::camera::PrimaryRays;
use crate::compile::{CompileOptions, compile};
use crate::film::Region;
use crate::tiles::TILE;
use strahl_geometry::{Cuboid, Sphere};
use strahl_math::DVec3;
use strahl_scene::{Background, Camera, Object, ObjectExt, Scene};
use strahl_shade::{Color, Light, Material};

#[test]
fn a_tile_of_four_megapixels_has_the_bits_of_small_tiles() {
    let mirror = Material::matte(Color::gray(0.2)).with_reflection(Color::gray(0.6));
    let floor = Cuboid::new(DVec3::new(-5.0, -0.2, -5.0), DVec3::new(5.0, 0.0, 5.0));
    let scene = Scene::new()
        .add(Object::from(floor))
        .add(Sphere::new(DVec3::Y, 1.0).material(mirror))
        .light(Light::point(DVec3::new(3.0, 5.0, 4.0), Color::WHITE))
        .background(Background::Solid(Color::new(0.2, 0.4, 0.7)))
        .camera(Camera::perspective(
            DVec3::new(0.0, 1.0, 6.0),
            DVec3::new(0.0, 1.2, 0.0),
            DVec3::Y,
            0.6,
        ));
    let scene = compile(&scene, &CompileOptions::default()).expect("a scene");
    let (width, height) = (2048, 2048);
    let options = RenderOptions::new(&scene, width, height);
    let picture = render(&scene, &options).expect("a picture");
    let rays = PrimaryRays::new(scene.camera(), width, height);
    // Beam culling finds out that the first small tile sees nothing; the large one sees something.
    let first = Region::full(TILE, TILE);
    assert!(BeamMask::of(first, &scene, &rays).is_empty(0, 0));
    let mut tracer = PixelTracer::new(&scene, &rays, &options, &());
    let tile = tracer.centers(Region::full(width, height));
    let pixels = Showing::of(&options).all(&tile.values).colors;
    assert_eq!(pixels.len(), picture.film.pixels.len());
    for (place, pixel) in tile.places().zip(&pixels) {
        assert_eq!(
            Some(*pixel),
            picture.film.pixel(place.0, place.1),
            "{place:?}"
        );
    }
    assert_eq!(tile.counts, picture.rays);
    // Objects and background, a mirror and shadows are in the picture.
    let counts = tile.counts;
    assert!(counts.primary_hit < counts.primary && counts.reflection > 100_000);
    assert!(counts.shadow_hit > 100_000, "{counts:?}");
    let bytes = tracer.tree.memory().total();
    assert!(bytes > 0 && bytes < 200_000, "{bytes}");
    let small = picture.batches.total();
    assert!(bytes <= 2 * small, "{bytes} {small}");
}
