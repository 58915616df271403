//! Names without `object { }`, values between blocks, and corners at infinity.

use crate::common::pictures::agree;

const VIEW: &str = "#version 3.7; global_settings { assumed_gamma 1 }
    camera { location <0, 1, -5> look_at 0 } light_source { <5, 5, -5> rgb 1 }
    #declare S = sphere { 0, 1 pigment { rgb x } } #declare B = box { -1, 1 } #declare P = plane { x, 0 }
    #declare L = light_source { <-5, 0, -5> rgb 1 }\n";

const FLAT: &str = "#version 3.7; global_settings { assumed_gamma 1 }
    camera { orthographic location -5*z right 4*x up 3*y look_at 0 }
    #default { finish { ambient 1 diffuse 0 } }\n";

fn scenes(view: &str, list: &[(&'static str, &str)]) -> Vec<(&'static str, String)> {
    let texts = list.iter();
    texts
        .map(|(name, text)| (*name, format!("{view}{text}")))
        .collect()
}

#[test]
fn names_look_as_with_object_around_them() {
    let list = [
        ("a name", "S"),
        (
            "clipped and moved",
            "sphere { 0, 2 pigment { rgb 1 } clipped_by { box { -1, 2 } P translate 0.5 * x } }",
        ),
        (
            "clipped by a turned name",
            "sphere { 0, 2 pigment { rgb 1 } clipped_by { B rotate 30 * z translate x } }",
        ),
        (
            "in a difference",
            "difference { sphere { 0, 1.3 } B pigment { rgb 1 } }",
        ),
        (
            "a group of lights",
            "light_group { L S } sphere { x, 1 pigment { rgb 1 } }",
        ),
        (
            "a light in an object",
            "light_group { object { L } S } sphere { x, 1 pigment { rgb 1 } }",
        ),
        (
            "a macro of a name",
            "#macro M() #local Q = sphere { 0, 1 pigment { rgb x } }; Q #end object { M() translate x }",
        ),
        (
            "a box to infinity",
            "box { -1, <1 / 0, 1, 1> pigment { rgb 1 } scale 0.5 rotate 20 * y }",
        ),
    ];
    agree(0.01, &scenes(VIEW, &list));
}

#[test]
fn frequency_and_waves_blend_the_blocks() {
    let pigment = |text: &str| format!("plane {{ z, 0.1 pigment {{ {text} scale 0.37 }} }}");
    let (two, three) = (
        "color rgb x color rgb y",
        "color rgb x color rgb y color rgb z",
    );
    let cases = [
        ("checker, half", format!("checker {two} frequency 0.5")),
        (
            "checker, three halves",
            format!("checker {two} frequency 1.5"),
        ),
        ("checker, negative", format!("checker {two} frequency -1")),
        (
            "checker, sine",
            format!("checker {two} sine_wave frequency 3"),
        ),
        (
            "checker, phase",
            format!("checker {two} phase 0.5 frequency 2"),
        ),
        (
            "hexagon, half",
            format!("hexagon {three} frequency 0.5 rotate 90 * x"),
        ),
        (
            "hexagon, twice",
            format!("hexagon {three} frequency 2 rotate 90 * x"),
        ),
        ("brick, sine", format!("brick {two} sine_wave scale 0.3")),
        (
            "object, sine",
            format!("object {{ sphere {{ 0, 1 }} {two} }} sine_wave"),
        ),
    ];
    let list: Vec<_> = cases
        .iter()
        .map(|(name, text)| (*name, pigment(text)))
        .collect();
    let list: Vec<_> = list
        .iter()
        .map(|(name, text)| (*name, text.as_str()))
        .collect();
    agree(0.01, &scenes(FLAT, &list));
}
