use crate::scene::{Loaded, SceneFormat, load_bytes};
use std::sync::Arc;
use strahl_geometry::{Primitive, Shape, TriangleMesh};
use strahl_math::DVec3;
use strahl_scene::ObjectKind;

fn load(bytes: impl Into<Vec<u8>>) -> Loaded {
    load_bytes(bytes.into(), "models/part.ply", SceneFormat::Ply, None)
}

fn messages(loaded: &Loaded) -> Vec<String> {
    loaded.diagnostics.iter().map(ToString::to_string).collect()
}

fn mesh(loaded: &Loaded) -> Arc<TriangleMesh> {
    let scene = loaded
        .scene
        .as_ref()
        .unwrap_or_else(|| panic!("{:?}", messages(loaded)));
    assert_eq!(scene.objects.0[0].name.as_deref(), Some("part.ply"));
    match &scene.objects.0[0].kind {
        ObjectKind::Shape(Shape::TriangleMesh(mesh)) => mesh.clone(),
        other => panic!("{other:?}"),
    }
}

const SQUARE: &str = "ply\nformat ascii 1.0\ncomment a square and a list of nothing\nobj_info x\n\
    element material 1\nproperty list uchar float ramp\nproperty int id\n\
    element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar quality\n\
    element face 2\nproperty uchar flag\nproperty list uchar int vertex_indices\nproperty list uchar float weights\n\
    element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n\
    3 0.1 0.2 0.3 7\n0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n1 4 0 1 2 3 2 0 0\n0 3 0 2 1 0\n0 1\n";

#[test]
fn unknown_elements_and_properties_are_skipped() {
    for text in [
        SQUARE.to_owned(),
        SQUARE.replace('\n', "\r\n"),
        SQUARE.replace('\n', "\r"),
    ] {
        let loaded = load(text);
        assert_eq!(messages(&loaded), [""; 0]);
        let mesh = mesh(&loaded);
        assert_eq!(mesh.indices(), [[0, 1, 2], [0, 2, 3], [0, 2, 1]]);
        assert_eq!(mesh.positions()[2], [1.0, 1.0, 0.0]);
    }
}

/// A triangle and its header in one of the binary encodings; `y` is a double and the indices have 16 bits.
fn binary(big_endian: bool, line_end: &str, face: &[u16]) -> Vec<u8> {
    let order = if big_endian { "big" } else { "little" };
    let header = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty float x\nproperty double y\nproperty float32 z\n\
         property int8 k\nproperty float u\nproperty float v\nproperty float nx\nproperty float ny\nproperty float nz\n\
         element face 1\nproperty list uint ushort vertex_index\nend_header\n"
    );
    let mut bytes = header.replace('\n', line_end).into_bytes();
    let mut put = |le: &[u8]| {
        if big_endian {
            bytes.extend(le.iter().rev())
        } else {
            bytes.extend(le)
        }
    };
    for [x, y, z] in [[10.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0f32]] {
        put(&x.to_le_bytes());
        put(&f64::from(y).to_le_bytes());
        put(&z.to_le_bytes());
        put(&[200]);
        for value in [0.25, 0.75, 0.0, 0.0, 2.0f32] {
            put(&value.to_le_bytes());
        }
    }
    put(&(face.len() as u32).to_le_bytes());
    for index in face {
        put(&index.to_le_bytes());
    }
    bytes
}

#[test]
fn binary_files_of_both_orders_are_read() {
    for big_endian in [false, true] {
        for line_end in ["\n", "\r\n", "\r"] {
            let loaded = load(binary(big_endian, line_end, &[0, 1, 2]));
            assert_eq!(messages(&loaded), [""; 0]);
            let mesh = mesh(&loaded);
            assert_eq!(
                (mesh.indices(), mesh.positions()[0]),
                ([[0, 1, 2]].as_slice(), [10.0, 0.0, 0.0])
            );
        }
    }
}

#[test]
fn a_body_that_begins_with_a_line_feed_is_not_shortened() {
    // The first byte of 10 as a little-endian integer is a line feed.
    let mut bytes = b"ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty int x\rproperty int y\rproperty int z\r\
        element face 1\rproperty list uchar uchar vertex_indices\rend_header\r"
        .to_vec();
    bytes.extend(
        [[10i32, 0, 0], [0, 1, 0], [0, 0, 1]]
            .as_flattened()
            .iter()
            .flat_map(|x| x.to_le_bytes()),
    );
    bytes.extend([3, 0, 1, 2]);
    assert_eq!(mesh(&load(bytes)).positions()[0], [10.0, 0.0, 0.0]);
}

#[test]
fn strips_turn_every_second_triangle() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty float y\nproperty float z\n\
        element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 2 1\n";
    assert_eq!(
        mesh(&load(text)).indices(),
        [[0, 1, 2], [2, 1, 3], [0, 2, 1]]
    );
}

#[test]
fn double_coordinates_far_away_keep_their_detail() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n\
        1000000.25 0 0\n1000001.375 0 0\n1000000.25 0.001 0\n3 0 1 2\n";
    let [a, b, _] = mesh(&load(text)).corners(0);
    assert!((b.x - a.x - 1.125).abs() < 1e-6);
}

#[test]
fn headers_that_lie_about_the_size_are_caught_before_memory_is_taken() {
    for (count, encoding) in [
        ("1000000000000", "ascii"),
        ("18446744073709551615", "binary_little_endian"),
    ] {
        let text = SQUARE.replace("element vertex 4", &format!("element vertex {count}"));
        let loaded = load(text.replace("format ascii", &format!("format {encoding}")));
        assert!(loaded.scene.is_none());
        let message = &messages(&loaded)[0];
        let known = message.contains(&format!("declares {count} elements `vertex`, which take"))
            || message.contains("ends too early");
        assert!(known, "{message}");
    }
    // Elements without properties take no bytes, so there may be any number of them.
    let many = SQUARE.replace(
        "element edge 1\nproperty int vertex1\nproperty int vertex2\n",
        "element nothing 18446744073709551615\n",
    );
    assert!(load(many).scene.is_some());
}

#[test]
fn wrong_rows_are_named() {
    let message = |from: &str, to: &str| messages(&load(SQUARE.replace(from, to)))[0].clone();
    let expected = "error: face 0 (counted from 0): vertex 4 is out of range: there are 4, numbered from 0\n  \
        --> models/part.ply:26:17\n   |\n26 | 1 4 0 1 4 3 2 0 0\n   |                 ^";
    assert_eq!(message("1 4 0 1 2 3", "1 4 0 1 4 3"), expected);
    assert!(
        message("3 0 2 1 0", "3 0 -2 1 0")
            .contains("face 1 (counted from 0): vertex -2 is out of range")
    );
    assert!(
        message("1 1 0 255", "1 nan 0 255")
            .contains("face 0 (counted from 0): the position of vertex 2 is not a finite number")
    );
    assert!(
        message("3 0 2 1 0", "-3 0 2 1 0")
            .contains("the length of a list cannot be negative, found `-3`")
    );
    let mut cut = binary(false, "\n", &[0, 1, 2]);
    cut.truncate(cut.len() - 1);
    assert!(messages(&load(cut))[0].contains("`models/part.ply` ends too early"));
    assert!(
        messages(&load(binary(true, "\n", &[0, 1, 9])))[0]
            .contains("vertex 9 is out of range: there are 3")
    );
    let mut nan = binary(false, "\n", &[0, 1, 2]);
    let at = nan
        .windows(11)
        .position(|w| w == b"end_header\n")
        .expect("there")
        + 11;
    nan[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        messages(&load(nan))[0],
        "error: `models/part.ply`: face 0 (counted from 0): the position of vertex 0 is not a finite number"
    );
}

#[test]
fn only_faces_need_finite_positions() {
    // Vertex 0 is not used, vertex 2 has no normal, vertex 3 no texture coordinates.
    let text = |kind: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty {kind} y\nproperty float z\n\
             property float nx\nproperty double ny\nproperty float nz\nproperty float u\nproperty float v\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n\
             0 -nan(ind) inf 0 0 1 0 0\n0 0 0 0 0 1 0 0\n1 0 0 nan 1e200 nan 0 0\n0 1 0 0 0 1 1 nan\n3 1 2 3\n"
        )
    };
    for kind in ["float", "double"] {
        let loaded = load(text(kind));
        assert_eq!(
            messages(&loaded),
            [
                "warning: `models/part.ply`: positions that are not finite are left out, as of vertex 0 (counted from 0)",
                "warning: `models/part.ply`: normals that are not finite count as none, as of vertex 2 (counted from 0)",
                "warning: `models/part.ply`: texture coordinates that are not finite count as none, as of vertex 3 (counted from 0)",
            ]
        );
        let bounds = mesh(&loaded).bounds();
        assert_eq!(
            (bounds.min, bounds.max),
            (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0))
        );
    }
    for face in ["3 1 0 2", "4 1 2 3 0"] {
        let used = messages(&load(
            text("float").replace("3 1 2 3\n", &format!("{face}\n")),
        ));
        assert!(
            used[0].contains("the position of vertex 0 is not a finite number"),
            "{used:?}"
        );
    }
}

#[test]
fn wrong_headers_are_named() {
    let message = |from: &str, to: &str| messages(&load(SQUARE.replace(from, to)))[0].clone();
    assert!(
        message("format ascii", "format morse")
            .contains("unknown encoding `morse`\n --> models/part.ply:2:8")
    );
    assert!(message("ascii 1.0", "ascii 2.0").contains("expected the version 1.0, found `2.0`"));
    assert!(message("property float y", "property real y").contains("unknown type `real`"));
    assert!(
        message("property float y", "property float y2")
            .contains("the vertices have no property `y`")
    );
    assert!(
        message("element vertex 4", "element vertex four")
            .contains("expected the number of elements, found `four`")
    );
    assert!(
        message("list uchar int", "list float int")
            .contains("the length of a list must be of an integer type")
    );
    assert!(
        message("uchar int vertex_indices", "uchar float vertex_indices")
            .contains("indices of element `face` are not of an integer type")
    );
    assert!(
        message("vertex_indices", "corners")
            .contains("element `face` has no list `vertex_indices`")
    );
    assert!(message("element vertex", "element point").contains("declares no element `vertex`"));
    assert!(
        message("element material 1", "element face 1")
            .contains("element `face` comes before element `vertex`")
    );
    assert!(
        message("element edge 1", "element vertex 1")
            .contains("element `vertex` is declared twice")
    );
    assert!(message("format ascii 1.0\n", "").contains("the header has no `format` line"));
    assert!(message("end_header", "enough").contains("unknown word `enough` in the header"));
    assert!(messages(&load("plywood"))[0].contains("does not begin with `ply`"));
    assert!(
        messages(&load("ply\nformat ascii 1.0\n"))[0]
            .contains("expected `end_header`, found the end of the file")
    );
    let message = messages(&load("ply\nproperty float x\n"))[0].clone();
    assert!(message.contains("`property` comes before the first `element`"));
}

#[test]
fn clouds_and_colours_are_remarked_upon() {
    let cloud = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
    assert!(messages(&load(cloud))[0].contains("has 1 vertices but no faces"));
    let colors = SQUARE.replace(
        "property uchar quality",
        "property uchar red\nproperty uchar green\nproperty uchar blue",
    );
    let colors = colors.replace(" 255\n", " 255 0 0\n");
    let loaded = load(colors);
    assert!(
        mesh(&loaded).triangle_count() == 3
            && messages(&loaded)[0].contains("the colours of the vertices are ignored")
    );
    let wedges = load(SQUARE.replace("float weights", "float texcoord"));
    assert!(
        mesh(&wedges).triangle_count() == 3
            && messages(&wedges)[0]
                .contains("the texture coordinates of the faces (`texcoord`) are ignored")
    );
    let flat = load(SQUARE.replace("3 0 2 1 0", "3 0 2 2 0"));
    assert!(messages(&flat)[0].contains("face 1 (counted from 0) is left out: it has no area"));
}
