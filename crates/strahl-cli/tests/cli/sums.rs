//! What `strahl explain` prints of a pixel multiplies and adds up to the pixel of the rendered picture.

use super::explain::{MIDDLE, json, pov, text};
use super::factors::check;
use std::sync::Arc;
use strahl::tracing::RenderScene;
use strahl::{LoadOptions, Output, Session, Threads};

/// Scenes, each with something that the trees of its pixels have.
const SCENES: [(&str, &str); 16] = [
    ("fresnel", "sphere { 0, 1.5 pigment { rgbf <.9, .95, 1, .9> } finish { phong .5 reflection { 0, 1 fresnel on } conserve_energy }
        interior { ior 1.5 fade_distance 1 fade_power 1001 fade_color <.5, .9, .7> } } plane { y, -2 pigment { checker rgb 1 rgb 0 } }"),
    ("weakened", "box { <-9, -9, 0>, 9 texture { pigment { rgb <.2, .4, .9> } finish { crand .1 } }
        texture { pigment { rgbft <1, .5, .3, .3, .4> } finish { specular .5 roughness .1 } } }
        box { <-2, 1.5, -2>, <2, 1.6, 0> pigment { rgbf <1, .5, .5, .8> } }"),
    ("specular", "sphere { 0, 1.5 texture { gradient x texture_map { [0 pigment { rgb x } finish { reflection .3 }]
        [1 pigment { rgbt <0, 1, 0, .4> } normal { bumps 1 } finish { specular .6 metallic }] } scale 4 translate -2 } }"),
    ("fog", "sphere { 0, 1 pigment { rgb 1 } finish { reflection { .1, .8 falloff 3 metallic } } } fog { distance 8 color rgb <.3, .4, .5> }"),
    ("area", "sphere { 0, 1 pigment { rgb 1 } } light_source { <0, 6, 0>, rgb .5 area_light 3*x, 3*z, 5, 5 adaptive 1 }
        box { <-1, 3, -1>, <.1, 3.2, 1> pigment { rgb 1 } }"),
    ("area_illumination", "plane { z, 0 pigment { rgb 1 } finish { phong .5 } }
        light_source { <0, 2, -6>, rgb .5 area_light 3*x, 3*z, 3, 3 area_illumination on }"),
    ("transparency", "sphere { 0, 1.5 pigment { rgbf 1 } finish { reflection .1 } interior { ior 1.5 dispersion 1.1 dispersion_samples 5 } }
        plane { -z, -5 pigment { gradient x } finish { ambient .5 emission .2 } }"),
    ("exponent", "sphere { 0, 1 pigment { rgb .2 } finish { reflection { .8 exponent .7 } } } plane { y, -2 pigment { rgb .9 } }"),
    ("irid", "sphere { 0, 1 pigment { rgb <.9, .8, .7> } finish { phong .4 specular .2 reflection { .1, .5 }
        irid { .5 thickness .7 turbulence .4 } } } plane { y, -2 pigment { rgb .9 } }"),
    ("blocked", "plane { z, 0 pigment { rgb 1 } finish { diffuse .4, .3 } } plane { -z, 5.5 pigment { rgb 1 } }"),
    ("lens", "sphere { 0, 1 pigment { rgb <1, .6, .3> } finish { phong .5 reflection .2 } } plane { y, -1 pigment { checker rgb 1 rgb .2 } }
        camera { location -5*z look_at 0 aperture .6 focal_point -z blur_samples 19 }"),
    ("lens", "plane { z, 2 pigment { checker rgb 1 rgb .2 } } sphere { 0, 1 pigment { rgbf .9 } interior { ior 1.4 } }
        camera { location -5*z look_at 0 aperture .8 focal_point 2*z blur_samples 40 variance 1/1000 confidence .9 } fog { distance 9 color rgb .3 }"),
    ("beside mask", "plane { z, 0 pigment { rgb 1 } finish { phong .5 } }
        light_source { <1, 2, -6>, rgb <.5, .6, .7> projected_through { union { box { <.2, 0, -3>, <.5, 2, -2.9> } sphere { <0, -1, -2>, .2 } } } }"),
    ("beside mask", "plane { z, 0 pigment { rgb 1 } } sphere { <-.3, 0, -.5>, .4 pigment { rgbf <1, .4, .4, .7> } }
        light_source { <0, 2, -6>, rgb <.5, .6, .7> area_light x, y, 3, 3 adaptive 1 projected_through { disc { <.2, .5, -3>, z, .5, .1 } } }"),
    ("weakened", "plane { z, 0 pigment { rgb 1 } finish { specular .4 } }
        box { <-2, -2, -2>, <4, 4, -1.9> pigment { checker rgbt 1 rgbf <.9, .5, .2, .8> scale .3 } no_image }"),
    ("weakened", "plane { z, 0 pigment { rgb 1 } }
        box { <-2, -2, -2>, <4, 4, -1.9> pigment { spotted color_map { [.5 rgbt 1] [.5 rgb 1] } scale .2 } no_image }"),
];

fn lit(scene: &str) -> tempfile::TempDir {
    pov(&format!(
        "light_source {{ <3, 5, -6>, rgb <1, .9, .8> }}\n{scene}"
    ))
}

/// Layers, blends, glass, media, fog, dispersion, area lights: the printed factors multiply to the printed products.
#[test]
fn factors_multiply_to_their_products_whatever_the_texture() {
    for (what, scene) in SCENES {
        let folder = lit(scene);
        let seen = check(&json(folder.path(), &MIDDLE));
        assert!(seen.contains(&what.to_owned()), "{what}: {seen:?}");
        for line in text(folder.path(), &MIDDLE).lines() {
            assert!(line.chars().count() <= 100, "{what}: {line}");
        }
    }
}

/// Every explained pixel has the bits of the picture, which is traced in packets and without an observer.
#[test]
fn explained_pixels_are_those_of_the_picture() {
    let session = Session::new(Threads::Count(1)).expect("a thread");
    let mut colors = 0;
    for (what, objects) in SCENES {
        let folder = lit(objects);
        let loaded = strahl::load_path(&folder.path().join("scene.pov"), LoadOptions::default());
        let description = loaded.scene.expect("a scene");
        let compiled = session.compile(&description, &Default::default());
        let (scene, _) = compiled.expect("valid");
        let mut seen = Vec::new();
        for sampling in ["center", "2x2", "corners", "adaptive", "recursive"] {
            let message = format!("{what}: {objects}");
            let (kinds, different) = explained(&session, &scene, sampling, &message);
            seen.extend(kinds);
            colors += different;
        }
        assert!(seen.contains(&what.to_owned()), "{what}: {seen:?}");
    }
    assert!(colors > 4 * 5 * SCENES.len(), "{colors}");
}

/// Compares pixels of a picture with what explains them. Returns what was seen in their trees, and how many
/// colours the pixels have.
fn explained(
    session: &Session,
    scene: &Arc<RenderScene>,
    sampling: &str,
    what: &str,
) -> (Vec<String>, usize) {
    let view = scene
        .view(40, 30)
        .with_sampling(sampling.parse().expect("a sampling"));
    let picture = session
        .picture(&view, &Output::default())
        .expect("a picture");
    let (mut seen, mut colors) = (Vec::new(), Vec::new());
    let columns = [22, 0, 39, 20, 14, 25, 17, 31];
    for (x, y) in columns.into_iter().zip([13, 0, 29, 15, 11, 19, 22, 7]) {
        let pixel = session.explain(&view, x, y).expect("a pixel");
        let message = format!("{sampling} {x},{y} of {what}");
        assert_eq!(Some(pixel.film), picture.film.pixel(x, y), "{message}");
        assert_eq!(pixel.color.map(|c| c as f32), pixel.film, "{message}");
        let json = serde_json::to_value(&pixel).expect("JSON");
        seen.extend(check(&json));
        colors.push(pixel.film.map(f32::to_bits));
    }
    colors.sort_unstable();
    colors.dedup();
    (seen, colors.len())
}
