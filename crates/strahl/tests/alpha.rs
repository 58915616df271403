//! The alpha channel of pictures, with POV-Ray 3.7's values (`+UA`), to the precision of 8-bit codes.

use strahl::{Format, LoadOptions, load_bytes};

/// Colours and alpha of the first pixel of the middle row, beside the sphere, and of the one in the middle of the sphere.
fn pixels(version: &str, rest: &str) -> [([f32; 3], f32); 2] {
    let text = format!(
        "#version {version}; global_settings {{ assumed_gamma 1 }}\n\
         camera {{ orthographic location -5*z look_at 0 up y*3 right x*9 }}\n{rest}"
    );
    let loaded = load_bytes(
        text.into_bytes(),
        "alpha.pov",
        Format::Pov,
        LoadOptions::default(),
    );
    let scene = loaded.scene.expect("a valid scene");
    let scene =
        strahl::compile(&scene, &strahl::tracing::CompileOptions::default()).expect("valid");
    let mut options = strahl::tracing::RenderOptions::new(&scene, 9, 3);
    options.alpha = true;
    let film = strahl::render(&scene, &options).expect("a picture").film;
    let alpha = film.alpha.as_ref().expect("asked for");
    [9, 13].map(|at| (film.pixels[at], alpha[at]))
}

fn sphere(pigment: &str, finish: &str) -> String {
    format!("sphere {{ 0, 1 pigment {{ {pigment} }} finish {{ diffuse 0 {finish} }} }}")
}

#[track_caller]
fn is(found: ([f32; 3], f32), color: [f32; 3], alpha: u8) {
    let code = (found.1 * 255.0).round() as u8;
    assert!(
        code.abs_diff(alpha) <= 1,
        "{found:?}: alpha {code}, not {alpha}"
    );
    for (a, b) in found.0.iter().zip(color) {
        assert!((a - b).abs() < 0.003, "{found:?} is not {color:?}");
    }
}

#[test]
fn the_background_is_left_out_as_far_as_it_is_see_through() {
    let orange = sphere("rgb <1, .5, 0>", "ambient 1");
    let blue = "background { rgb <0, 0, .5> }";
    for (version, background, color, alpha) in [
        ("3.7", "", [0.0; 3], 0),
        ("3.7", blue, [0.0, 0.0, 0.5], 255),
        ("3.7", "background { rgbt <0, 0, .5, 1> }", [0.0; 3], 0),
        (
            "3.7",
            "background { rgbt <0, 0, .5, .5> }",
            [0.0, 0.0, 0.25],
            128,
        ),
        ("3.6", blue, [0.0; 3], 0),
        ("3.7", "sky_sphere { pigment { rgb .5 } }", [0.5; 3], 255),
        ("3.6", "sky_sphere { pigment { rgb .5 } }", [0.0; 3], 0),
        ("3.7", "fog { distance 5 rgb .5 }", [0.5; 3], 255),
    ] {
        let [beside, inside] = pixels(version, &format!("{background} {orange}"));
        is(beside, color, alpha);
        assert_eq!(inside.1, 1.0, "{background}");
    }
}

#[test]
fn clear_things_are_see_through_and_mirrors_are_not() {
    let clear = "background { rgbt <0, 0, .5, 1> }";
    let [_, half] = pixels(
        "3.7",
        &format!("{clear} {}", sphere("rgbt <1, .5, 0, .5>", "ambient 1")),
    );
    is(half, [0.75, 0.375, 0.0], 191);
    let [_, filter] = pixels(
        "3.7",
        &format!("{clear} {}", sphere("rgbf <1, .5, 0, 1>", "ambient 0")),
    );
    is(filter, [0.0; 3], 166);
    let [beside, mirror] = pixels("3.7", &sphere("rgb 0", "ambient 0 reflection 1"));
    is(beside, [0.0; 3], 0);
    is(mirror, [0.0; 3], 255);
}
