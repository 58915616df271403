//! Small pictures of planes and spheres, rendered by POV-Ray 3.7 and here: lights, cameras, fog and global settings.
//!
//! Both write linear values. What differs at all are single pixels on the edges of objects and shadows.

mod common;

use common::pictures::{agree, agree_within};

/// Things to light and to see.
const THINGS: &str = "
plane { y, -1 pigment { rgb <0.8, 0.7, 0.6> } finish { ambient 0.05 diffuse 0.8 } }
sphere { <-0.9, 0, 0.5>, 1 pigment { rgb <0.9, 0.2, 0.1> } finish { ambient 0.1 diffuse 0.7 phong 0.6 phong_size 20 } }
sphere { <1.1, -0.4, -0.5>, 0.6 pigment { rgb <0.2, 0.4, 0.9> } finish { diffuse 0.6 reflection 0.3 } }
sphere { <0.4, 0.7, 1.5>, 0.5 pigment { rgbf <0.5, 1, 0.6, 0.7> } finish { ambient 0 diffuse 0.5 } }
";
const CAMERA: &str = "camera { location <1, 2, -6> look_at <0, 0, 0> angle 50 }\n";
const LIGHT: &str = "light_source { <4, 6, -5>, rgb 1 }\n";
const SETTINGS: &str = "#version 3.7; global_settings { assumed_gamma 1 }\n";

fn lit(light: &str) -> String {
    format!("{SETTINGS}{CAMERA}{light}{THINGS}")
}

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

fn seen(camera: &str) -> String {
    format!("{SETTINGS}camera {{ {camera} }}\n{LIGHT}{THINGS}")
}

#[test]
fn wide_cameras_see_as_povrays() {
    let place = "location <1, 2, -6> look_at <0, 0, 0>";
    let scenes = [
        ("fisheye", "fisheye angle 150"),
        ("all around", "fisheye angle 360 right x up y"),
        ("mirrored fisheye", "fisheye right -x up 0.75 * y"),
        ("ultra wide angle", "ultra_wide_angle angle 160"),
        ("omnimax", "omnimax angle 100"),
        ("narrow omnimax", "omnimax right 0.8 * x up y"),
        ("panoramic", "panoramic angle 120"),
        ("cylinder 1", "cylinder 1 angle 150 right 2 * x up 2 * y"),
        ("cylinder 2", "cylinder 2 angle 90 right 1.5 * x"),
        ("cylinder 3", "cylinder 3 angle 220 right 2 * x up 4 * y"),
        ("cylinder 4", "cylinder 4 angle 90 right 4 * x up 3 * y"),
        ("spherical", "spherical angle 270, 100"),
        ("half as high", "spherical angle 160"),
        (
            "mirrored sphere",
            "spherical right -x angle 160 rotate 20 * z scale <1, 1.5, 1>",
        ),
        ("bumpy", "normal { bumps 0.3 scale 0.2 }"),
        (
            "wavy fisheye",
            "fisheye angle 150 normal { bumps 0.2 scale 0.3 rotate 20 * x }",
        ),
    ];
    let scenes = scenes.map(|(name, camera)| (name, seen(&format!("{camera} {place}"))));
    agree(0.01, &scenes);
}

#[test]
fn meshes_see_as_povrays() {
    // A face for each pixel, with uv coordinates of its place.
    let face = "#macro Face(I, J)
          triangle {
            <I / 10 - 3.2, 2.4 - J / 10, -4>, <I / 10 - 3.1, 2.4 - J / 10, -4>, <I / 10 - 3.2, 2.3 - J / 10, -4>
            uv_vectors <I, 48 - J> / <64, 48>, <I + 1, 48 - J> / <64, 48>, <I, 47 - J> / <64, 48>
          }
        #end
        #macro Grid(W, H, D) mesh { #for (J, 0, H - 1) #for (I, 0, W - 1) Face(I + D, J) #end #end } #end
        #declare G = Grid(64, 48, 0)
        #declare Half = Grid(32, 48, 10)
        #declare Top = Grid(64, 20, 0)
        #declare Rest = Grid(64, 28, 0)\n";
    let scenes = [
        ("each", "mesh_camera { 1 0 mesh { G } }"),
        (
            "backwards",
            "mesh_camera { 1 0 mesh { G translate 8 * z } } location <0, 0, 0.5> direction -z",
        ),
        (
            "several",
            "mesh_camera { 2 0 mesh { G } mesh { G rotate 20 * y } }",
        ),
        (
            "joined",
            "mesh_camera { 1 1 mesh { Top } mesh { Rest translate 0.3 * x } }",
        ),
        (
            "side by side",
            "mesh_camera { 1 2 mesh { Half } mesh { Half translate 0.5 * x } }",
        ),
        ("by uv", "mesh_camera { 1 3 mesh { G } }"),
    ];
    let scenes = scenes.map(|(name, camera)| {
        let text = seen(camera).replace("\ncamera {", &format!("\n{face}camera {{"));
        (name, text)
    });
    // POV-Ray takes the faces of the row above, but for the first row, so the pictures are a pixel apart.
    agree_within(3.0 / 255.0, 0.15, &scenes);
}

#[test]
fn lenses_blur_as_povrays() {
    // Both draw places on the lens, POV-Ray in the pixel too. (Its orthographic cameras with a lens show a single point.)
    let lens = "location <1, 2, -6> look_at 0 aperture 0.8 blur_samples 400, 400 variance 0 confidence 0.99";
    let scenes = [
        ("before the plane", "focal_point <0, 0, 6>"),
        ("within the scene", "focal_point <0, 0, 0>"),
        ("turned", "focal_point <0, 0, 3> rotate 30 * y translate x"),
        (
            "long lens",
            "focal_point <0, 0, 6> right 3 * x up 2.25 * y direction 2 * z",
        ),
    ];
    let scenes = scenes.map(|(name, more)| (name, seen(&format!("{more} {lens}"))));
    agree_within(1.0 / 255.0, 0.06, &scenes);
}

#[test]
fn cameras_see_as_povrays() {
    let scenes = [
        ("default lens", "location <0, 1, -7>"),
        (
            "looking before standing",
            "look_at <0, 0, 0> location <3, 2, -5>",
        ),
        (
            "right-handed",
            "location <1, 2, -6> right -4/3 * x look_at 0",
        ),
        (
            "square pixels",
            "location <1, 2, -6> right x * image_width / image_height look_at 0",
        ),
        (
            "wide pixels",
            "location <1, 2, -6> right 2 * x up y look_at 0",
        ),
        (
            "exporter",
            "location <0, 0, -8> direction <0, 0, 2.5> right <1.33, 0, 0> up <0, 1, 0> sky <0, 1, 0>",
        ),
        (
            "z up",
            "location <6, 1, 4> sky z up z right 4/3 * x angle 45 look_at <0, 0, 0.5>",
        ),
        ("tilted sky", "location <1, 2, -6> sky <1, 2, 0> look_at 0"),
        (
            "angle before right",
            "angle 60 right 1.6 * x up 1.2 * y location <1, 2, -6> look_at 0",
        ),
        (
            "turned before",
            "rotate 20 * y location <0, 1, -6> look_at <0, 0.5, 0>",
        ),
        (
            "turned after",
            "location <0, 1, -6> look_at <0, 0.5, 0> rotate 20 * y translate 0.5 * x",
        ),
        ("from above", "location <0, 8, 0> look_at 0 angle 40"),
        (
            "skewed",
            "location <1, 2, -6> right <1.33, 0.3, 0> up <0, 1, 0.2> direction <0.1, -0.2, 1>",
        ),
        (
            "orthographic",
            "orthographic location <1, 2, -6> right 6 * x up 4.5 * y look_at 0",
        ),
        (
            "orthographic as perspective",
            "orthographic location <1, 2, -6> look_at 0",
        ),
        (
            "orthographic by angle",
            "orthographic angle 40 location <1, 2, -6> right 2 * x up 1.2 * y look_at 0",
        ),
        (
            "orthographic without a point",
            "orthographic location <0, 0.5, -5> direction 2 * z",
        ),
    ];
    agree(0.004, &scenes.map(|(name, camera)| (name, seen(camera))));
}

#[test]
fn a_declared_camera_can_be_moved() {
    let text = format!(
        "{SETTINGS}#declare C = camera {{ location <0, 1, -6> look_at 0 angle 40 }} camera {{ C rotate 30 * y }}{LIGHT}{THINGS}"
    );
    agree(0.004, &[("declared", text)]);
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
