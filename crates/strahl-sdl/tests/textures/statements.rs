//! Pigments, normals, finishes, textures and interiors as the scene describes them.

use super::{color_at, plain, scene, texture, textures};
use crate::common::{debug, errors};
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_scene::ObjectKind;
use strahl_shade::Color;
use strahl_shade::normal::NormalKind;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::Texture;

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
        position("texture { pigment { gradient x } translate -0.5*x pigment { gradient x } }"),
        0.75,
    );
    // The default colour has been moved, and the pattern that replaces it is moved with it (measured).
    near(
        position("texture { translate -0.5*x pigment { gradient x } }"),
        0.75,
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
    assert!(matches!(&*found[6], Texture::Plain(p) if matches!(p.pigment, Pigment::UvMapped(_))));
    let (scene, _) = scene(text);
    let glass = scene.objects.0[7].material.as_ref().unwrap();
    assert_eq!(
        (glass.eta, glass.interior.as_ref().unwrap().fade_distance),
        (1.5, 2.0)
    );
}

/// So a thousand objects with a copy of a rich texture take little memory.
#[test]
fn copies_of_a_texture_share_their_members() {
    for (declared, copy) in [
        (
            "pigment { gradient x pigment_map { [0 agate] [1 bozo] } }",
            "pigment { P scale 2 }",
        ),
        (
            "pigment { checker pigment { agate } pigment { bozo } }",
            "pigment { P turbulence 1 }",
        ),
        (
            "pigment { gradient x color_map { [0 rgb 0] [1 rgb y] } }",
            "pigment { wood color_map { M } rotate z }",
        ),
        (
            "texture { gradient x texture_map { [0 pigment { agate }] [1 normal { bumps }] } }",
            "texture { P scale 2 finish { phong 1 } }",
        ),
    ] {
        let map = "#declare M = color_map { [0 rgb x] [1 rgb z] }";
        let text = format!(
            "{map} #declare P = {declared}; sphere {{ 0, 1 {copy} }} sphere {{ 1, 2 {copy} }}"
        );
        let members = |texture: &Texture| match texture {
            Texture::Map(_, map) => map.entries.as_ptr().cast::<()>(),
            Texture::Plain(plain) => match &plain.pigment {
                Pigment::ColorMap(_, map) => map.entries.as_ptr().cast(),
                Pigment::PigmentMap(_, map) => map.entries.as_ptr().cast(),
                Pigment::Blocks(_, list) => list.as_ptr().cast(),
                other => panic!("{other:?}"),
            },
            other => panic!("{other:?}"),
        };
        let both = textures(&text);
        assert_eq!(members(&both[0]), members(&both[1]), "{text}");
    }
}

#[test]
fn uv_mapping_is_an_attribute_of_the_object() {
    let (scene, _) = scene(
        "#declare T = texture { pigment { checker } }
         sphere { 0, 1 uv_mapping texture { T } }
         sphere { 0, 1 uv_mapping pigment { checker } }
         sphere { 0, 1 uv_mapping off texture { T } }
         union { sphere { 0, 1 uv_mapping } sphere { 1, 1 } texture { T } }",
    );
    let mapped: Vec<bool> = scene.objects.0.iter().map(|o| o.uv_mapped).collect();
    assert_eq!(mapped, [true, true, false, false]);
    let ObjectKind::Csg { children, .. } = &scene.objects.0[3].kind else {
        panic!("a union");
    };
    let mapped: Vec<bool> = children.0.iter().map(|o| o.uv_mapped).collect();
    assert_eq!(mapped, [true, false]);
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
    assert_eq!(debug(text), expected);
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
