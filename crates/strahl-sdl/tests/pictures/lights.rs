//! Lights, light groups and shadows.

use super::{CAMERA, LIGHT, SETTINGS, lit};
use crate::common::pictures::agree;

#[test]
fn lights_shine_as_povrays() {
    let scenes = [
        ("point", LIGHT),
        (
            "two",
            "light_source { <4, 6, -5>, rgb <0.7, 0.6, 0.3> } light_source { <-4, 3, -5>, rgb <0.1, 0.2, 0.4> }",
        ),
        (
            "spot",
            "light_source { <2, 5, -3>, rgb 1.2 spotlight point_at <0, -0.5, 0> radius 10 falloff 25 }",
        ),
        (
            "tight spot",
            "light_source { <2, 5, -3>, rgb 1.2 spotlight point_at 0 radius 15 falloff 40 tightness 12 }",
        ),
        (
            "default spot",
            "light_source { <0, 3, -3>, rgb 1 spotlight point_at <0, -1, 1> }",
        ),
        (
            "sharp spot",
            "light_source { <2, 5, -3>, rgb 1 spotlight point_at 0 radius 30 falloff 10 }",
        ),
        (
            "cylinder",
            "light_source { <2, 5, -3>, rgb 1 cylinder point_at <0, -1, 0> radius 0.8 falloff 1.6 }",
        ),
        (
            "tight cylinder",
            "light_source { <2, 5, -3>, rgb 1 cylinder point_at <0, -1, 0> radius 0.5 falloff 2 tightness 4 }",
        ),
        (
            "default cylinder",
            "light_source { <1, 5, -3>, rgb 1 cylinder point_at <-1, 0, 0> }",
        ),
        (
            "parallel",
            "light_source { <2, 5, -3>, rgb 1 parallel point_at 0 }",
        ),
        (
            "parallel through things",
            "light_source { <-0.5, 0.3, 0>, rgb 1 parallel point_at <-1, -1, 1> }",
        ),
        (
            "parallel spot",
            "light_source { <2, 5, -3>, rgb 1 spotlight radius 5 falloff 9 parallel point_at 0 }",
        ),
        (
            "parallel fading",
            "light_source { <2, 5, -3>, rgb 1 parallel point_at 0 fade_distance 5 fade_power 2 }",
        ),
        (
            "shadowless",
            "light_source { <4, 6, -5>, rgb 1 shadowless }",
        ),
        (
            "fading",
            "light_source { <2, 3, -3>, rgb 0.9 fade_distance 4 fade_power 1.5 }",
        ),
        (
            "moved",
            "light_source { 0, rgb 1 spotlight point_at -y radius 20 falloff 30 rotate <20, 30, 0> translate <1, 4, -1> }",
        ),
        (
            "declared",
            "#declare L = light_source { 0, rgb 0.8 } light_source { L translate <4, 6, -5> } object { L translate <-4, 6, -5> }",
        ),
        (
            "in a union",
            "union { light_source { <0, 3, 0>, rgb 0.8 } sphere { <0, 2.5, 1>, 0.2 pigment { rgb 1 } } translate <1, 1, -1> }",
        ),
        (
            "in a difference",
            "difference { sphere { <0, 3, 1>, 0.5 } light_source { <0, 4, -3>, rgb 0.8 } box { <-1, 3, -1>, 1 } pigment { rgb 1 } rotate 20 * y }",
        ),
        (
            "with looks",
            "light_source { <1, 2, -1>, rgb 0.8 looks_like { sphere { 0, 0.3 pigment { rgb <1, 1, 0> } finish { ambient 1 } } } }",
        ),
    ];
    let scenes = scenes.map(|(name, light)| (name, lit(light)));
    agree(0.004, &scenes);
}

#[test]
fn groups_of_lights_shine_on_their_own() {
    let red = "light_source { <4, 6, -5>, rgb <1, 0.2, 0.1> }";
    let ball = "sphere { <-0.9, 0, 0.5>, 1 pigment { rgb 0.9 } }";
    let dice = "box { <0.6, -1, -1>, <1.4, -0.2, -0.2> pigment { rgb <0.4, 0.8, 0.5> } }";
    let floor = "plane { y, -1 pigment { rgb <0.8, 0.7, 0.6> } }";
    let sun = "light_source { <-3, 5, -6>, rgb <0.3, 0.4, 0.5> }";
    let scenes = [
        (
            "alone",
            format!("light_group {{ {red} {ball} }} {dice} {floor} {sun}"),
        ),
        (
            "with the others",
            format!("light_group {{ {red} {ball} global_lights on }} {dice} {floor} {sun}"),
        ),
        (
            "shadows of strangers",
            format!("light_group {{ {red} {floor} {ball} global_lights off }} {dice} {sun}"),
        ),
        (
            "without lights",
            format!("light_group {{ {ball} global_lights off }} {dice} {floor} {sun}"),
        ),
        (
            "within each other",
            format!(
                "light_group {{ {red} {ball} light_group {{ light_source {{ <5, 3, -4>, rgb <0, 0, 1> }} {dice} }} global_lights on }} {floor} {sun}"
            ),
        ),
        (
            "the outermost decides",
            format!(
                "light_group {{ {red} {ball} union {{ light_group {{ light_source {{ <5, 3, -4>, rgb <0, 0, 1> }} {dice} global_lights on }} }} }} {floor} {sun}"
            ),
        ),
        (
            "declared within another",
            format!(
                "#declare G = light_group {{ light_source {{ <5, 3, -4>, rgb <0, 0, 1> }} {dice} }} light_group {{ {red} {ball} G }} {floor} {sun}"
            ),
        ),
        (
            "declared within two others",
            format!(
                "#declare G = light_group {{ light_source {{ <5, 3, -4>, rgb <0, 0, 1> }} {dice} }}
                 #declare H = light_group {{ light_source {{ <-4, 3, -4>, rgb <0, 0.7, 0> }} union {{ object {{ G }} {ball} }} }}
                 light_group {{ {red} {floor} light_group {{ H }} }} {sun}"
            ),
        ),
        (
            "declared together",
            format!(
                "#declare G = light_group {{ {red} {ball} light_group {{ light_source {{ <5, 3, -4>, rgb <0, 0, 1> }} {dice} }} }} object {{ G }} {floor} {sun}"
            ),
        ),
        (
            "without lights within another",
            format!("light_group {{ {red} {ball} light_group {{ {dice} }} }} {floor} {sun}"),
        ),
        (
            "lights of unions shine on all",
            format!("light_group {{ union {{ {red} {ball} }} {dice} }} {floor} {sun}"),
        ),
        (
            "in operations",
            format!(
                "light_group {{ {red} difference {{ {ball} sphere {{ <-0.6, 0.4, -0.5>, 0.6 }} pigment {{ rgb 0.7 }} }} }} {dice} {floor} {sun}"
            ),
        ),
        (
            "moved",
            format!(
                "#declare G = light_group {{ {red} {ball} }} object {{ G rotate 20 * y translate <0.3, 0.2, 0> }} object {{ G scale 0.4 translate 1.6 * x }} {floor} {sun}"
            ),
        ),
        (
            "shared",
            format!(
                "#declare U = union {{ #for (I, 0, 20) sphere {{ <I / 10 - 1, I / 10 - 1, 0>, 0.3 pigment {{ rgb <1, I / 20, 0.5> }} }} #end }}
                 light_group {{ {red} object {{ U }} }} object {{ U translate x }} object {{ U translate -x }} {floor} {sun}"
            ),
        ),
        (
            "seen in a mirror",
            format!(
                "light_group {{ {red} {ball} }} {dice} plane {{ -z, -3 pigment {{ rgb 0 }} finish {{ reflection 0.9 }} }} {sun}"
            ),
        ),
    ];
    let scenes = scenes.map(|(name, text)| (name, format!("{SETTINGS}{CAMERA}{text}")));
    agree(0.004, &scenes);
}

#[test]
fn light_from_behind_shows_on_both_sides() {
    let sheet = |rest: &str| {
        format!(
            "box {{ <-0.8, -0.8, 0>, <0.8, 0.8, 0.01> rotate <20, 30, 0> {rest} }} disc {{ <1.2, 0.8, 0>, <0.3, 0.2, -1>, 0.8 {rest} }}
             triangle {{ <-2, -1, 0>, <-1, 1, 0.4>, <-2.4, 1, 0.2> {rest} }} sphere {{ <2.2, -0.8, 1>, 0.5 {rest} }}"
        )
    };
    let color = "pigment { rgbt <0.9, 0.7, 0.4, 0.2> }";
    let scenes = [
        ("one side", sheet(color)),
        ("both sides", sheet(&format!("{color} double_illuminate"))),
        (
            "both sides and back light",
            sheet(&format!(
                "{color} finish {{ diffuse 0.5, 0.2 brilliance 2 }} double_illuminate"
            )),
        ),
        (
            "highlights",
            sheet(&format!(
                "{color} finish {{ diffuse 0.4 specular 0.8 roughness 0.3 phong 0.5 phong_size 3 metallic }} double_illuminate"
            )),
        ),
        (
            "of a union",
            format!("union {{ {} double_illuminate }}", sheet(color)),
        ),
        (
            "switched off",
            format!(
                "union {{ {} }}",
                sheet(&format!("{color} double_illuminate off"))
            ),
        ),
        (
            "with a normal",
            sheet(&format!(
                "{color} normal {{ bumps 0.3 scale 0.2 }} double_illuminate"
            )),
        ),
    ];
    let light =
        "light_source { <3, 4, 6>, rgb 1 } light_source { <-2, 3, -6>, rgb <0.1, 0.1, 0.3> }";
    let scenes = scenes.map(|(name, text)| (name, format!("{SETTINGS}{CAMERA}{light}{text}")));
    agree(0.004, &scenes);
}

#[test]
fn lights_shine_through_what_they_must_cross() {
    let window = "union { box { <0.5, 2, -3>, <2, 3.5, -2.9> } sphere { <3, 2.5, -2>, 0.6 } }";
    let scenes = [
        (
            "a window",
            format!("light_source {{ <4, 6, -5>, rgb 1 projected_through {{ {window} }} }}"),
        ),
        (
            "things before it",
            format!(
                "light_source {{ <4, 6, -5>, rgb 1 projected_through {{ {window} }} }} sphere {{ <2.4, 4.2, -3.9>, 0.5 }}"
            ),
        ),
        (
            "things behind it",
            format!(
                "light_source {{ <4, 6, -5>, rgb 1 projected_through {{ {window} }} }} sphere {{ <0.6, 1.6, -1.9>, 0.3 }}"
            ),
        ),
        (
            "no shadows",
            format!(
                "light_source {{ <4, 6, -5>, rgb 1 shadowless projected_through {{ {window} }} }}"
            ),
        ),
        (
            "from within",
            "light_source { <1, 3, -2>, rgb 1 projected_through { box { <0, 0.5, -4>, <2, 4, 1> } } }"
                .to_owned(),
        ),
        (
            "a spot",
            "light_source { <2, 5, -3>, rgb 1.2 spotlight point_at 0 radius 15 falloff 40 projected_through { disc { <1, 2.5, -1.5>, <2, 5, -3>, 0.5, 0.2 } } }"
                .to_owned(),
        ),
        (
            "declared and moved",
            format!(
                "#declare W = {window} #declare L = light_source {{ <4, 6, -5>, rgb 0.6 projected_through {{ W }} }}
                 light_source {{ L }} light_source {{ L translate <-4, 0, 1> rotate 20 * y }}"
            ),
        ),
        (
            "of many parts",
            "#declare W = union { #for (I, 0, 5) #for (J, 0, 5) box { <I / 2, 2, J / 2 - 3>, <I / 2 + 0.3, 2.1, J / 2 - 2.7> } #end #end }
             light_source { <2, 6, -3>, rgb 1 projected_through { W } }"
                .to_owned(),
        ),
        (
            "that are seen too",
            "#declare W = union { torus { 0.5, 0.15 } box { -0.3, 0.3 } rotate <40, 30, 20> translate <1.5, 1.5, -2> }
             light_source { <4, 6, -5>, rgb 1 projected_through { W } } light_source { <-4, 6, -5>, rgb 0.3 } object { W pigment { rgb x } }"
                .to_owned(),
        ),
        (
            "in a group",
            format!(
                "light_group {{ light_source {{ <4, 6, -5>, rgb 1 projected_through {{ {window} }} }} sphere {{ <-0.9, 0, 0.5>, 1.01 pigment {{ rgb 1 }} }} translate 0.1 * y }} light_source {{ <-4, 6, -5>, rgb 0.3 }}"
            ),
        ),
    ];
    let scenes = scenes.map(|(name, light)| (name, lit(&light)));
    agree(0.006, &scenes);
    let area = "light_source { <4, 6, -5>, rgb 1 area_light 0.6 * x, 0.6 * z, 5, 5 projected_through { box { <0.5, 2, -3>, <2, 3.5, -2.9> } } }";
    agree(0.02, &[("an area", lit(area))]);
}

#[test]
fn lights_with_an_extent_shine_as_povrays() {
    let scenes = [
        (
            "line",
            "light_source { <3, 5, -4>, rgb 1 area_light <3, 0, 0>, <0, 0, 1>, 6, 1 }",
        ),
        (
            "grid",
            "light_source { <3, 5, -4>, rgb 1 area_light <3, 0, 0>, <0, 3, 3>, 5, 4 }",
        ),
        (
            "adaptive",
            "light_source { <3, 5, -4>, rgb 1 area_light <3, 0, 0>, <0, 3, 3>, 9, 9 adaptive 1 }",
        ),
        (
            "circular",
            "light_source { <3, 5, -4>, rgb 1 area_light <3, 0, 0>, <0, 3, 3>, 7, 7 circular }",
        ),
        (
            "oriented",
            "light_source { <3, 5, -4>, rgb 1 area_light 3 * x, 3 * z, 5, 5 circular orient }",
        ),
        (
            "spot",
            "light_source { <3, 5, -4>, rgb 1 spotlight point_at 0 radius 10 falloff 20 area_light 2 * x, 2 * z, 5, 5 }",
        ),
        (
            "parallel",
            "light_source { <3, 5, -4>, rgb 1 parallel point_at 0 area_light 2 * x, 2 * z, 5, 5 }",
        ),
        (
            "illuminating",
            "light_source { <1, 3, -2>, rgb 1 area_light 3 * x, 3 * z, 5, 5 area_illumination on }",
        ),
        (
            "large and jittered",
            "light_source { <3, 5, -4>, rgb 1 area_light 2 * x, 2 * z, 33, 33 jitter }",
        ),
    ];
    let scenes = scenes.map(|(name, light)| (name, lit(light)));
    agree(0.01, &scenes);
}
