//! What random scenes (`cargo xtask differ`) have shown.

use super::SETTINGS;
use crate::common::pictures::agree;

const CAMERA: &str = "camera { location <0, 2, -5> look_at 0 }\n";

fn scenes(of: &[(&'static str, &str)]) {
    let scenes: Vec<_> = of
        .iter()
        .map(|(name, text)| (*name, format!("{SETTINGS}{CAMERA}{text}")))
        .collect();
    agree(0.01, &scenes);
}

#[test]
fn slope_and_aoi_see_the_tilted_normal() {
    let map = "color_map { [0 rgb x] [0.5 rgb y] [1 rgb z] }";
    let tilted = "normal { gradient x+z 1 sine_wave scale 2 } finish { ambient 1 }";
    scenes(&[
        (
            "slope",
            &format!("plane {{ y, -1 texture {{ pigment {{ slope z {map} }} {tilted} }} }}"),
        ),
        (
            "aoi",
            &format!("plane {{ y, -1 texture {{ pigment {{ aoi {map} }} {tilted} }} }}"),
        ),
        (
            "a ball",
            &format!(
                "sphere {{ 0, 1.3 texture {{ pigment {{ slope y {map} }} {tilted} scale 0.5 rotate 30 }} }}"
            ),
        ),
        (
            "in a map",
            &format!(
                "sphere {{ 0, 1.3 texture {{ pigment {{ gradient y pigment_map {{ [0 rgb x] [1 slope y {map}] }} }} {tilted} }} }}"
            ),
        ),
        (
            "in a texture_map",
            &format!(
                "sphere {{ 0, 1.3 texture {{ checker texture {{ pigment {{ rgb x }} }} texture {{ pigment {{ slope z {map} }} {tilted} }} }} }}"
            ),
        ),
    ]);
}

#[test]
fn slope_and_aoi_are_zero_where_there_is_no_surface() {
    let map = "color_map { [0 rgb x] [1 rgb z] }";
    let ball = "sphere { 0, 1 pigment { rgb 1 } finish { ambient 0.5 } }";
    scenes(&[
        (
            "sky",
            &format!("sky_sphere {{ pigment {{ slope <-0.5, 0.6, -0.7> {map} }} }} {ball}"),
        ),
        (
            "sky with altitude",
            &format!("sky_sphere {{ pigment {{ slope {{ y altitude y }} {map} }} }} {ball}"),
        ),
        (
            "aoi",
            &format!("sky_sphere {{ pigment {{ aoi {map} }} }} {ball}"),
        ),
        (
            "a picture",
            &format!(
                "plane {{ -z, 0 pigment {{ image_map {{ function 4, 4 {{ pigment {{ slope y {map} }} }} }} }} finish {{ ambient 1 }} }}"
            ),
        ),
    ]);
}

#[test]
fn the_back_is_dark_where_diffuse_has_one_number() {
    let light = "light_source { <0, 5, 5>, 1 }";
    scenes(&[
        (
            "one finish",
            &format!(
                "{light} plane {{ z, 0 pigment {{ rgb 1 }} finish {{ ambient 0.1 diffuse 0.22, 0.58 diffuse 0.34 }} }}"
            ),
        ),
        (
            "a declared one",
            &format!(
                "{light} #declare T = texture {{ pigment {{ rgb 1 }} finish {{ ambient 0.1 diffuse 0.22, 0.58 }} }} plane {{ z, 0 texture {{ T finish {{ diffuse 0.34 }} }} }}"
            ),
        ),
        (
            "two numbers",
            &format!(
                "{light} plane {{ z, 0 pigment {{ rgb 1 }} finish {{ diffuse 0.22, 0.58 }} }}"
            ),
        ),
    ]);
}

#[test]
fn lights_that_were_cylinders_stay_parallel() {
    let plane = "plane { y, -1 pigment { rgb 1 } } sphere { 0, 0.5 pigment { rgb x } }";
    let light = |words: &str| format!("light_source {{ <1, 5, -3>, rgb 1 {words} }} {plane}");
    scenes(&[
        (
            "cylinder",
            &light("cylinder point_at <0, -0.2, 0.5> radius 1 falloff 2 tightness 10"),
        ),
        (
            "cylinder, shadowless",
            &light("cylinder point_at <0, -0.2, 0.5> radius 1 falloff 2 shadowless"),
        ),
        (
            "cylinder, spotlight",
            &light("cylinder point_at <0, -0.2, 0.5> radius 10 falloff 20 spotlight"),
        ),
        (
            "shadowless, cylinder",
            &light("shadowless cylinder point_at <0, -0.2, 0.5> radius 1 falloff 2"),
        ),
        (
            "spotlight, shadowless",
            &light("spotlight point_at <0, -0.2, 0.5> radius 10 falloff 20 shadowless"),
        ),
    ]);
}

#[test]
fn smooth_triangles_with_normals_on_both_sides_are_not_seen() {
    let corners = |n: [&str; 3]| {
        format!(
            "<-1, -1, 0>, {}, <1, -1, 0>, {}, <0, 1, 0>, {}",
            n[0], n[1], n[2]
        )
    };
    let light =
        "light_source { -20*z, 1 } box { <-0.2, -1.5, 0>, <0.2, -1.2, 0.2> pigment { rgb y } }";
    let alone = |n| {
        format!(
            "{light} smooth_triangle {{ {} pigment {{ rgb 1 }} }}",
            corners(n)
        )
    };
    let meshed = |n| {
        format!(
            "{light} mesh {{ smooth_triangle {{ {} }} pigment {{ rgb 1 }} }}",
            corners(n)
        )
    };
    scenes(&[
        ("one side", &alone(["-z", "-z+x", "-z-y"])),
        ("the other side", &alone(["z", "z+x", "z-y"])),
        ("both sides", &alone(["-z", "-z", "z"])),
        ("along it", &alone(["x", "x", "x"])),
        ("one along it", &alone(["-z", "-z", "x"])),
        ("in a mesh", &meshed(["-z", "-z", "z"])),
    ]);
}

#[test]
fn faces_of_mesh2_blend_the_textures_of_their_corners() {
    let texture =
        |color: &str| format!("texture {{ pigment {{ rgb {color} }} finish {{ ambient 1 }} }}");
    let mesh = |textures: &str, numbers: &str| {
        format!(
            "mesh2 {{ vertex_vectors {{ 4, <-1, -1, 0>, <1, -1, 0>, <0, 1, 0>, <2, 1, 0> }} texture_list {{ {textures} }}
             face_indices {{ 2, <0, 1, 2>, {numbers}, <1, 2, 3>, 1 }} rotate 20*y scale 1.2 }}"
        )
    };
    let three = format!(
        "3, {} {} {}",
        texture("x"),
        texture("y"),
        texture("<1, 0.5, 1>")
    );
    let patterned = format!(
        "2, texture {{ pigment {{ gradient x color_map {{ [0 rgb 1] [1 rgb x] }} scale 0.3 }} finish {{ ambient 1 }} }} {}",
        texture("y")
    );
    scenes(&[
        ("three", &mesh(&three, "0, 1, 2")),
        ("two", &mesh(&three, "0, 1, 1")),
        ("one", &mesh(&three, "2")),
        ("patterns", &mesh(&patterned, "0, 1, 0")),
        (
            "inside out",
            &mesh(&three, "0").replace("rotate", "inverse rotate"),
        ),
    ]);
}

#[test]
fn textures_of_averages_are_turbulent_and_moved() {
    scenes(&[(
        "average",
        "sphere { 0, 1.5 texture { average texture_map { [1 pigment { gradient x } finish { ambient 1 }] [2 pigment { rgb y } finish { ambient 1 }] }
         turbulence 0.4 frequency 2 phase 0.3 cubic_wave rotate 20 scale 0.7 } }",
    )]);
}

/// Versions before 3.5 have another noise, and layers that let light through without giving it their colour.
#[test]
fn versions_before_3_5_have_their_noise_and_layers() {
    let versions = ["3.0", "3.1", "3.5", "3.6", "3.7"];
    let box_of = |textures: &str| format!("box {{ -1, 0.99 {textures} }}");
    let ambient = "finish { ambient 1 diffuse 0 }";
    let things = [
        format!(
            "plane {{ -z, 0 pigment {{ bozo color_map {{ [0.26 rgb x] [0.94 rgb y] }} }} {ambient} }}"
        ),
        format!("plane {{ -z, 0 pigment {{ granite }} {ambient} }}"),
        box_of(&format!(
            "texture {{ pigment {{ rgbf <0.5, 0.4, 0.3, 0.8> }} {ambient} }} texture {{ pigment {{ rgbf <0.5, 0.6, 0.7, 0.9> }} finish {{ ambient 0 diffuse 0 }} }}"
        )),
        box_of(&format!(
            "texture {{ pigment {{ rgb 0 }} {ambient} }} texture {{ pigment {{ rgbft <0.5, 0.6, 0.7, 0.5, 0.2> }} {ambient} }}"
        )),
        box_of(&format!(
            "texture {{ pigment {{ rgbf <0.5, 0.4, 0.3, 0.8> }} {ambient} }}"
        )),
    ];
    let mut scenes = vec![];
    for version in versions {
        for thing in &things {
            let text = format!(
                "#version {version}; global_settings {{ assumed_gamma 1 }} {CAMERA} background {{ rgb 0.25 }} {thing}"
            );
            scenes.push((version, text));
        }
    }
    agree(0.01, &scenes);
}

/// Without an alpha channel the transmit of the background shows black, but its filter does not.
#[test]
fn backgrounds_that_transmit_are_dark() {
    let things = "sphere { -x, 0.5 pigment { rgb 0.1 } finish { ambient 1 diffuse 0 reflection 1 } }
        box { <0.2, -0.5, 0>, <1.2, 0.5, 1> pigment { rgbt <1, 1, 1, 0.5> } finish { ambient 0 diffuse 0 } hollow }";
    let mut scenes = vec![];
    for color in [
        "rgbt <1, 0.5, 0.2, 0.4>",
        "rgb 1 transmit 1",
        "rgbf <1, 0.5, 0.2, 0.4>",
    ] {
        for sky in ["", "sky_sphere { pigment { rgbt <0.2, 0.4, 0.8, 0.5> } }"] {
            for version in ["3.6", "3.7"] {
                let text = format!(
                    "#version {version}; global_settings {{ assumed_gamma 1 }} {CAMERA} background {{ {color} }} {sky} {things}"
                );
                scenes.push((version, text));
            }
        }
    }
    let late = format!(
        "#version 3.1; global_settings {{ assumed_gamma 1 }} {CAMERA} background {{ rgbt <1, 0.5, 0.2, 0.4> }} {things} #version 3.7;"
    );
    scenes.push(("late", late));
    agree(0.01, &scenes);
}

/// In a finish `caustics` is the exponent, in an interior a 45th of it.
#[test]
fn caustics_of_finishes_are_exponents() {
    let scene = |finish: &str, interior: &str| {
        format!(
            "sphere {{ 0, 1.2 pigment {{ rgbf 0.9 }} finish {{ {finish} }} interior {{ ior 1.3 {interior} }} }}
             plane {{ y, -1.5 pigment {{ rgb 0.8 }} }} light_source {{ <5, 9, -5>, 1 }}"
        )
    };
    scenes(&[
        ("finish", &scene("caustics 1", "")),
        ("interior", &scene("", "caustics 1")),
        ("both", &scene("caustics 20", "caustics 1")),
    ]);
}
