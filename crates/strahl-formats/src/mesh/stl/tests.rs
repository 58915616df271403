use crate::scene::{Loaded, SceneFormat, load_bytes};
use std::sync::Arc;
use strahl_geometry::{Shape, TriangleMesh};
use strahl_scene::ObjectKind;

fn load(bytes: impl Into<Vec<u8>>) -> Loaded {
    load_bytes(bytes.into(), "part.stl", SceneFormat::Stl, None)
}

fn meshes(loaded: &Loaded) -> Vec<(String, Arc<TriangleMesh>)> {
    let scene = loaded
        .scene
        .as_ref()
        .unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
    let mesh = |o: &strahl_scene::Object| match &o.kind {
        ObjectKind::Shape(Shape::TriangleMesh(mesh)) => mesh.clone(),
        other => panic!("{other:?}"),
    };
    scene
        .objects
        .0
        .iter()
        .map(|o| (o.name.as_deref().unwrap_or("").to_owned(), mesh(o)))
        .collect()
}

fn messages(loaded: &Loaded) -> Vec<String> {
    loaded.diagnostics.iter().map(ToString::to_string).collect()
}

/// The tetrahedron at the origin, as binary STL under any 80 bytes of header.
fn binary(start: &str, corners: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = start.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((corners.len() as u32).to_le_bytes());
    for triangle in corners {
        bytes.extend([0; 12]);
        bytes.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const O: [f32; 3] = [0.0; 3];
const X: [f32; 3] = [1.0, 0.0, 0.0];
const Y: [f32; 3] = [0.0, 1.0, 0.0];
const Z: [f32; 3] = [0.0, 0.0, 1.0];
const TETRAHEDRON: [[[f32; 3]; 3]; 4] = [[O, Y, X], [O, X, Z], [O, Z, Y], [X, Y, Z]];

#[test]
fn binary_files_are_welded_even_if_they_begin_with_solid() {
    for start in ["made by a test", "solid but binary", ""] {
        let loaded = load(binary(start, &TETRAHEDRON));
        let [(name, mesh)] = &meshes(&loaded)[..] else {
            panic!("one mesh")
        };
        assert_eq!(
            (name.as_str(), mesh.triangle_count(), mesh.positions().len()),
            ("part.stl", 4, 4)
        );
        assert!(loaded.diagnostics.is_empty());
    }
}

#[test]
fn the_two_zeros_are_one_corner() {
    let turned = [[[-0.0, 0.0, -0.0], [1.0, 0.0, -0.0], Z]];
    let loaded = load(binary("", &[TETRAHEDRON[0], turned[0]]));
    assert_eq!(meshes(&loaded)[0].1.positions().len(), 4);
}

#[test]
fn ascii_files_have_solids_with_names_and_lines() {
    let facet = |z: &str| {
        format!(
            "  facet normal nan 0 {z}\n outer loop\n vertex 0 0 {z}\n vertex 1 0 {z}\n vertex 0 1e0 {z}\n endloop\n endfacet\n"
        )
    };
    let text = format!(
        "solid first one\n{}{}endsolid first one\nSOLID\n{}endsolid\n",
        facet("0"),
        facet("1"),
        facet("2")
    );
    let loaded = load(text);
    let all = meshes(&loaded);
    assert_eq!(all[0].0, "first one");
    assert_eq!(
        (all[0].1.triangle_count(), all[0].1.face_line(1)),
        (2, Some(9))
    );
    assert_eq!(
        (all[1].0.as_str(), all[1].1.triangle_count()),
        ("part.stl", 1)
    );
}

#[test]
fn errors_of_ascii_files_have_a_caret() {
    let loaded = load("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n");
    assert!(loaded.scene.is_none());
    let expected = "error: expected a coordinate, found `zero`\n --> part.stl:4:12\n  |\n4 | vertex 0 0 zero\n  |            ^^^^\n  = help: numbers are written like `-1`, `0.5` or `2.5e-3`";
    assert_eq!(messages(&loaded), [expected]);
    let cut = load("solid a\nfacet normal 0 0 1\nouter");
    assert!(
        messages(&cut)[0]
            .starts_with("error: expected `loop`, found the end of the file\n --> part.stl:3:6")
    );
    assert!(messages(&load("solid a\nendsolid"))[0].contains("`part.stl` has no triangles"));
    assert!(
        messages(&load("solid a\nvertex"))[0]
            .contains("expected `facet` or `endsolid`, found `vertex`")
    );
}

#[test]
fn zeros_behind_a_text_are_ignored_with_a_warning() {
    let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    for zeros in [1, 100] {
        let mut bytes = text.as_bytes().to_vec();
        bytes.extend(vec![0; zeros]);
        let loaded = load(bytes);
        assert_eq!(
            messages(&loaded),
            [format!(
                "warning: `part.stl`: {zeros} zero bytes behind the text are ignored"
            )]
        );
    }
    let mut bytes = text.as_bytes().to_vec();
    bytes[40] = 0;
    assert!(messages(&load(bytes))[0].contains("it begins with `solid` but is not a text"));
    assert!(messages(&load("solid\0"))[0].contains("expected `facet` or `endsolid`"));
}

#[test]
fn ascii_files_may_be_untidy() {
    let tidy = "solid a #1\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
        facet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 1 0 1\nvertex 0 1 1\nendloop\nendfacet\nendsolid a #1\n";
    let said = |text: &str| {
        let loaded = load(text);
        assert_eq!(
            meshes(&loaded)
                .iter()
                .map(|(name, mesh)| (name.as_str(), mesh.triangle_count()))
                .collect::<Vec<_>>(),
            [("a #1", 2)],
            "{text}"
        );
        loaded
            .diagnostics
            .into_iter()
            .map(|d| d.message)
            .collect::<Vec<_>>()
    };
    for text in [
        tidy.to_owned(),
        format!("# made by hand\r\n\n#\n{tidy}"),
        tidy.replace("facet normal", "# facet\nfacet normal"),
        tidy.replace("endloop", "end loop")
            .replace("endfacet", "End Facet"),
        tidy.replace("endsolid", "end solid"),
        format!("{tidy}\x1a\x1a\r\n"),
        format!("{tidy}# the end\x1a"),
    ] {
        assert_eq!(said(&text), [""; 0], "{text}");
    }
    let colours = tidy.replace("facet normal", "color 1 0 0\nfacet normal");
    assert_eq!(
        said(&colours),
        ["colours are ignored (2 times, this is the first)"]
    );
    let open = tidy.replace("endsolid a #1\n", "");
    assert_eq!(
        said(&open),
        ["`endsolid` is missing at the end of the file"]
    );
    // But a facet must be complete.
    for end in ["endfacet\n", "endloop\nendfacet\n"] {
        let cut = open.strip_suffix(end).expect("the end");
        assert!(load(cut).scene.is_none(), "{cut}");
    }
    assert!(load(tidy.replacen("endloop", "end", 1)).scene.is_none());
    let other = format!("shape a\n{}", &tidy[11..]);
    assert_eq!(
        messages(&load(other)),
        ["error: `part.stl` is not an STL file: it is a text whose first word is not `solid`"]
    );
}

#[test]
fn a_byte_order_mark_in_a_binary_header_is_one_of_its_bytes() {
    let loaded = load(binary("\u{feff}made by a test", &TETRAHEDRON));
    assert_eq!(messages(&loaded), [""; 0]);
    assert_eq!(meshes(&loaded)[0].1.triangle_count(), 4);
}

#[test]
fn damaged_binary_files_are_named() {
    let mut cut = binary("", &TETRAHEDRON);
    cut.truncate(cut.len() - 60);
    assert_eq!(
        messages(&load(cut)),
        [
            "error: `part.stl` is not an STL file, or it is cut off: its header says 4 triangles, but it has room for 2"
        ]
    );
    let mut long = binary("", &TETRAHEDRON);
    long.extend([0; 7]);
    assert_eq!(
        messages(&load(long)),
        ["warning: `part.stl`: 7 bytes behind the last triangle are ignored"]
    );
    let nan = load(binary("", &[TETRAHEDRON[0], [O, X, [f32::NAN; 3]]]));
    assert_eq!(
        messages(&nan),
        ["error: `part.stl`: triangle 2 has a coordinate that is not a finite number"]
    );
    assert!(messages(&load(vec![1, 2, 3]))[0].contains("too short for a binary file (3 bytes)"));
    let flat = load(binary("", &[[O, X, X], [O, O, O], TETRAHEDRON[0]]));
    assert_eq!(meshes(&flat)[0].1.triangle_count(), 1);
    assert_eq!(
        messages(&flat),
        [
            "warning: `part.stl`: triangle 1 has no area and is left out (2 times, this is the first)"
        ]
    );
}
