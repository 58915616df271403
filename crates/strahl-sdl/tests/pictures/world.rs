//! Background, fog, rainbows and global settings.

use super::{CAMERA, LIGHT, SETTINGS, THINGS, lit};
use crate::common::pictures::agree;

#[test]
fn hidden_things_stay_hidden_behind_glass() {
    let room = "plane { y, -1 pigment { checker rgb 0.3 rgb 0.8 } } plane { z, 6 pigment { rgb <0.3, 0.5, 0.6> } finish { reflection 0.7 } }
                box { <-2, -1, -1>, <2, 1.5, -0.8> pigment { rgbt <0.9, 1, 0.9, 0.8> } interior { ior 1.3 } finish { reflection 0.3 } }";
    let scenes = ["", "no_image", "no_reflection", "no_image no_reflection"].map(|words| {
        let text = format!(
            "{SETTINGS}{CAMERA}{LIGHT}{room} sphere {{ <0.5, 0, 1.5>, 0.8 pigment {{ rgb <0.9, 0.2, 0.1> }} {words} }}
             sphere {{ <-0.8, 0, -2>, 0.5 pigment {{ rgb <0.1, 0.2, 0.9> }} {words} }}"
        );
        (words, text)
    });
    agree(0.01, &scenes);
}

#[test]
fn rainbows_stand_where_povrays_do() {
    let colors = "color_map { [0 rgbt <0.5, 0, 1, 1>] [0.2 rgbft <0.2, 0.4, 1, 0.3, 0.5>] [0.6 rgbt <1, 0.9, 0.2, 0.4>] [1 rgbt <1, 0, 0, 0.9>] }";
    let sky = "background { rgb <0.3, 0.4, 0.5> }";
    let scenes = [
        (
            "a ring",
            format!("rainbow {{ direction <-0.2, -0.3, 1> angle 18 width 10 {colors} }} {sky}"),
        ),
        (
            "an arc",
            format!(
                "rainbow {{ direction <-0.2, -0.3, 1> angle 18 width 10 arc_angle 150 falloff_angle 60 up <0.5, 1, 0> {colors} }} {sky}"
            ),
        ),
        (
            "sharp ends",
            format!(
                "rainbow {{ direction <-0.2, -0.3, 1> angle 18 width 10 arc_angle 150 {colors} }} {sky}"
            ),
        ),
        (
            "no ends",
            format!(
                "rainbow {{ direction <-0.2, -0.3, 1> angle 18 width 10 falloff_angle 50 {colors} }} {sky}"
            ),
        ),
        (
            "before things",
            format!(
                "rainbow {{ direction <-0.2, -0.3, 1> angle 16 width 14 distance 7 {colors} }} {sky}"
            ),
        ),
        (
            "in fog",
            format!(
                "rainbow {{ direction <-0.2, -0.3, 1> angle 16 width 14 distance 7 {colors} }} {sky} fog {{ distance 20 rgb <0.6, 0.6, 0.5> }}"
            ),
        ),
        (
            "two",
            format!(
                "rainbow {{ direction <-0.2, -0.3, 1> angle 16 width 10 {colors} }}
                 rainbow {{ direction <-0.2, -0.3, 1> angle 20 width 10 up x arc_angle 200 falloff_angle 40 {colors} }} {sky}"
            ),
        ),
    ];
    let scenes = scenes.map(|(name, text)| (name, lit(&format!("{LIGHT}{text}"))));
    agree(0.004, &scenes);
}

#[test]
fn turbulent_fog_is_as_thin_as_povrays() {
    let scenes = [
        ("constant", "fog { distance 8 rgb 0.7 turbulence 0.4 }"),
        (
            "on the ground",
            "fog { fog_type 2 distance 4 rgb <0.6, 0.7, 0.8> fog_offset -0.5 fog_alt 0.4 turbulence <0.7, 0.2, 1> turb_depth 0.8 }",
        ),
        (
            "octaves",
            "fog { distance 8 rgbt <0.6, 0.7, 0.8, 0.2> turbulence 1 turb_depth 1.5 octaves 2 omega 0.8 lambda 3 }",
        ),
        (
            "declared",
            "#declare F = fog { distance 8 rgb 0.7 turbulence 0.4 turb_depth 1 } fog { F } fog { F distance 30 rgb x turbulence 2 }",
        ),
        (
            "another noise",
            "global_settings { noise_generator 1 } fog { distance 8 rgb 0.7 turbulence 0.4 }",
        ),
        (
            "on the way from the light",
            "light_source { <-4, 5, -3>, rgb 1 media_attenuation on } fog { distance 12 rgb 0.3 turbulence 0.6 turb_depth 1 }",
        ),
    ];
    let scenes = scenes.map(|(name, text)| (name, lit(&format!("{LIGHT}{text}"))));
    agree(0.004, &scenes);
}

#[test]
fn layers_mirror_each_on_its_own() {
    let sky = "sky_sphere { pigment { gradient y color_map { [0 rgb <0.9, 0.5, 0.2>] [0.3 rgb <0.3, 0.5, 0.9>] [1 rgb <0.1, 0.1, 0.6>] } } }";
    let ball = |textures: &str| format!("{LIGHT}{sky} sphere {{ <0, 1, 0>, 1.4 {textures} }}");
    let scenes = [
        (
            "an exponent",
            ball("pigment { rgb 0.1 } finish { reflection { 0.7 exponent 0.5 } }"),
        ),
        (
            "an exponent above 1",
            ball("pigment { rgb 0.1 } finish { reflection { <0.7, 0.6, 0.3> exponent 1.8 } }"),
        ),
        (
            "an exponent of 0",
            ball("pigment { rgb 0.1 } finish { reflection { 0.7 exponent 0 } }"),
        ),
        (
            "the old word",
            ball("pigment { rgb 0.1 } finish { reflection 0.6 reflection_exponent 0.7 }"),
        ),
        (
            "falling off, metallic",
            ball("pigment { rgb <0.8, 0.6, 0.2> } finish { reflection { 0.1, 0.9 falloff 2 exponent 0.6 metallic } }"),
        ),
        (
            "bent and flat",
            ball(
                "texture { pigment { rgb 0.1 } normal { gradient x 1.5 scale 0.8 } finish { reflection 0.5 } }
                 texture { pigment { rgbt <0.5, 0.5, 0.5, 0.9> } finish { reflection 0.3 } }",
            ),
        ),
        (
            "two exponents",
            ball(
                "texture { pigment { rgb 0.1 } finish { reflection { 0.5 exponent 0.5 } } }
                 texture { pigment { rgbt <0.5, 0.5, 0.5, 0.9> } normal { gradient x 0.8 } finish { reflection 0.3 } }",
            ),
        ),
        (
            "blended",
            ball(
                "texture { gradient y texture_map { [0 pigment { rgb 0.1 } normal { gradient x 1.5 scale 0.8 } finish { reflection 0.8 }]
                   [1 pigment { rgb 0.2 } finish { reflection { 0.5 exponent 0.6 } }] } scale 3 translate -0.5 * y }",
            ),
        ),
        (
            "totally",
            format!(
                "{LIGHT}{sky} box {{ <-3, -0.5, -2>, <3, 0.2, 3> pigment {{ rgbt <1, 1, 1, 0.9> }} finish {{ reflection {{ 0.2 exponent 0.5 }} }} interior {{ ior 1.5 }} }} plane {{ y, -1 pigment {{ checker rgb 0.2 rgb 0.9 }} }}"
            ),
        ),
    ];
    let scenes = scenes.map(|(name, text)| (name, format!("{SETTINGS}{CAMERA}{text}")));
    agree(0.01, &scenes);
}

#[test]
fn the_air_is_povrays() {
    let hazy = |fog: &str| {
        format!("{SETTINGS}{CAMERA}background {{ rgb <0.2, 0.3, 0.5> }}{LIGHT}{fog}{THINGS}")
    };
    let scenes = [
        ("background", ""),
        ("fog", "fog { distance 8 rgb <0.6, 0.7, 0.8> }"),
        ("thin fog", "fog { distance 3 rgbt <0.6, 0.7, 0.8, 0.3> }"),
        (
            "tinting fog",
            "fog { distance 6 rgbft <0.8, 0.5, 0.2, 0.6, 0.1> }",
        ),
        (
            "ground fog",
            "fog { fog_type 2 distance 1 rgb <0.6, 0.7, 0.8> fog_offset -0.8 fog_alt 0.3 }",
        ),
        (
            "ground fog seen from inside",
            "fog { fog_type 2 distance 9 rgb 0.7 fog_offset 3 fog_alt 1 }",
        ),
        (
            "turned ground fog",
            "fog { fog_type 2 distance 2 rgb 0.7 fog_offset -0.5 fog_alt 0.5 up 2 * y rotate 30 * z }",
        ),
        (
            "two fogs",
            "fog { distance 12 rgb <0.6, 0.1, 0.1> } fog { fog_type 2 distance 2 rgb 0.7 fog_alt 0.4 }",
        ),
        (
            "declared",
            "#declare F = fog { distance 9 rgb 0.5 } fog { F color rgb <0.2, 0.6, 0.2> }",
        ),
        (
            "light in fog",
            "fog { distance 8 rgb <0.2, 0.1, 0.1> } light_source { <-3, 3, -3>, rgb 1 media_attenuation on }",
        ),
        (
            "sky sphere",
            "sky_sphere { pigment { rgb <0.6, 0.1, 0.1> } pigment { rgbt <0.1, 0.6, 0.1, 0.5> } emission 0.8 }",
        ),
    ];
    agree(0.004, &scenes.map(|(name, fog)| (name, hazy(fog))));
}

#[test]
fn global_settings_mean_the_same() {
    let mirrors = "
        plane { -z, -3 pigment { rgb 0 } finish { ambient 0 diffuse 0.1 reflection 0.9 } }
        plane { z, -8 pigment { rgb 0 } finish { ambient 0 diffuse 0.1 reflection 0.9 } }";
    let sheets: String = (0..9)
        .map(|i| format!("plane {{ z, -5 + {i} * 0.1 hollow pigment {{ rgbt <1, 0.5, 0.2, 0.9> }} finish {{ ambient 0.3 }} }}\n"))
        .collect();
    let with = |settings: &str, more: &str| format!("{settings}{CAMERA}{LIGHT}{THINGS}{more}");
    let scenes = [
        ("nothing", with("#version 3.7; global_settings { }", "")),
        ("no version", with("", "")),
        ("version 3.6", with("#version 3.6;", "")),
        (
            "gamma 1 in 3.6",
            with("#version 3.6; global_settings { assumed_gamma 1.0 }", ""),
        ),
        (
            "gamma 2.2",
            with("#version 3.7; global_settings { assumed_gamma 2.2 }", ""),
        ),
        (
            "gamma 1.4",
            with("#version 3.7; global_settings { assumed_gamma 1.4 }", ""),
        ),
        (
            "gamma srgb",
            with("#version 3.7; global_settings { assumed_gamma srgb }", ""),
        ),
        (
            "ambient",
            with(
                "#version 3.7; global_settings { assumed_gamma 1 ambient_light rgb <3, 2, 1> }",
                "",
            ),
        ),
        ("default level", with(SETTINGS, mirrors)),
        (
            "level 2",
            with(
                "#version 3.7; global_settings { assumed_gamma 1 max_trace_level 2 }",
                mirrors,
            ),
        ),
        (
            "level 12",
            with(
                "#version 3.7; global_settings { assumed_gamma 1 max_trace_level 12 adc_bailout 0 }",
                mirrors,
            ),
        ),
        (
            "bailout",
            with(
                "#version 3.7; global_settings { assumed_gamma 1 adc_bailout 0.5 }",
                mirrors,
            ),
        ),
        (
            "sheets are no levels",
            with(
                "#version 3.7; global_settings { assumed_gamma 1 max_trace_level 2 }",
                &sheets,
            ),
        ),
    ];
    agree(0.006, &scenes);
}
