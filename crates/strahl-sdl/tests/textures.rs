//! Textures: their syntax, their descriptions, the messages about errors, and pigments compared with POV-Ray's.

mod common;

use common::{errors, parse_with};
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_scene::Scene;
use strahl_sdl::MemoryHost;
use strahl_shade::normal::NormalKind;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::texture::{PlainTexture, Texture};
use strahl_shade::{Color, ColorFt};

/// A picture of 2 x 2 texels: red, green above blue, white.
const PICTURE: &[u8] = b"P6\n2 2\n255\n\xff\0\0\0\xff\0\0\0\xff\xff\xff\xff";

fn parse(text: &str) -> (Option<Scene>, Vec<String>) {
    let mut host = MemoryHost::new().with_file("p.ppm", PICTURE);
    let parsed = parse_with(&mut host, text);
    let messages = parsed.diagnostics.iter().map(ToString::to_string);
    (parsed.scene, messages.collect())
}

fn scene(text: &str) -> (Scene, Vec<String>) {
    let (scene, messages) = parse(text);
    let Some(scene) = scene else {
        panic!("{text}\n{}", messages.join("\n"));
    };
    (scene, messages)
}

/// The textures of the objects of a text without messages.
fn textures(text: &str) -> Vec<Arc<Texture>> {
    let (scene, messages) = scene(text);
    assert!(messages.is_empty(), "{text}\n{}", messages.join("\n"));
    let objects = scene.objects.0.iter();
    let materials = objects.map(|o| o.material.as_ref().expect("a material"));
    materials
        .map(|m| Arc::clone(&m.texture.as_ref().expect("a texture").0))
        .collect()
}

fn texture(items: &str) -> Arc<Texture> {
    textures(&format!("sphere {{ 0, 1 {items} }}")).remove(0)
}

fn plain(items: &str) -> PlainTexture {
    match &*texture(items) {
        Texture::Plain(plain) => PlainTexture::clone(plain),
        other => panic!("{items}: {other:?}"),
    }
}

fn color_at(texture: &Texture, p: DVec3) -> ColorFt {
    match texture {
        Texture::Plain(plain) => plain.pigment.color_at(&TexturePoint::in_space(p)),
        other => panic!("{other:?}"),
    }
}

/// Pigments whose values agree with POV-Ray's to the precision of its colours.
const PIGMENTS: &[&str] = &[
    "rgb <0.1, 0.2, 0.3>",
    "color red 0.5 green 0.25 filter 0.125 transmit 0.5",
    "rgbft 0.3",
    "agate",
    "agate agate_turb 0.3 color_map { [0 rgb 0] [1 rgb 1] }",
    "bozo",
    "bozo noise_generator 1",
    "bozo noise_generator 3 turbulence 0.4",
    "bozo turbulence <0.1, 0.5, 0> octaves 3 omega 0.7 lambda 3",
    "bumps color_map { [0.3 rgb x] [0.6 rgb y] }",
    "boxed",
    "brick",
    "brick rgb x, rgb y brick_size <2, 1, 1> mortar 0.15 scale 0.3",
    "cells scale 0.4",
    "checker",
    "checker rgb x rgb y scale 0.3",
    "checker pigment { gradient x } pigment { granite scale 2 } translate 0.2",
    "checker rgb x",
    "crackle",
    "crackle form <1, 0.5, 0> metric 1 offset 0.1 scale 0.5",
    "crackle solid",
    "cubic",
    "cubic rgb x rgb y rgb z rgb 1 rgb 0.5 rgb 0.2",
    "cylindrical",
    "dents",
    "gradient x + y",
    "gradient <1, 2, 3> color_map { [0 0.5 color rgb 0 color rgb x] [0.5 1 color rgb y color rgb z] }",
    "gradient y color_map { [0.2 rgb 0] [0.2 rgb x] [0.2 rgb y] [0.7 rgb 1] }",
    "gradient z frequency 3 phase 0.2 sine_wave",
    "gradient z triangle_wave",
    "gradient z frequency 0 phase 0.3",
    "marble frequency 0 sine_wave",
    "quilted phase 0.3",
    "quilted frequency 2 phase 0.3",
    "gradient z scallop_wave",
    "gradient z cubic_wave",
    "gradient z poly_wave 2.5",
    "gradient x pigment_map { [0.2 rgb x] [0.5 wood scale 0.2] [0.8 Declared rotate 20*z] }",
    "gradient x scale 2 rotate <10, 20, 30> translate <1, 2, 3>",
    "gradient x matrix <1, 0.5, 0, 0, 1, 0, 0, 0.2, 2, 0.1, 0, 0>",
    "gradient x color_map { Map }",
    "granite color_map { [0 rgbt <1, 0, 0, 0.5>] [1 rgbf <0, 1, 0, 0.25>] }",
    "hexagon scale 0.5",
    "hexagon rgb x rgb y rgb z",
    "julia <0.353, 0.288>, 30 interior 1, 1",
    "leopard scale 0.2",
    "magnet 1 mandel 20",
    "magnet 2 julia <0.5, 0.2>, 15 exterior 2, 0.5",
    "mandel 25",
    "mandel 25 exponent 3 exterior 1, 1 interior 4, 0.5",
    "marble",
    "marble turbulence 0.7 color_map { [0 rgb 1] [0.8 rgb 0] [1 rgb x] }",
    "onion",
    "planar",
    "quilted control0 0.3 control1 0.8",
    "radial",
    "radial frequency 6 color_map { [0.5 rgb x] [0.5 rgb y] }",
    "ripples",
    "ripples frequency 2",
    "spherical scale 3",
    "spiral1 3",
    "spiral2 2 turbulence 0.1",
    "spotted turbulence 0.3",
    "square",
    "triangular scale 0.7",
    "waves",
    "wood turbulence 0.2",
    "wrinkles scale 0.4",
    "average pigment_map { [1 rgb x] [2 marble] [0.5 granite scale 0.3] }",
    "pigment_pattern { bozo scale 0.3 } color_map { [0 rgb z] [1 rgb x] }",
    "function { x * y + sin(z) } color_map { [0 rgb 0] [1 rgb <1, 0.5, 0.2>] }",
    "object { sphere { 0, 0.9 } rgb x, rgb y }",
    "Declared",
    "Declared color_map { [0 rgb y] [1 rgb z] }",
    "Declared scale 0.3",
    "Declared gradient x",
    "Mapped gradient x",
    "Mapped agate",
    "Mapped checker",
    "Mixed onion",
    "Plain radial",
    "image_map { function 5, 4 { 3 * x - 1.2 } }",
    "image_map { function 5, 4 { pigment { gradient x color_map { [0 rgb 0.5] [1 rgb <1.5, -0.3, 3>] } } } }",
    "Colors[1]",
    "Pigments[0] translate x",
    "checker rgb x rgb y warp { repeat x offset <0, 0.3, 0> flip y } scale 0.4",
    "gradient y warp { black_hole <0.2, 0.3, 0.1>, 1.5 strength 1.2 falloff 1.5 }",
    "gradient y warp { black_hole <0.4, 0.5, 0.5>, 0.4 inverse repeat <1, 1, 1> }",
    "gradient y warp { turbulence 0.4 octaves 4 } rotate 30 * x",
    "checker rgb x rgb y scale 0.2 warp { spherical orientation y dist_exp 1 }",
    "checker rgb x rgb y scale 0.2 warp { cylindrical }",
    "checker rgb x rgb y scale 0.2 warp { toroidal major_radius 0.5 }",
    "gradient x warp { planar y, 0.3 }",
    "bozo color_map { Map } quick_color rgb 1",
    "image_map { ppm \"p.ppm\" }",
    "image_map { ppm \"p.ppm\" map_type 1 interpolate 2 filter all 0.25 }",
    "image_map { ppm \"p.ppm\" map_type 2 once transmit all 0.5 }",
    "image_map { ppm \"p.ppm\" interpolate 4 } scale 0.7 rotate 20 * y",
    "image_pattern { ppm \"p.ppm\" interpolate 2 } color_map { [0 rgb 0] [1 rgb 1] }",
    "image_map { function 5, 4 { pigment { checker rgb x rgb z scale 0.4 } } }",
];

const DECLARED: &str = "
#declare Map = color_map { [0.1 rgb x] [0.4 color rgb <0, 0.5, 0>] [0.9 rgbt <0, 0, 1, 0.5>] }
#declare Declared = pigment { marble turbulence 0.3 scale 0.5 }
#declare Mapped = pigment { bozo color_map { [0 rgb x] [1 rgb y] } scale 0.3 }
#declare Mixed = pigment { bozo pigment_map { [0 rgb x] [1 agate] } }
#declare Plain = pigment { wood }
#declare Colors = array[2] { rgb x, rgb <0.1, 0.2, 0.3> }
#declare Pigments = array[1] { Declared }
";

const POINTS: [DVec3; 5] = [
    DVec3::new(0.31, 0.47, -0.23),
    DVec3::new(-0.81, 0.11, 0.37),
    DVec3::new(0.07, -0.63, 0.91),
    DVec3::new(1.73, 2.29, -3.41),
    DVec3::new(-12.37, 5.61, 8.53),
];

/// A program to compare with; without it the caller skips its test, unless the environment requires all tools.
fn tool(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|p| p.is_file());
    if found.is_none() {
        assert!(
            std::env::var_os("STRAHL_REQUIRE_TOOLS").is_none(),
            "{name} is missing, but required"
        );
        use std::io::Write;
        let _ = writeln!(std::io::stderr().lock(), "SKIPPED: {name} is not installed");
    }
    found
}

#[test]
fn pigments_have_povrays_colors() {
    let Some(povray) = tool("povray") else {
        return;
    };
    let header = format!("#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\n{DECLARED}");
    let (mut theirs, mut ours) = (header.clone(), header);
    for (i, pigment) in PIGMENTS.iter().enumerate() {
        theirs.push_str(&format!(
            "#declare F{i} = function {{ pigment {{ {pigment} }} }}\n"
        ));
        for p in POINTS {
            theirs.push_str(&format!(
                "#declare C = F{i}({}, {}, {});\n#debug concat(\"<<\", vstr(5, C, \",\", 0, 9), \">>\\n\")\n",
                p.x, p.y, p.z
            ));
        }
        ours.push_str(&format!("sphere {{ 0, 1 pigment {{ {pigment} }} }}\n"));
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.ppm"), PICTURE).unwrap();
    std::fs::write(folder.path().join("pigments.pov"), &theirs).unwrap();
    let run = Command::new(povray)
        .args([
            "-D",
            "+W4",
            "+H4",
            "-F",
            "-GS",
            "-GW",
            "-GR",
            "+Ipigments.pov",
        ])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let output = String::from_utf8_lossy(&run.stderr)
        .replace("\n ", "")
        .replace('\n', "");
    let expected: Vec<Vec<f64>> = output
        .split("<<")
        .skip(1)
        .filter_map(|part| part.split(">>").next())
        .map(|list| list.split(',').map(|x| x.trim().parse().unwrap()).collect())
        .collect();
    assert_eq!(expected.len(), PIGMENTS.len() * POINTS.len(), "{output}");
    let found = textures(&ours);
    assert_eq!(found.len(), PIGMENTS.len());
    let mut wrong = vec![];
    for ((texture, name), expected) in found
        .iter()
        .zip(PIGMENTS)
        .zip(expected.chunks(POINTS.len()))
    {
        for (p, expected) in POINTS.iter().zip(expected) {
            let c = color_at(texture, *p);
            let found = [c.rgb.r, c.rgb.g, c.rgb.b, c.filter, c.transmit];
            let error = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
            if error.fold(0.0, f64::max) > 1e-6 {
                wrong.push(format!(
                    "{name} at {p}: POV-Ray {expected:?}, here {found:?}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn transformations_move_what_stands_before_them() {
    let position = |items: &str| {
        let texture = texture(items);
        // The value of the gradient is 1/4 here; the value at the origin shows how far it was moved.
        color_at(&texture, DVec3::new(0.25, 0.0, 0.0)).rgb.r
    };
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-4, "{a} is not {b}");
    near(position("pigment { gradient x }"), 0.25);
    near(position("pigment { gradient x translate -0.5*x }"), 0.75);
    near(
        position("texture { pigment { gradient x } translate -0.5*x }"),
        0.75,
    );
    near(
        position("texture { translate -0.5*x pigment { gradient x } }"),
        0.25,
    );
    // In the object's own space, a texture before a transformation of the object moves with it ...
    near(position("pigment { gradient x } translate -0.5*x"), 0.25);
    // ... and one after it does not, so in the object's space it moves back.
    near(position("translate -0.5*x pigment { gradient x }"), 0.75);
    near(
        position("scale 2 translate -0.5*x pigment { gradient x }"),
        0.0,
    );
}

#[test]
fn what_follows_changes_what_was_named() {
    let declared = "#declare F = finish { ambient 0.3 phong 0.5 } \
                    #declare T = texture { pigment { rgb x } finish { F } }";
    let of = |items: &str| {
        let text = format!("{declared} sphere {{ 0, 1 {items} }}");
        textures(&text).remove(0)
    };
    let Texture::Plain(t) = &*of("texture { T finish { diffuse 0.7 } }") else {
        panic!("not plain");
    };
    assert_eq!((t.finish.phong, t.finish.diffuse), (0.5, 0.7));
    assert_eq!(t.finish.ambient, Color::gray(0.3));
    let Texture::Layered(layers) = &*of("texture { T } texture { T } pigment { rgb y }") else {
        panic!("not layered");
    };
    // Further items change the uppermost layer.
    let colors: Vec<_> = layers
        .iter()
        .map(|l| color_at(l, DVec3::ZERO).rgb)
        .collect();
    assert_eq!(
        colors,
        [Color::new(1.0, 0.0, 0.0), Color::new(0.0, 1.0, 0.0)]
    );
    // A single name is shared.
    let both = textures(&format!(
        "{declared} sphere {{ 0, 1 texture {{ T }} }} box {{ 0, 1 texture {{ T }} }}"
    ));
    assert!(Arc::ptr_eq(&both[0], &both[1]));
}

#[test]
fn declared_layers_and_patterned_textures() {
    let text = "#declare L = texture { pigment { rgb x } } texture { pigment { rgbt 1 } }
                #declare M = texture_map { [0 L] [1 pigment { rgb z }] }
                sphere { 0, 1 texture { L } }
                sphere { 0, 1 texture { checker texture { L } texture { pigment { rgb y } } scale 2 } }
                sphere { 0, 1 texture { gradient x texture_map { M } turbulence 0.2 } }
                sphere { 0, 1 texture { tiles texture { L } tile2 texture { L } } }
                sphere { 0, 1 texture { average texture_map { [1 L] [L] } } }
                sphere { 0, 1 texture { material_map { ppm \"p.ppm\" texture { L } texture { L } } rotate 90*x } }
                sphere { 0, 1 texture { uv_mapping pigment { checker } } }
                sphere { 0, 1 material { texture { L } interior { ior 1.5 fade_distance 2 fade_power 1 } } }";
    let found = textures(text);
    assert!(matches!(&*found[0], Texture::Layered(l) if l.len() == 2));
    assert!(matches!(&*found[1], Texture::Blocks(_, l) if l.len() == 2));
    assert!(matches!(&*found[2], Texture::Map(_, m) if m.entries.len() == 2));
    assert!(matches!(&*found[3], Texture::Blocks(..)));
    assert!(matches!(&*found[4], Texture::Average(m, _) if m[1].0 == 1.0));
    assert!(matches!(&*found[5], Texture::MaterialMap(_, m, _) if m.warps.len() == 1));
    assert!(matches!(&*found[6], Texture::UvMapped(_)));
    let (scene, _) = scene(text);
    let glass = scene.objects.0[7].material.as_ref().unwrap();
    assert_eq!(
        (glass.eta, glass.interior.as_ref().unwrap().fade_distance),
        (1.5, 2.0)
    );
}

#[test]
fn uv_mapping_of_an_object_is_for_what_follows_it() {
    let found = textures(
        "#declare T = texture { pigment { checker } }
         sphere { 0, 1 uv_mapping texture { T } }
         sphere { 0, 1 uv_mapping pigment { checker } }
         sphere { 0, 1 uv_mapping texture { T } texture { pigment { rgbt 1 } } }
         sphere { 0, 1 uv_mapping off texture { T } }",
    );
    assert!(matches!(&*found[0], Texture::UvMapped(_)));
    assert!(matches!(&*found[1], Texture::UvMapped(_)));
    assert!(
        matches!(&*found[2], Texture::Layered(all) if all.iter().all(|t| matches!(t, Texture::UvMapped(_))))
    );
    assert!(matches!(&*found[3], Texture::Plain(_)));
}

#[test]
fn normals_of_all_kinds() {
    let kind = |items: &str| plain(&format!("normal {{ {items} }}")).normal.unwrap();
    let bumps = kind("bumps 0.3 scale 0.1 scale 2");
    assert!(matches!(bumps.kind, NormalKind::Bumps));
    assert_eq!((bumps.amount, bumps.modifiers.warps.len()), (0.3, 1));
    assert!(matches!(kind("wrinkles").kind, NormalKind::Wrinkles));
    assert!(matches!(
        kind("waves number_of_waves 4").kind,
        NormalKind::Waves(4)
    ));
    assert!(matches!(
        kind("quilted 1 control0 0.5").kind,
        NormalKind::Quilted([0.5, 1.0])
    ));
    assert!(matches!(
        kind("gradient x, 0.7").kind,
        NormalKind::Height(_, None)
    ));
    assert_eq!(kind("gradient x, 0.7").amount, 0.7);
    assert!(matches!(
        kind("gradient x slope_map { [0 <0, 1>] [1 <1, -1>] } accuracy 0.01").kind,
        NormalKind::Height(_, Some(_))
    ));
    assert!(matches!(
        kind("gradient x normal_map { [0 bumps] [1 dents 2] }").kind,
        NormalKind::Map(..)
    ));
    assert!(matches!(
        kind("checker normal { bumps } normal { dents }").kind,
        NormalKind::Blocks(..)
    ));
    assert!(matches!(
        kind("average normal_map { [1 bumps] [2 dents] }").kind,
        NormalKind::Average(_)
    ));
    let relief = kind("bump_map { ppm \"p.ppm\" bump_size 3 interpolate 2 } no_bump_scale");
    assert!(matches!(relief.kind, NormalKind::BumpMap(_)));
    assert!(relief.amount == 3.0 && relief.no_bump_scale);
    let text = "#declare N = normal { bumps } sphere { 0, 1 normal { N bump_size 2 } }";
    let Texture::Plain(t) = &*textures(text)[0] else {
        panic!("not plain");
    };
    assert_eq!(t.normal.as_ref().unwrap().amount, 2.0);
}

#[test]
fn finishes() {
    let f = |items: &str| plain(&format!("finish {{ {items} }}")).finish;
    let all = f(
        "ambient rgb <1, 2, 3> emission 0.1 diffuse 0.5, 0.25 brilliance 2 phong 0.3 phong_size 60 \
                 specular 0.4 roughness 0.02 metallic crand 0.1 conserve_energy reflection_exponent 0.5",
    );
    assert_eq!(all.ambient, Color::new(1.0, 2.0, 3.0));
    assert_eq!(
        (all.diffuse, all.diffuse_back, all.metallic),
        (0.5, 0.25, 1.0)
    );
    assert!(all.conserve_energy && all.reflection.exponent == 0.5);
    let r = f("reflection { 0.1, 0.9 falloff 3 metallic 0.5 }").reflection;
    assert_eq!((r.min, r.max), (Color::gray(0.1), Color::gray(0.9)));
    assert_eq!((r.falloff, r.metallic, r.fresnel), (3.0, 0.5, false));
    let r = f("reflection { rgb 0.9 fresnel on }").reflection;
    assert_eq!(
        (r.min, r.max, r.fresnel),
        (Color::BLACK, Color::gray(0.9), true)
    );
    assert_eq!(f("reflection 0.3").reflection.min, Color::gray(0.3));
    // The albedo depends on the brilliance that follows.
    assert_eq!(f("diffuse albedo 0.5 brilliance 3").diffuse, 1.0);
}

#[test]
fn an_interior_fills_the_parts_of_a_whole() {
    use strahl_scene::ObjectKind;
    let text = "union { sphere { 0, 1 pigment { rgb x } } sphere { 0, 1 pigment { rgb x } interior { ior 2 } }
                sphere { 0, 1 } interior { ior 1.5 } }";
    let (scene, _) = scene(text);
    let ObjectKind::Csg { children, .. } = &scene.objects.0[0].kind else {
        panic!("not combined");
    };
    let eta = |i: usize| children.0[i].material.as_ref().map(|m| m.eta);
    assert_eq!([eta(0), eta(1), eta(2)], [Some(1.5), Some(2.0), None]);
    assert_eq!(scene.objects.0[0].material.as_ref().unwrap().eta, 1.5);
}

#[test]
fn pigments_and_patterns_as_functions() {
    let text = "#include \"functions.inc\"
        #declare P = pigment { gradient x color_map { [0 rgb 0] [1 rgbt <1, 0.5, 0, 0.25>] } }
        #declare F = function { pigment { P } }
        #declare G = function { pattern { gradient x scale 2 } }
        #declare H = function { F(x, y, z).green + 10 * G(x, y, z) }
        #declare C = eval_pigment(P, <0.5, 0, 0>);
        #debug concat(vstr(5, C, \",\", 0, 4), \" \", str(F(0.5, 0, 0).red, 0, 4), \" \")
        #debug concat(str(G(0.5, 0, 0), 0, 4), \" \", str(H(0.5, 0, 0), 0, 4))";
    let expected = "0.5000,0.2500,0.0000,0.0000,0.1250 0.5000 0.2500 2.7500";
    assert_eq!(common::debug(text), expected);
    let found =
        errors("#declare F = function { pigment { rgb 1 } } #declare G = function { F(x, y, z) }");
    assert!(found[0].contains("component"), "{found:?}");
}

#[test]
fn defaults_and_shared_materials() {
    let text = "#default { texture { pigment { rgb x } finish { ambient 0.5 } } }
                sphere { 0, 1 } sphere { x, 1 finish { phong 1 } }
                sphere { 0, 1 pigment { rgb y } } box { 0, 1 pigment { rgb y } }";
    let (scene, _) = scene(text);
    let materials: Vec<_> = scene
        .objects
        .0
        .iter()
        .map(|o| o.material.as_ref().unwrap())
        .collect();
    let plain = |index: usize| match &*materials[index].texture.as_ref().unwrap().0 {
        Texture::Plain(plain) => plain.clone(),
        other => panic!("one pigment, not {other:?}"),
    };
    let color = plain(0)
        .pigment
        .color_at(&TexturePoint::in_space(DVec3::ZERO));
    assert_eq!(color.rgb, Color::new(1.0, 0.0, 0.0));
    assert_eq!(plain(0).finish.ambient, Color::gray(0.5));
    assert_eq!((plain(1).finish.phong, plain(0).finish.phong), (1.0, 0.0));
    assert!(Arc::ptr_eq(materials[2], materials[3]));
}

#[test]
fn what_is_not_supported_is_named() {
    for (items, word) in [
        ("pigment { facets }", "facets"),
        ("pigment { density_file df3 \"x.df3\" }", "density_file"),
        ("normal { facets size 0.1 }", "facets"),
        ("finish { irid { 0.3 thickness 1 } phong 1 }", "irid"),
        ("interior { media { emission 1 } ior 1.5 }", "media"),
        ("pigment { checker warp { cubic } }", "cubic"),
    ] {
        let (_, messages) = scene(&format!("sphere {{ 0, 1 {items} }}"));
        assert!(
            messages
                .iter()
                .any(|m| m.contains(word) && m.contains("not supported")),
            "{items}: {messages:?}"
        );
    }
}

#[test]
fn mistakes_have_a_line_and_advice() {
    for (items, parts) in [
        ("pigment { color_map { [0 rgb 1 } }", &["`]`", "1:"][..]),
        ("pigment { gradient x color_map { } }", &["no entries"]),
        ("pigment { Redd }", &["Redd"]),
        ("pigment { chekcer }", &["chekcer", "checker"]),
        ("pigment { image_map { png \"none.png\" } }", &["none.png"]),
        ("pigment { image_map { png \"bad.png\" } }", &["bad.png"]),
        ("pigment { mandel 0 }", &["whole number"]),
        (
            "pigment { brick brick_size 0 }",
            &["size in every direction"],
        ),
        ("pigment { bozo warp { repeat 0 } }", &["one axis"]),
        ("pigment { magnet 1 checker }", &["`mandel` or `julia`"]),
        ("finish { roughness 0 }", &["roughness must be positive"]),
        ("interior { ior 0 }", &["must be positive"]),
        (
            "texture { material_map { ppm \"p.ppm\" } }",
            &["at least one texture"],
        ),
        ("pigment { object { 3 } }", &["an object"]),
        ("pigment { bozo warp { foo } }", &["foo"]),
        ("normal { bumps", &["`}`"]),
    ] {
        let text = format!("sphere {{ 0, 1\n {items} }}");
        let mut host = MemoryHost::new()
            .with_file("p.ppm", PICTURE)
            .with_file("bad.png", "no picture");
        let parsed = parse_with(&mut host, &text);
        let error = parsed.diagnostics.iter().find(|d| d.is_error());
        let error = error.unwrap_or_else(|| panic!("no error in {items}"));
        let message = error.to_string();
        assert!(error.span.line >= 1, "{items}: {message}");
        for part in parts.iter().filter(|p| **p != "1:") {
            assert!(message.contains(part), "{items}: {message}");
        }
    }
    assert!(!errors("sphere { 0, 1 pigment { color_map { [0 rgb 1] 3 } } }").is_empty());
}

/// A BMP of 2 x 1 texels with a palette whose entries have the same colour.
fn picture_with_a_palette() -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    let (palette, row) = ([9u8, 9, 9, 0].repeat(2), [0u8, 1, 0, 0]);
    let header = 14 + 40;
    let offset = header + palette.len() as u32;
    for number in [offset + row.len() as u32, 0, offset, 40, 2, 1] {
        bytes.extend(number.to_le_bytes());
    }
    for number in [1u16, 8] {
        bytes.extend(number.to_le_bytes());
    }
    for number in [0u32, 4, 0, 0, 2, 2] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(palette);
    bytes.extend(row);
    bytes
}

#[test]
fn material_maps_choose_by_the_index_in_a_palette() {
    let mut host = MemoryHost::new().with_file("codes.bmp", picture_with_a_palette());
    let text = "sphere { 0, 1 texture { material_map { bmp \"codes.bmp\"
        texture { pigment { rgb x } } texture { pigment { rgb y } } } } }";
    let parsed = parse_with(&mut host, text);
    let scene = parsed.scene.expect("a scene");
    let texture = scene.objects.0[0]
        .material
        .as_ref()
        .unwrap()
        .texture
        .clone();
    let texture = texture.unwrap().0;
    let seen = |x: f64| {
        let point = TexturePoint::in_space(DVec3::new(x, 0.5, 0.0));
        let mut paint = strahl_shade::texture::TexturePaint::default();
        texture.layers_at(&point, 1.0, &mut paint);
        paint.layers[0].color.rgb
    };
    assert_eq!(seen(0.25), Color::new(1.0, 0.0, 0.0));
    assert_eq!(seen(0.75), Color::new(0.0, 1.0, 0.0));
}

/// POV-Ray 3.7 shows the second texture of `tiles` where a checker has its first colour.
#[test]
fn tiles_are_the_other_way_round_than_a_checker() {
    let text = "sphere { 0, 1 texture { tiles texture { pigment { rgb x } } tile2 texture { pigment { rgb y } } } }";
    let found = textures(text);
    let Texture::Blocks(_, tiles) = &*found[0] else {
        panic!("{found:?}");
    };
    let colors: Vec<_> = tiles
        .iter()
        .map(|t| color_at(t, DVec3::ZERO).rgb.to_array())
        .collect();
    assert_eq!(colors, [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
}

/// A picture of one grey texel with code 128 in three formats: BMP, whose codes are usually sRGB; PPM, which doesn't specify
/// them; and HDR, which is linear.
fn one_texel() -> MemoryHost {
    let mut bmp =
        b"BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x18\0".to_vec();
    bmp.resize(54, 0);
    bmp.extend([128, 128, 128, 0]);
    MemoryHost::new()
        .with_file("p.bmp", bmp)
        .with_file("p.ppm", b"P6\n1 1\n255\n\x80\x80\x80".to_vec())
        .with_file(
            "p.hdr",
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80".to_vec(),
        )
}

fn red_of(pigment: &str, header: &str) -> f64 {
    let text = format!("{header} sphere {{ 0, 1 pigment {{ {pigment} }} }}");
    let parsed = parse_with(&mut one_texel(), &text);
    let messages: Vec<_> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{text}\n{}", messages.join("\n")));
    let material = scene.objects.0[0].material.as_ref().expect("a material");
    let texture = &material.texture.as_ref().expect("a texture").0;
    color_at(texture, DVec3::splat(0.5)).rgb.r
}

/// How POV-Ray 3.7 converts the codes of pictures: by version, `assumed_gamma` and the format's own specification.
#[test]
fn image_maps_of_scenes_that_are_not_linear_have_povrays_colours() {
    let code = 128.0 / 255.0;
    let linear = strahl_shade::srgb::decode(code);
    let float = 0.5;
    let in_2_2 = |x: f64| x.powf(1.0 / 2.2);
    let raised = code.powf(2.2);
    let set = |version: &str, gamma: &str| {
        format!("#version {version}; global_settings {{ assumed_gamma {gamma} }}")
    };
    // The values of BMP, PPM, HDR, and of the BMP with `gamma 2.2`.
    let table = [
        (String::new(), [code, code, float, raised]),
        ("#version 3.6;".to_owned(), [code, code, float, raised]),
        (set("3.6", "1"), [code, code, float, raised]),
        (set("3.6", "2.2"), [code, code, in_2_2(float), code]),
        ("#version 3.7;".to_owned(), [linear, code, float, raised]),
        (set("3.7", "1"), [linear, code, float, raised]),
        (
            set("3.7", "2.2"),
            [in_2_2(linear), code, in_2_2(float), code],
        ),
        (
            set("3.7", "srgb"),
            [
                code,
                code,
                strahl_shade::srgb::encode(float),
                strahl_shade::srgb::encode(raised),
            ],
        ),
    ];
    for (header, expected) in table {
        let pictures = [
            "image_map { bmp \"p.bmp\" }",
            "image_map { ppm \"p.ppm\" }",
            "image_map { hdr \"p.hdr\" }",
            "image_map { bmp \"p.bmp\" gamma 2.2 }",
        ];
        for (picture, expected) in pictures.iter().zip(expected) {
            let got = red_of(picture, &header);
            assert!(
                (got - expected).abs() < 0.003,
                "{header} {picture}: {got} is not {expected}"
            );
        }
        // Data always use the codes.
        let pattern = "image_pattern { bmp \"p.bmp\" } color_map { [0 rgb 0] [1 rgb 1] }";
        assert!((red_of(pattern, &header) - code).abs() < 1e-6, "{header}");
    }
    // A setting after the picture has no effect on it.
    let late = "#version 3.7; #declare P = pigment { image_map { bmp \"p.bmp\" } } global_settings { assumed_gamma 2.2 }";
    assert!((red_of("P", late) - linear).abs() < 1e-6);
}

#[test]
fn srgb_colours_are_numbers_of_the_scene() {
    for (header, expected) in [
        (
            "#version 3.7; global_settings { assumed_gamma 1 }",
            strahl_shade::srgb::decode(0.5),
        ),
        ("#version 3.7; global_settings { assumed_gamma srgb }", 0.5),
        ("", 0.5),
    ] {
        let got = red_of("srgb 0.5", header);
        assert!((got - expected).abs() < 1e-9, "{header}: {got}");
    }
}

/// As in POV-Ray 3.7, a uniform pigment remembers its transformation, which also applies to a pattern that replaces it.
#[test]
fn a_pigment_written_over_a_moved_colour_is_where_the_colour_was() {
    let at = |text: &str, x: f64| {
        let found = textures(text);
        color_at(&found[0], DVec3::new(x, 0.5, 0.5)).rgb.r
    };
    let pattern = "pigment { gradient x color_map { [0.5 rgb 0] [0.5 rgb 1] } }";
    // The texture is in the object's own space; its transformation to the world includes that of the object.
    let over = format!(
        "#declare W = box {{ -9, 9 pigment {{ rgb y }} scale 2 }} object {{ W {pattern} }}"
    );
    let between = format!(
        "#declare W = box {{ -9, 9 scale 4 pigment {{ rgb y }} scale 2 }} object {{ W {pattern} }}"
    );
    let fresh = format!("#declare W = box {{ -9, 9 scale 2 }} object {{ W {pattern} }}");
    assert_eq!([0.4, 0.6].map(|x| at(&over, x)), [0.0, 1.0]);
    assert_eq!([0.1, 0.15, 0.28].map(|x| at(&between, x)), [0.0, 1.0, 0.0]);
    assert_eq!([0.2, 0.3].map(|x| at(&fresh, x)), [0.0, 1.0]);
}

/// As in POV-Ray 3.7, a pattern without a map keeps the existing map, and the colours of blocks count as a map.
#[test]
fn a_pattern_over_a_pigment_keeps_its_map() {
    let declared = "#declare P = pigment { gradient x color_map { [0 rgb x] [1 rgb z] } }
                    #declare C = pigment { checker rgb x rgb z }
                    #declare D = pigment { gradient x }
                    #declare A = pigment { agate }\n";
    for (changed, same) in [
        ("P bozo", "bozo color_map { [0 rgb x] [1 rgb z] }"),
        ("P wood", "wood color_map { [0 rgb x] [1 rgb z] }"),
        ("C bozo", "bozo color_map { [0 rgb x] [1 rgb z] }"),
        ("D bozo", "bozo"),
        ("A scale 2", "agate scale 2"),
        ("P checker", "checker"),
    ] {
        let found = textures(&format!(
            "{declared} sphere {{ 0, 1 pigment {{ {changed} }} }} sphere {{ 0, 1 pigment {{ {same} }} }}"
        ));
        for p in [DVec3::new(0.3, 0.7, 1.1), DVec3::new(-2.4, 0.2, 0.9)] {
            let [a, b] = [0, 1].map(|i| color_at(&found[i], p).rgb.to_array());
            assert!(
                a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12),
                "{changed}: {a:?} {b:?}"
            );
        }
    }
}
