use crate::scene::{Loaded, SceneFormat, load_bytes, load_path};
use std::f64::consts::PI;
use std::fs;
use strahl_geometry::{Shape, TriangleMesh};
use strahl_math::{DVec2, DVec3};
use strahl_scene::{Object, ObjectKind, Projection, Scene};
use strahl_shade::image_texture::{Filter, Wrap};
use strahl_shade::{Color, Falloff, LightKind, Pbr, Sides};

fn load(json: &str) -> Loaded {
    load_bytes(json.as_bytes(), "a.gltf", SceneFormat::Gltf, None)
}

fn messages(loaded: &Loaded) -> Vec<String> {
    loaded.diagnostics.iter().map(ToString::to_string).collect()
}

fn scene(json: &str) -> Scene {
    let loaded = load(json);
    assert_eq!(messages(&loaded), [""; 0]);
    loaded.scene.expect("no errors")
}

fn mesh(object: &Object) -> &TriangleMesh {
    match &object.kind {
        ObjectKind::Shape(Shape::TriangleMesh(mesh)) => mesh,
        other => panic!("{other:?}"),
    }
}

/// A simple base64 encoder.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let mut word = [0; 3];
        word[..chunk.len()].copy_from_slice(chunk);
        let bits = u32::from_be_bytes([0, word[0], word[1], word[2]]);
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k)) as usize & 63];
            out.push(if k <= chunk.len() {
                char::from(digit)
            } else {
                '='
            });
        }
    }
    out
}

fn floats(list: &[f32]) -> Vec<u8> {
    list.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The corners of the unit square at z = 0: 48 bytes.
fn square() -> Vec<u8> {
    floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0])
}

/// A file with one buffer; `rest` is the rest of the JSON. Every view begins at its offset and extends to the end.
fn file(buffer: &[u8], views: &[usize], accessors: &str, rest: &str) -> String {
    let views: Vec<_> = views
        .iter()
        .map(|offset| {
            format!(
                r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{}}}"#,
                buffer.len() - offset
            )
        })
        .collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}],
"bufferViews":[{}],"accessors":[{accessors}],{rest}}}"#,
        buffer.len(),
        base64(buffer),
        views.join(",")
    )
}

const POSITIONS: &str =
    r#"{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}"#;
const ONE_NODE: &str = r#""scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}]"#;

fn indexed(kind: u32, bytes: &[u8], count: usize, mode: u32) -> String {
    let buffer = [square(), bytes.to_vec()].concat();
    let accessors = format!(
        r#"{POSITIONS},{{"bufferView":1,"componentType":{kind},"count":{count},"type":"SCALAR"}}"#
    );
    let rest = format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":{mode}}}]}}],{ONE_NODE}"#
    );
    file(&buffer, &[0, 48], &accessors, &rest)
}

#[test]
fn all_index_types_and_modes_are_read() {
    let expected = [[0, 1, 2], [0, 2, 3]];
    let u8s = [0u8, 1, 2, 0, 2, 3];
    let u16s: Vec<u8> = u8s
        .iter()
        .flat_map(|i| u16::from(*i).to_le_bytes())
        .collect();
    let u32s: Vec<u8> = u8s
        .iter()
        .flat_map(|i| u32::from(*i).to_le_bytes())
        .collect();
    for json in [
        indexed(5121, &u8s, 6, 4),
        indexed(5123, &u16s, 6, 4),
        indexed(5125, &u32s, 6, 4),
    ] {
        let scene = scene(&json);
        let object = &scene.objects.0[0];
        assert_eq!(
            (object.name.as_deref(), object.transform.is_none()),
            (Some("mesh 0"), true)
        );
        assert_eq!(mesh(object).indices(), expected);
    }
    // A strip: 1 2 0 3, whose second triangle has the opposite winding. Vertices are numbered by first use.
    let strip = scene(&indexed(5121, &[1, 2, 0, 3], 4, 5));
    let corners = |scene: &Scene, k: u32| mesh(&scene.objects.0[0]).corners(k).map(|p| (p.x, p.y));
    assert_eq!(corners(&strip, 0), [(1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]);
    assert_eq!(corners(&strip, 1), [(1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]);
    let fan = scene(&indexed(5121, &[0, 1, 2, 3], 4, 6));
    assert_eq!(corners(&fan, 1), [(1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]);
    let lines = load(&indexed(5121, &u8s, 6, 1));
    assert_eq!(
        messages(&lines),
        [
            "warning: `a.gltf` has no objects",
            "warning: `a.gltf`: points and lines are ignored: they have no surface"
        ]
    );
}

#[test]
fn sparse_and_normalized_accessors_are_read() {
    // An accessor of zeros of which elements 1 and 2 are replaced, and 16-bit uv.
    let mut buffer = floats(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    buffer.extend([1, 2, 0, 0]);
    buffer.extend(
        [0u16, 65535, 32768, 0, 65535, 65535]
            .iter()
            .flat_map(|x| x.to_le_bytes()),
    );
    let accessors = r#"{"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0],
        "sparse":{"count":2,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}}},
        {"bufferView":2,"componentType":5123,"normalized":true,"count":3,"type":"VEC2"}"#;
    let rest = format!(
        r#""meshes":[{{"name":"leaf","primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}]}}],{ONE_NODE}"#
    );
    let scene = scene(&file(&buffer, &[0, 24, 28], accessors, &rest));
    let object = &scene.objects.0[0];
    assert_eq!(object.name.as_deref(), Some("leaf"));
    assert_eq!(
        mesh(object).positions(),
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    );
    let uv = mesh(object).surface_at_element(0, [1.0, 0.0]).uv;
    assert!(
        (uv - DVec2::new(32768.0 / 65535.0, 0.0)).length() < 1e-7,
        "{uv}"
    );
}

#[test]
fn normals_that_are_not_finite_count_as_none() {
    // The triangle uses vertices 1, 2 and 3.
    let mut buffer = square();
    let (nan, z) = (f32::NAN, [0.0, 0.0, 1.0]);
    buffer.extend(floats([[nan; 3], z, z, [0.0, nan, 0.0]].as_flattened()));
    buffer.extend(floats(&[0.0, 0.0, f32::INFINITY, 0.0, 0.5, 0.5, 1.0, 1.0]));
    buffer.extend([1, 2, 3, 0]);
    let accessors = format!(
        r#"{POSITIONS},{{"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"}},
        {{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"}},{{"bufferView":3,"componentType":5121,"count":3,"type":"SCALAR"}}"#
    );
    let rest = format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}],{ONE_NODE}"#
    );
    let loaded = load(&file(&buffer, &[0, 48, 96, 128], &accessors, &rest));
    assert_eq!(
        messages(&loaded),
        [
            "warning: `a.gltf`: texture coordinates that are not finite count as none, as of vertex 1",
            "warning: `a.gltf`: normals that are not finite count as none, as of vertex 3",
        ]
    );
    let scene = loaded.scene.expect("warnings only");
    let corner = mesh(&scene.objects.0[0]).surface_at_element(0, [0.0, 1.0]);
    assert_eq!((corner.n_shade, corner.uv), (DVec3::Z, DVec2::ONE));
}

const TRIANGLE: &str = r#""meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}]"#;
const THREE: &str =
    r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}"#;

fn with_nodes(nodes: &str, rest: &str) -> String {
    let mesh = TRIANGLE.replace(r#","material":0"#, "");
    file(
        &square(),
        &[0],
        THREE,
        &format!(r#"{mesh},"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}]{rest}"#),
    )
}

#[test]
fn nodes_are_transformations() {
    let nodes = r#"{"translation":[1,2,3],"scale":[2,2,2],"children":[1]},
        {"name":"leaf","rotation":[0,0,0.70710678118,0.70710678118],"mesh":0}"#;
    let scene = scene(&with_nodes(nodes, ""));
    let object = &scene.objects.0[0];
    assert_eq!(object.name.as_deref(), Some("leaf"));
    let to_world = object.transform.as_ref().expect("transformed");
    let x = to_world.point_to_world(DVec3::X);
    assert!((x - DVec3::new(1.0, 4.0, 3.0)).length() < 1e-6, "{x}");
    let matrix = with_nodes(
        r#"{"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,5,6,7,1],"mesh":0}"#,
        "",
    );
    let x = self::scene(&matrix).objects.0[0]
        .transform
        .as_ref()
        .expect("transformed")
        .point_to_world(DVec3::X);
    assert_eq!(x, DVec3::new(5.0, 7.0, 7.0));
}

#[test]
fn a_mesh_shown_twice_is_a_group() {
    let scene = scene(&with_nodes(
        r#"{"mesh":0,"children":[1]},{"mesh":0,"translation":[3,0,0]}"#,
        "",
    ));
    assert_eq!(
        (scene.groups.len(), scene.groups[0].objects.0.len()),
        (1, 1)
    );
    assert!(
        scene
            .objects
            .0
            .iter()
            .all(|o| matches!(o.kind, ObjectKind::Instance(_)))
    );
    assert_eq!(scene.objects.0[1].name.as_deref(), Some("node 1"));
}

#[test]
fn cycles_and_shared_children_are_refused() {
    let own = load(&with_nodes(r#"{"children":[1]},{"children":[0]}"#, ""));
    assert_eq!(
        messages(&own),
        ["error: `a.gltf`: node 0 is a child of two nodes, or of itself"]
    );
    let twice = load(&with_nodes(
        r#"{"children":[1,2]},{"children":[2]},{"mesh":0}"#,
        "",
    ));
    assert_eq!(
        messages(&twice),
        ["error: `a.gltf`: node 2 is a child of two nodes, or of itself"]
    );
}

#[test]
fn a_flattened_node_is_left_out() {
    let loaded = load(&with_nodes(
        r#"{"scale":[1,0,1],"mesh":0,"name":"flat"}"#,
        "",
    ));
    assert!(messages(&loaded)[1].contains("`flat` is left out: its transformation flattens it"));
}

#[test]
fn what_is_flat_may_be_flattened() {
    // The triangle lies in z = 0; the second node mirrors it.
    let single = scene(&with_nodes(r#"{"scale":[2,3,0],"mesh":0}"#, ""));
    let twice = scene(&with_nodes(
        r#"{"scale":[2,3,0],"mesh":0,"children":[1]},{"scale":[-1,1,1],"mesh":0}"#,
        "",
    ));
    let corner = DVec3::new(1.0, 1.0, 0.0);
    for (object, x) in [
        (&single.objects.0[0], 2.0),
        (&twice.objects.0[0], 2.0),
        (&twice.objects.0[1], -2.0),
    ] {
        let to_world = object.transform.as_ref().expect("transformed");
        assert_eq!(to_world.point_to_world(corner), DVec3::new(x, 3.0, 0.0));
    }
    assert_eq!(twice.objects.0.len(), 2);
    let line = load(&with_nodes(r#"{"scale":[2,0,0],"mesh":0}"#, ""));
    assert!(messages(&line)[1].contains("its transformation flattens it"));
}

#[test]
fn cameras_look_along_the_negative_z_axis() {
    let perspective = r#","cameras":[{"type":"perspective","perspective":{"yfov":1.5707963,"znear":0.1,"aspectRatio":2}}]"#;
    let camera = scene(&with_nodes(
        r#"{"mesh":0,"camera":0,"translation":[0,0,5]}"#,
        perspective,
    ))
    .camera
    .expect("one");
    assert_eq!(
        (camera.eye, camera.direction, camera.aspect),
        (DVec3::Z * 5.0, DVec3::NEG_Z, None)
    );
    assert!((camera.up - DVec3::Y).length() < 1e-6 && camera.projection == Projection::Perspective);
    let orthographic = r#","cameras":[{"type":"orthographic","orthographic":{"xmag":1,"ymag":3,"znear":0,"zfar":9}}]"#;
    let camera = scene(&with_nodes(r#"{"mesh":0,"camera":0}"#, orthographic))
        .camera
        .expect("one");
    assert_eq!(
        (camera.projection, camera.up),
        (Projection::Orthographic, DVec3::Y * 3.0)
    );
    let broken = load(&with_nodes(
        r#"{"mesh":0,"camera":0}"#,
        &perspective.replace("1.5707963", "0"),
    ));
    assert!(
        messages(&broken)[0]
            .starts_with("warning: `a.gltf`: camera 0 is ignored: the camera sees nothing")
    );
    let empty = load(&with_nodes(
        r#"{"mesh":0,"camera":0}"#,
        r#","cameras":[{"type":"perspective"}]"#,
    ));
    assert!(empty.scene.is_none());
}

#[test]
fn lights_shine_with_a_third_of_their_intensity() {
    let lights = r#","extensions":{"KHR_lights_punctual":{"lights":[
        {"type":"point","intensity":3.14159265358979,"color":[1,0.5,0],"name":"lamp"},
        {"type":"directional"},{"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}]}}"#;
    let node = |light: u32, more: &str| {
        format!(r#"{{"extensions":{{"KHR_lights_punctual":{{"light":{light}}}}}{more}}}"#)
    };
    let nodes = [
        node(0, r#","translation":[1,2,3],"children":[1,2],"mesh":0"#),
        node(1, ""),
        node(2, ""),
    ]
    .join(",");
    let scene = scene(&with_nodes(&nodes, lights));
    let [point, sun, spot] = &scene.lights[..] else {
        panic!("three lights")
    };
    assert_eq!(
        point.light.kind,
        LightKind::Point {
            position: DVec3::new(1.0, 2.0, 3.0)
        }
    );
    assert_eq!(
        (point.light.falloff, point.name.as_deref()),
        (Falloff::InverseSquare, Some("lamp"))
    );
    assert!(
        (point.light.color - Color::new(1.0, 0.5, 0.0))
            .max_component()
            .abs()
            < 1e-6
    );
    assert_eq!(
        sun.light.kind,
        LightKind::Directional {
            direction: DVec3::NEG_Z
        }
    );
    assert!((sun.light.color.r - 1.0 / PI).abs() < 1e-12);
    assert!(
        matches!(spot.light.kind, LightKind::Spot { cos_inner, cos_outer, .. } if cos_inner > cos_outer)
    );
    let bad = load(&with_nodes(&node(0, ""), &lights.replace("0.5,0", "-1,0")));
    assert!(
        messages(&bad)[0].contains("light 0: colour and intensity must be finite and not negative")
    );
}

fn with_material(material: &str, rest: &str) -> String {
    file(
        &square(),
        &[0],
        THREE,
        &format!(r#"{TRIANGLE},{ONE_NODE},"materials":[{material}]{rest}"#),
    )
}

fn material(json: &str, rest: &str) -> strahl_shade::Material {
    let scene = scene(&with_material(json, rest));
    strahl_shade::Material::clone(scene.objects.0[0].material.as_ref().expect("one"))
}

fn pbr(m: &strahl_shade::Material) -> &Pbr {
    m.pbr.as_deref().expect("physically based")
}

#[test]
fn materials_keep_their_factors() {
    let m = material(
        r#"{"name":"brass","pbrMetallicRoughness":{"baseColorFactor":[0.8,0.6,0.2,0.5],"metallicFactor":0.9,"roughnessFactor":0.25},
        "alphaMode":"MASK","alphaCutoff":0.4,"doubleSided":true,"emissiveFactor":[0,0.5,1],
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4},"KHR_materials_ior":{"ior":1.8}}}"#,
        "",
    );
    assert_eq!(
        (m.name.as_str(), m.sides, m.thin, m.fresnel),
        ("brass", Sides::Two, true, true)
    );
    assert!((m.eta - 1.8).abs() < 1e-6);
    let p = pbr(&m);
    assert!((p.f0 - (0.8f64 / 2.8).powi(2)).abs() < 1e-6 && (p.metallic - 0.9).abs() < 1e-6);
    assert_eq!((p.alpha, p.roughness, p.alpha_blend), (0.5, 0.25, false));
    assert!(p.alpha_cutoff.is_some_and(|c| (c - 0.4).abs() < 1e-6));
    assert_eq!(p.emissive, Color::new(0.0, 2.0, 4.0));
    let plain = material("{}", "");
    assert_eq!(
        (plain.name.as_str(), plain.sides, plain.eta),
        ("material 0", Sides::Front, 1.5)
    );
    let unlit = material(
        r#"{"alphaMode":"BLEND","extensions":{"KHR_materials_unlit":{}}}"#,
        "",
    );
    assert!(pbr(&unlit).unlit && pbr(&unlit).alpha_blend);
    let dull = material(
        r#"{"extensions":{"KHR_materials_specular":{"specularFactor":0.5}}}"#,
        "",
    );
    assert!((pbr(&dull).f0 - 0.02).abs() < 1e-9);
}

#[test]
fn volumes_absorb_and_are_seen_from_inside() {
    let m = material(
        r#"{"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},
        "KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[1,0.5,0]}}}"#,
        "",
    );
    assert_eq!((m.thin, m.sides, m.absorption.r), (false, Sides::Two, 0.0));
    assert!((m.absorption.g - 0.5 * std::f64::consts::LN_2).abs() < 1e-12);
    assert!(m.absorption.b > 6.0 && m.absorption.b.is_finite());
    let bad = load(&with_material(
        r#"{"extensions":{"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":0}}}"#,
        "",
    ));
    assert!(
        messages(&bad)[0]
            .contains("material 0: its attenuation distance must be positive, found 0")
    );
}

/// A picture of two texels, black and white.
const PICTURE: &[u8] = b"P5 2 1 255\n\x00\xff";

fn picture() -> String {
    format!(
        r#"{{"uri":"data:image/x-portable-graymap;base64,{}"}}"#,
        base64(PICTURE)
    )
}

#[test]
fn textures_have_samplers_and_transformations() {
    let rest = format!(
        r#","images":[{}],"samplers":[{{"magFilter":9728,"wrapS":33071,"wrapT":33648}}],
        "textures":[{{"source":0,"sampler":0}},{{"source":0}}]"#,
        picture()
    );
    let m = material(
        r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
        {"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5]}}}},
        "normalTexture":{"index":1,"scale":2,"extensions":{"KHR_texture_transform":{"offset":[0.25,0]}}},
        "occlusionTexture":{"index":1},"emissiveTexture":{"index":1}}"#,
        &rest,
    );
    let textures = &pbr(&m).textures;
    let base = textures.base_color.as_ref().expect("read");
    assert_eq!(
        (base.wrap_u, base.wrap_v, base.filter),
        (Wrap::Clamp, Wrap::Mirror, Filter::Nearest)
    );
    // The extension's own example: the lower left quadrant.
    let u = base.uv_map;
    let at = |x: f64, y: f64| DVec2::new(u[0] * x + u[1] * y + u[2], u[3] * x + u[4] * y + u[5]);
    for (from, to) in [
        ((0.0, 0.0), (0.0, 1.0)),
        ((1.0, 0.0), (0.0, 0.5)),
        ((0.0, 1.0), (0.5, 1.0)),
    ] {
        let found = at(from.0, from.1);
        assert!(
            (found - DVec2::new(to.0, to.1)).length() < 1e-6,
            "{from:?} {found}"
        );
    }
    let normal = textures.normal.as_ref().expect("read");
    assert_eq!(
        (normal.uv_map, pbr(&m).normal_scale),
        ([1.0, 0.0, 0.25, 0.0, 1.0, 0.0], 2.0)
    );
    assert_eq!(
        (normal.wrap_u, normal.filter),
        (Wrap::Repeat, Filter::Bilinear)
    );
    let (emissive, occlusion) = (
        textures.emissive.as_ref().expect("read"),
        textures.occlusion.as_ref().expect("read"),
    );
    assert!(
        std::sync::Arc::ptr_eq(&normal.image, &occlusion.image),
        "each picture is read once per use"
    );
    assert!(
        !std::sync::Arc::ptr_eq(&normal.image, &emissive.image),
        "colours are sRGB, data is linear"
    );
}

#[test]
fn pictures_that_cannot_be_had_are_warnings() {
    let rest = r#","images":[{"uri":"none.png"},{"uri":"../a.png"},{"bufferView":0,"mimeType":"image/png"},{"uri":"data:image/png;base64,!"}],
        "textures":[{"source":0},{"source":1},{"source":2},{"source":3}]"#;
    for (texture, message) in [
        (
            0,
            "image 0 is not read: `none.png`: the scene has no folder",
        ),
        (
            1,
            "image 1 is not read: `../a.png`: only files in the scene's folder or below are read",
        ),
        (2, "image 2 is not read: "),
        (3, "image 3 is not read: its data is damaged"),
    ] {
        let json =
            format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{texture}}}}}}}"#);
        let loaded = load(&with_material(&json, rest));
        assert!(
            loaded.scene.is_some() && messages(&loaded)[0].contains(message),
            "{:?}",
            messages(&loaded)
        );
    }
    let second = load(&with_material(
        r#"{"emissiveTexture":{"index":0,"texCoord":1}}"#,
        r#","images":[{"uri":"none.png"}],"textures":[{"source":0}]"#,
    ));
    assert!(
        messages(&second)[0]
            .contains("a texture for a second set of texture coordinates is ignored")
    );
}

#[test]
fn a_texture_without_a_source_is_left_out() {
    let emissive = r#"{"emissiveTexture":{"index":0},"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}"#;
    for (texture, why) in [
        ("{}", "it has no `source`"),
        (
            r#"{"extensions":{"KHR_texture_basisu":{"source":0}}}"#,
            "it has a picture only by an extension that is not supported: `KHR_texture_basisu`",
        ),
    ] {
        let rest = format!(r#","images":[{}],"textures":[{texture}]"#, picture());
        let loaded = load(&with_material(emissive, &rest));
        assert_eq!(
            messages(&loaded),
            [format!("warning: `a.gltf`: texture 0 is left out: {why}")]
        );
        let scene = loaded.scene.expect("a warning only");
        let material = scene.objects.0[0].material.as_ref().expect("one");
        assert!(pbr(material).textures.base_color.is_none());
    }
    // A number of a picture that does not exist is an error as before.
    let wrong = load(&with_material(emissive, r#","textures":[{"source":3}]"#));
    assert!(
        messages(&wrong)[0].contains("textures[0].source: the index is out of range"),
        "{:?}",
        messages(&wrong)
    );
}

#[test]
fn files_beside_the_scene_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("my data")).expect("made");
    fs::write(folder.path().join("my data/square.bin"), square()).expect("written");
    fs::write(folder.path().join("p.pgm"), PICTURE).expect("written");
    let json = with_material(
        r#"{"emissiveTexture":{"index":0}}"#,
        r#","images":[{"uri":"p.pgm"}],"textures":[{"source":0}]"#,
    );
    let start = json.find("data:application").expect("there");
    let end = start + json[start..].find('"').expect("there");
    let json = format!("{}my%20data/square.bin{}", &json[..start], &json[end..]);
    fs::write(folder.path().join("a.gltf"), &json).expect("written");
    let loaded = load_path(&folder.path().join("a.gltf"), None);
    assert_eq!(messages(&loaded), [""; 0]);
    let outside = load(&json.replace("my%20data/", "%2e%2e/"));
    assert!(
        messages(&outside)[0].contains(
            "buffer 0 (`%2e%2e/square.bin`) is not read: only files in the scene's folder"
        )
    );
}

/// A binary file with these chunks.
fn binary(json: &str, bin: &[u8]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", bin)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

#[test]
fn binary_files_bring_their_buffer() {
    let json = with_nodes(r#"{"mesh":0}"#, "");
    let start = json.find(r#","uri":"data"#).expect("there");
    let end = start + 8 + json[start + 8..].find('"').expect("there") + 1;
    let json = format!("{}{}", &json[..start], &json[end..]);
    let load = |bytes: Vec<u8>| load_bytes(bytes, "a.glb", SceneFormat::Gltf, None);
    let whole = binary(&json, &square());
    assert_eq!(messages(&load(whole.clone())), [""; 0]);
    let message = |bytes: Vec<u8>| messages(&load(bytes))[0].clone();
    assert!(
        message(whole[..whole.len() - 4].to_vec())
            .contains("a chunk should have 48 bytes, but only 44 are left")
    );
    assert!(
        message(binary(&json, &square()[..40])).contains("buffer 0 has 40 bytes instead of 48")
    );
    assert!(message(whole[..9].to_vec()).contains("ends within its header"));
    let mut old = whole.clone();
    old[4] = 1;
    assert!(message(old).contains("version 1 of binary glTF is not supported, only 2"));
    assert!(message(whole[..12].to_vec()).contains("has no JSON chunk"));
    assert!(message(json.into_bytes()).contains("buffer 0 has no data"));
}

#[test]
fn accessors_are_checked_before_they_are_read() {
    let json = with_nodes(r#"{"mesh":0}"#, "");
    let message = |from: &str, to: &str| messages(&load(&json.replace(from, to)))[0].clone();
    assert!(
        message(r#""count":3"#, r#""count":5"#)
            .contains("accessor 0 reaches beyond its buffer view")
    );
    let huge = message(r#""count":3"#, r#""count":1000000000000000"#);
    assert!(
        huge.contains("accessor 0 reaches beyond its buffer view"),
        "{huge}"
    );
    assert!(
        message(r#""byteOffset":0,"#, r#""byteOffset":40,"#)
            .contains("buffer view 0 reaches beyond its buffer")
    );
    assert!(
        message("VEC3", "VEC2").contains("accessor 0 should be of type Vec3, but is of type Vec2")
    );
    assert!(
        message(r#""POSITION":0"#, r#""POSITION":7"#)
            .contains("refers to an accessor that does not exist")
    );
    assert!(
        message(r#""mesh":0"#, r#""mesh":7"#).contains("nodes[0].mesh: the index is out of range")
    );
    let far = indexed(5121, &[0, 1, 9, 0, 0, 0], 3, 4);
    assert!(
        messages(&load(&far))[0].contains("vertex 9 is out of range: there are 4, numbered from 0")
    );
    // An accessor of zeros without data, with a huge count.
    let zeros = r#"{"componentType":5126,"count":9000000000,"type":"VEC3","min":[0,0,0],"max":[0,0,0],
        "sparse":{"count":1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}}"#;
    let zeros = json.replace(THREE, zeros);
    let zeros = messages(&load(&zeros))[0].clone();
    assert!(
        zeros.contains("far more corners than the file has bytes"),
        "{zeros}"
    );
}

#[test]
fn what_is_no_gltf_is_one_error() {
    let syntax = load("{\n  \"asset\": {\"version\": \"2.0\",}\n}");
    let expected = "error: the JSON of the glTF file is wrong: trailing comma\n --> a.gltf:2:30\n  |\n2 |   \"asset\": {\"version\": \"2.0\",}\n  |                              ^";
    assert_eq!(messages(&syntax), [expected]);
    assert!(
        messages(&load("{}"))[0]
            .contains("the JSON of the glTF file is wrong: missing field `asset`")
    );
    assert!(messages(&load("hello"))[0].contains("the JSON of the glTF file is wrong"));
    assert!(
        messages(&load(r#"{"asset":{"version":"1.0"}}"#))[0]
            .contains("version `1.0` of glTF is not supported")
    );
    let draco = load(
        r#"{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression","KHR_materials_ior"]}"#,
    );
    assert_eq!(
        messages(&draco),
        [
            "error: `a.gltf` needs extensions that are not supported: `KHR_draco_mesh_compression`\n  \
          = help: export it without compression of meshes"
        ]
    );
    let fine = load(r#"{"asset":{"version":"2.0"},"extensionsRequired":["KHR_materials_volume"]}"#);
    assert_eq!(messages(&fine), ["warning: `a.gltf` has no objects"]);
}

#[test]
fn extensions_that_are_ignored_are_named() {
    let used =
        |names: &str| with_nodes(r#"{"mesh":0}"#, &format!(r#","extensionsUsed":[{names}]"#));
    let loaded = load(&used(
        r#""KHR_texture_transform","KHR_materials_sheen","KHR_materials_pbrSpecularGlossiness","KHR_materials_sheen","KHR_xmp_json_ld""#,
    ));
    assert!(loaded.scene.is_some());
    assert_eq!(
        messages(&loaded),
        [
            "warning: `a.gltf`: extensions that are not supported are ignored: `KHR_materials_pbrSpecularGlossiness`, `KHR_materials_sheen`"
        ]
    );
    let many: Vec<_> = (10..22).map(|i| format!(r#""X_{i}""#)).collect();
    assert!(messages(&load(&used(&many.join(","))))[0].ends_with("`X_19`, ..."));
    // The reason fits the extension.
    for (name, hint) in [
        ("EXT_texture_webp", "export it with pictures as PNG or JPEG"),
        (
            "KHR_materials_clearcoat",
            "take their names out of `extensionsRequired`",
        ),
    ] {
        let json = format!(r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":["{name}"]}}"#);
        let all = messages(&load(&json));
        assert!(all.len() == 1 && all[0].contains(hint), "{all:?}");
    }
}

#[test]
fn what_moves_keeps_its_rest_pose() {
    let rest = r#","animations":[{"channels":[],"samplers":[]}],"skins":[{"joints":[0]}]"#;
    let json = with_nodes(r#"{"mesh":0,"skin":0}"#, rest).replace(
        r#"{"POSITION":0}"#,
        r#"{"POSITION":0},"targets":[{"POSITION":0}]"#,
    );
    let loaded = load(&json);
    let all = messages(&loaded);
    assert!(loaded.scene.is_some());
    for what in [
        "animations are ignored",
        "skins are ignored",
        "morph targets are ignored",
    ] {
        assert!(all.iter().any(|m| m.contains(what)), "{what}: {all:?}");
    }
}
