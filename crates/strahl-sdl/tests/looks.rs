//! Looks: default textures, finishes, and the names of the include files, rendered by POV-Ray 3.7 with its own include files and
//! by strahl with ours.

use crate::common::parse_with;
use crate::common::pictures::agree;
use strahl_render::{CompileOptions, RenderOptions, compile, render};
use strahl_sdl::MemoryHost;

const START: &str = "
#version 3.7; global_settings { assumed_gamma 1 }
camera { orthographic location <4, 3, -10> look_at <4, 3, 0> right 8*x up 6*y }
light_source { <8, 20, -30>, rgb 1 }
";

/// A tile for each name, in rows of eight; each shows another part of the texture.
fn tiles(includes: &str, names: &[String], item: impl Fn(&str) -> String) -> String {
    let tiles = names.iter().enumerate().map(|(i, name)| {
        let (x, y) = (i % 8, i / 8);
        let texture = item(name);
        format!(
            "box {{ <-0.5, -0.5, 0>, <0.5, 0.5, 1> {texture} rotate <{}, {}, 0> scale <1, 1, 0.1> translate <{x}.5, {y}.5, 0> }}\n",
            (i * 7) % 20,
            (i * 11) % 20,
        )
    });
    format!("{START}{includes}{}", tiles.collect::<String>())
}

fn numbered(
    prefix: &str,
    numbers: std::ops::RangeInclusive<u32>,
) -> impl Iterator<Item = String> + '_ {
    numbers.map(move |n| format!("{prefix}{n}"))
}

#[test]
fn negative_transparency_takes_light_away() {
    let scene = |bailout: f64| {
        let objects = [-0.05, -0.2, -0.3, -0.5, -0.6, -0.8, -1.0, -1.5].iter().zip(0..).map(|(t, x)| {
            format!(
                "sphere {{ <{x}.5, 4.5, 0>, 0.45 pigment {{ rgb 0.3 transmit {t} }} finish {{ ambient 0.3 diffuse 0.5 reflection 0.2 * {t} }} }}
                 disc {{ <{x}.5, 3, 0>, z, 0.45 pigment {{ rgb <0.3, 0.5, -0.9> filter {t} }} finish {{ emission 1 ambient 0 diffuse 0 }} }}
                 disc {{ <{x}.5, 1.5, 0>, z, 0.45 pigment {{ rgb <0.3, -0.9, 0.5> filter {t} }} finish {{ emission 1 ambient 0 diffuse 0 }} }}"
            )
        });
        let objects = objects.collect::<String>();
        format!(
            "{START} global_settings {{ adc_bailout {bailout} }} plane {{ z, 3 pigment {{ rgb <0.2, 0.4, 0.6> }} finish {{ ambient 0.2 diffuse 0.8 }} }} {objects}"
        )
    };
    agree(
        0.01,
        &[
            ("shadows and what is behind", scene(1.0 / 255.0)),
            ("a large bailout", scene(0.25)),
            ("a larger bailout", scene(0.55)),
        ],
    );
}

#[test]
fn normals_begin_with_the_default_one() {
    let slopes = "slope_map { [0 <0, 1>] [0.5 <1, 1>] [0.5 <1, -1>] [1 <0, -1>] }";
    let scene = |default: &str, objects: &str| {
        format!("{START}#default {{ pigment {{ rgb 0.8 }} normal {{ {default} }} }}\n{objects}\n")
    };
    let plane = |normal: &str| format!("plane {{ <0.1, 0.2, -1>, 0 normal {{ {normal} }} }}");
    let scenes = [
        // The object gets the default texture when the texture is first changed, not when the object is created.
        (
            "moved before the normal",
            scene(
                "onion 0.8 scale 0.4",
                &format!(
                    "#declare T = box {{ <-1, -1, 0>, <1, 1, 1> scale 2 }} object {{ T normal {{ {slopes} }} translate <4, 3, 0> }}"
                ),
            ),
        ),
        (
            "moved without a normal",
            scene(
                "onion 0.8 scale 0.4",
                "box { <-1, -1, 0>, <1, 1, 1> scale 2 translate <4, 3, 0> }",
            ),
        ),
        (
            "amounts in maps",
            scene(
                "bump_size 1.5",
                &plane("gradient x normal_map { [0.3 bumps] [0.7 dents 0.5] } scale 2"),
            ),
        ),
        (
            "amounts of blocks",
            scene(
                "bump_size 1.5",
                &plane("checker normal { bumps } normal { dents 0.5 } scale 0.7"),
            ),
        ),
        ("slope maps of bumps", scene("bumps 0.3", &plane(slopes))),
        (
            "slope maps of ripples",
            scene("ripples 0.3", &plane(slopes)),
        ),
        (
            "slope maps of wrinkles",
            scene("wrinkles 0.3", &plane(slopes)),
        ),
    ];
    agree(0.01, &scenes);
}

#[test]
fn woods_look_as_povrays() {
    let woods: Vec<String> = numbered("T_Wood", 1..=33).collect();
    let grains: Vec<String> = (1..=19)
        .flat_map(|n| [format!("P_WoodGrain{n}A"), format!("P_WoodGrain{n}B")])
        .collect();
    let include = "#include \"woods.inc\"\n";
    let scenes = [
        (
            "woods",
            tiles(include, &woods, |name| format!("texture {{ {name} scale 0.7 }}")),
        ),
        (
            "grains",
            tiles(include, &grains, |name| {
                format!("pigment {{ {name} color_map {{ [0 rgb x] [1 rgb y] }} scale 0.7 }}")
            }),
        ),
        (
            "maps",
            (1..=19).fold(format!("{START}{include}"), |text, n| {
                let strip = |m: char, y: f64| {
                    format!(
                        "box {{ <0, {y}, 0>, <8, {}, 1> hollow pigment {{ gradient x color_map {{ M_Wood{n}{m} }} scale 8 }} }}\n",
                        y + 0.15
                    )
                };
                text + &strip('A', f64::from(n) * 0.3) + &strip('B', f64::from(n) * 0.3 + 0.15)
            }),
        ),
    ];
    agree(0.02, &scenes);
}

const ROOM: &str = "
#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -4> look_at <0, -0.3, 0> angle 50 }
light_source { <2, 6, -1>, rgb 0.3 }
plane { y, -1.5 pigment { checker rgb 0.8 rgb 0.5 } }
";

#[test]
fn caustics_gather_light_as_povrays() {
    let clear = "pigment { rgbf <0.9, 1, 0.95, 0.9> } finish { ambient 0 diffuse 0 }";
    let bumpy = format!("{clear} normal {{ bumps 0.3 scale 0.2 }}");
    let veil = "pigment { rgbt <1, 1, 1, 0.8> } normal { wrinkles 0.2 }";
    let slab = |texture: String| {
        format!("{ROOM}box {{ <-2, -0.3, -2>, <2, 0, 2> {texture} interior {{ caustics 0.7 }} }}")
    };
    let scenes = [
        (
            "sphere",
            format!("{ROOM}sphere {{ 0, 1 {clear} interior {{ ior 1.3 caustics 1 }} }}"),
        ),
        ("normal", slab(bumpy.clone())),
        (
            "layers",
            slab(format!("texture {{ {bumpy} }} texture {{ {veil} }}")),
        ),
        (
            "map",
            slab(format!(
                "texture {{ gradient x texture_map {{ [0 {bumpy}] [1 {veil}] }} scale 2 }}"
            )),
        ),
    ];
    agree(0.01, &scenes);
}

#[test]
fn insides_show_their_texture() {
    let two = "texture { pigment { rgb x } } interior_texture { pigment { rgb z } }";
    let clear = "texture { pigment { checker rgb x rgbf <1, 1, 0, 0.8> scale 0.3 } } interior_texture { pigment { rgbf <0, 0, 1, 0.7> } }";
    let scene = |object: String| format!("{ROOM}{object}");
    let scenes = [
        (
            "open sphere",
            scene(format!(
                "sphere {{ 0, 1 clipped_by {{ plane {{ <0.2, 0.5, -0.6>, 0.3 }} }} {two} }}"
            )),
        ),
        (
            "open cylinder",
            scene(format!(
                "cylinder {{ -y, y, 1 open material {{ {two} }} rotate -30*x }}"
            )),
        ),
        ("clear", scene(format!("sphere {{ 0, 1 {clear} }}"))),
        (
            "difference",
            scene(format!(
                "difference {{ box {{ -1, 1 }} sphere {{ -z, 0.8 }} {two} }}"
            )),
        ),
        ("back of a disc", scene(format!("disc {{ 0, z, 1 {two} }}"))),
        (
            "front of a disc",
            scene(format!("disc {{ 0, -z, 1 {two} }}")),
        ),
    ];
    agree(0.01, &scenes);
}

#[test]
fn include_textures_look_as_povrays() {
    let include = "#include \"colors.inc\"\n#include \"textures.inc\"\n#include \"skies.inc\"\n";
    let pigments = "Jade Red_Marble White_Marble Blood_Marble Blue_Agate Sapphire_Agate Brown_Agate Pink_Granite Blue_Sky Bright_Blue_Sky \
         Blue_Sky2 Blue_Sky3 Blood_Sky Apocalypse Clouds FBM_Clouds Cherry_Wood Pine_Wood Dark_Wood Tan_Wood White_Wood Tom_Wood DMFWood1 \
         DMFWood2 DMFWood3 DMFWood4 DMFWood5 DMFLightOak DMFDarkOak P_Cloud1 P_Cloud2 P_Cloud3 P_Cloud4";
    let names: Vec<String> = pigments.split_whitespace().map(str::to_owned).collect();
    let stars: Vec<String> = numbered("Starfield", 1..=6).collect();
    let scenes = [
        (
            "pigments",
            tiles(include, &names, |name| {
                format!("pigment {{ {name} scale 0.7 }}")
            }),
        ),
        (
            "stars",
            tiles("#include \"stars.inc\"\n", &stars, |name| {
                format!("texture {{ {name} }}")
            }),
        ),
        (
            "stage",
            "#version 3.7; global_settings { assumed_gamma 1 }
             #include \"colors.inc\"
             #include \"stdcam.inc\"
             sphere { y, 1 pigment { rgb x } }"
                .to_owned(),
        ),
    ];
    agree(0.02, &scenes);
}

/// What `crand` takes counts with the whole colour of a layer, also where the layer is transparent: the means of POV-Ray's
/// pictures, whose grains are others.
#[test]
fn crand_takes_the_whole_colour_of_each_layer() {
    const BASE: &str = "texture { pigment { rgb 1 } finish { ambient 0 diffuse 0.6 } }";
    const GRAINY: &str = "texture { pigment { rgb 1 } finish { ambient 0 diffuse 0.6 crand 0.1 } }";
    const CASES: [(&str, &str, &str, f64); 7] = [
        ("one layer", GRAINY, "", 0.55),
        ("transparent above", GRAINY, "<1, 1, 1, 0.5>", 0.575),
        ("grain above only", BASE, "<1, 1, 1, 0.5> crand", 0.55),
        (
            "grain in a nearly clear layer",
            BASE,
            "<1, 1, 1, 0.9> crand",
            0.55,
        ),
        ("grain in a black layer", BASE, "<0, 0, 0, 0.5> crand", 0.3),
        (
            "grain in both layers",
            GRAINY,
            "<1, 1, 1, 0.5> crand",
            0.525,
        ),
        ("half the light", GRAINY, "half", 0.275),
    ];
    for (case, base, above, theirs) in CASES {
        let (light, above) = match above {
            "half" => (0.5, ""),
            above => (1.0, above),
        };
        let (color, grain) = match above.strip_suffix(" crand") {
            Some(color) => (color, "crand 0.1"),
            None => (above, ""),
        };
        let above = match color {
            "" => String::new(),
            color => format!(
                "texture {{ pigment {{ rgbt {color} }} finish {{ ambient 0 diffuse 0.6 {grain} }} }}"
            ),
        };
        let text = format!(
            "#version 3.7; global_settings {{ assumed_gamma 1 }}
            light_source {{ -1000000*z, rgb {light} }}
            camera {{ orthographic location -9*z look_at 0 right x up y }}
            plane {{ -z, 0 {base} {above} }}"
        );
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let scene = parsed.scene.expect("the scene is read");
        let scene = compile(&scene, &CompileOptions::default()).expect("the scene compiles");
        let film = render(&scene, &RenderOptions::new(&scene, 64, 64))
            .expect("the scene renders")
            .film;
        let sum: f64 = film.pixels.iter().map(|pixel| f64::from(pixel[0])).sum();
        let ours = sum / film.pixels.len() as f64;
        assert!(
            (ours - theirs).abs() < 0.003,
            "{case}: {ours} instead of {theirs}"
        );
    }
}
