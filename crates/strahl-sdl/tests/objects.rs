//! Objects: their syntax, their descriptions, and the messages about errors.

use crate::common::{debug, errors, parse_with};
use std::sync::Arc;
use strahl_geometry::{Isosurface, Primitive, Scratch, Shape, SubdivisionScheme};
use strahl_math::{DVec2, DVec3, Interval, Ray};
use strahl_scene::{CsgOp, Object, ObjectKind, Scene};
use strahl_sdl::MemoryHost;
use strahl_shade::Color;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::texture::Texture;

/// The scene of a text without errors, and its warnings.
fn scene(text: &str) -> (Scene, Vec<String>) {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let Some(scene) = parsed.scene else {
        panic!("{text}\n{}", messages.join("\n"));
    };
    (scene, messages)
}

/// The only object of a text without messages.
fn object(text: &str) -> Object {
    let (mut scene, messages) = scene(text);
    assert!(messages.is_empty(), "{text}\n{}", messages.join("\n"));
    assert_eq!(scene.objects.0.len(), 1, "{text}");
    scene.objects.0.remove(0)
}

fn shape(text: &str) -> Shape {
    match &object(text).kind {
        ObjectKind::Shape(shape) => shape.clone(),
        other => panic!("{text}\n{other:?}"),
    }
}

fn operation(object: &Object) -> (CsgOp, &[Object]) {
    match &object.kind {
        ObjectKind::Csg { op, children } => (*op, &children.0),
        other => panic!("{other:?}"),
    }
}

/// Checks that all texts describe the same shape.
fn same(texts: &[&str]) {
    let first = format!("{:?}", shape(texts[0]));
    for text in texts {
        assert_eq!(format!("{:?}", shape(text)), first, "{text}");
    }
}

#[test]
fn commas_and_braces_may_be_written_in_many_ways() {
    same(&[
        "sphere { <1, 2, 3>, 0.5 }",
        "sphere{<1 2 3> .5}",
        "#declare R = 0.5; sphere { <1, 2, 3> R }",
        "#macro S(P, R) sphere { P R #end S(<1, 2, 3>, 0.5) }",
        "sphere { #if (1) <1, 2, 3>, #else 0, #end 0.5 }",
    ]);
    same(&[
        "box { <0, 0, 0>, <1, 2, 3> }",
        "box { 0 <1, 2, 3> }",
        "box { <1, 0, 3> <0, 2, 0> }",
    ]);
    same(&[
        "plane { y, 2 }",
        "plane { <0, 3, 0> 2 }",
        "plane { y 2 hollow }",
    ]);
    same(&[
        "disc { 0, y, 2 }",
        "disc { 0 y 2 }",
        "disc { 0, y, 2, 0 }",
        "disc { 0 y 2 0 }",
    ]);
    same(&[
        "disc { 0, y, 2, 1 }",
        "disc { 0 y 2 1 }",
        "#declare H = 1; disc { 0 y 2 H }",
    ]);
    same(&[
        "cylinder { 0, y, 2 }",
        "cylinder { 0 y 2 }",
        "cylinder { 0 y, -2 }",
    ]);
    same(&["cylinder { 0, y, 2 open }", "cylinder { 0 y 2 open }"]);
    same(&["cone { 0, 2, y, 1 }", "cone { 0 2 y 1 }"]);
    same(&["cone { 0, 2, y, 0 open }", "cone { 0 2 y 0 open }"]);
    same(&[
        "torus { 2, 1 }",
        "torus { 2 1 sturm }",
        "torus { 2, 1 sturm on }",
        "torus { 2 1 sturm 1 }",
    ]);
    same(&[
        "quadric { <1, 2, 3>, <0, 0, 0>, <0, 1, 0>, -1 }",
        "quadric { <1, 2, 3> 0 y, -1 }",
    ]);
    same(&[
        "cubic { <1, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 3, 4> }",
        "poly { 3 <1 0 0 0 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 3, 4> sturm }",
        "polynomial { 3, xyz(1, 0, 0): 2, xyz(3, 0, 0): 7, xyz(0, 0, 1): 3 xyz(0, 0, 0): 4, xyz(3, 0, 0): 1 sturm }",
        "polynomial { 5 xyz(3 0 0): 1 xyz(1, 0, 0): 2, xyz(0, 0, 1): 3, xyz(0, 0, 0): 4 }",
    ]);
    same(&[
        "blob { threshold 0.6 sphere { x, 1, 2 } cylinder { 0, y, 1, 1 } }",
        "blob { threshold 0.6, sphere { x 1 strength 2 } cylinder { 0 y 1 strength 1 } sturm hierarchy off }",
        "blob { component 2, 1, x cylinder { 0, y, 1, 1 } threshold 0.6 }",
        "blob { component 2 1 x cylinder { 0, y, 1, 1 } threshold 0.6 sturm }",
    ]);
    same(&[
        "blob { sphere { 0, 1, 2 translate x } }",
        "blob { threshold 1 sphere { x, 1, 2 } }",
    ]);
    same(&["triangle { 0, x, y }", "triangle { 0 x y }"]);
    same(&[
        "smooth_triangle { 0, z, x, <0, 1, 1>, y, <1, 0, 1> }",
        "smooth_triangle { 0 z x <0, 1, 1> y <1, 0, 1> }",
    ]);
    same(&[
        "polygon { 4, <0, 0>, <1, 0>, <0, 1>, <0, 0> }",
        "polygon { 4 <0, 0> <1, 0> <0, 1> <0, 0> }",
        "polygon { 4, <0, 0, 0> x, y, 0 }",
    ]);
    same(&[
        "mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 2> } }",
        "mesh2 { vertex_vectors { 3 0 x y } face_indices { 1 <0, 1, 2> } }",
        "mesh2 { vertex_vectors { 3, 0, x, y, } face_indices { 1, <0, 1, 2>, } }",
    ]);
    same(&[
        "mesh { triangle { 0, x, y } }",
        "mesh { triangle { 0 x y } hierarchy off }",
    ]);
}

#[test]
fn what_cannot_be_seen_is_left_out_with_a_warning() {
    for text in [
        "sphere { 0, 0 }",
        "box { 0, x }",
        "box { 0, 0 }",
        "cone { 0, 0, y, 0 }",
        "cylinder { 0, y, 0 }",
        "disc { 0, y, 1, 2 }",
        "disc { 0, 0, 1 }",
        "torus { 1, 0 }",
        "triangle { 0, x, 2 * x }",
        "smooth_triangle { 0, y, x, y, 2 * x, y }",
        "quadric { 1, 0, 0, 1 }",
        "polynomial { 3, xyz(0, 0, 0): 1 }",
        "superellipsoid { <-1, 1> }",
        "blob { threshold 2 sphere { 0, 1, 1 } }",
        "blob { threshold 0 sphere { 0, 1, 1 } }",
        "polygon { 4, <0, 0>, <1, 0>, <2, 0>, <0, 0> }",
        "mesh { triangle { 0, x, 2 * x } }",
        "mesh2 { vertex_vectors { 3, 0, x, 2 * x } face_indices { 1, <0, 1, 2> } }",
        "union { }",
        "intersection { sphere { 0, 1 } sphere { 0, 0 } }",
        "difference { sphere { 0, 0 } sphere { 0, 1 } }",
        "sphere { 0, 0 clipped_by { plane { y, 0 } } inverse }",
        "object { sphere { 0, 0 } scale 2 }",
    ] {
        let (scene, messages) = scene(text);
        assert!(scene.objects.0.is_empty(), "{text}: {:?}", scene.objects);
        assert!(!messages.is_empty(), "{text}");
    }
    let (scene, messages) = scene("difference { sphere { 0, 1 } sphere { 0, 0 } }");
    assert_eq!(operation(&scene.objects.0[0]).1.len(), 1);
    assert!(messages[0].contains("radius of the sphere"), "{messages:?}");
}

#[test]
fn eggs_and_lemons_are_read() {
    let plain = shape("ovus { 1, 0.5 }");
    assert!(matches!(&plain, Shape::Ovus(egg) if (egg.bottom(), egg.top()) == (1.0, 0.5)));
    let loose = shape("ovus { 1 0.5, sturm scale 1 }");
    assert_eq!(format!("{loose:?}"), format!("{plain:?}"));
    let plain = format!("{:?}", shape("lemon { 0, 0.5, y, 0.2, 2 open }"));
    let loose = shape("lemon { <0,0,0> 0.5 y 0.2 2 sturm open }");
    assert_eq!(format!("{loose:?}"), plain);
    let closed = format!("{:?}", shape("lemon { 0, 0.5, y, 0.2, 2 }"));
    assert_ne!(closed, plain);
    // The least inner radius is taken instead of a smaller one.
    let (_, messages) = scene("lemon { -y, 0, y, 0, 0.3 }");
    assert!(
        messages[0].contains("inner radius of the lemon, 0.3, is too small"),
        "{messages:?}"
    );
    assert!(
        messages[0].contains("the least one is used: 1"),
        "{messages:?}"
    );
    let (read, messages) = scene("ovus { 1, -0.5 }");
    assert!(
        read.objects.0.is_empty() && messages[0].contains("top radius"),
        "{messages:?}"
    );
    // Scenes of version 3.7 may use the word as a name.
    let (read, _) = scene("#version 3.7; #declare lemon = sphere { 0, 1 } object { lemon }");
    assert_eq!(read.objects.0.len(), 1);
}

#[test]
fn items_that_are_missing_yet_are_named() {
    let (_, messages) =
        scene("sphere { 0, 1 photons { target } double_illuminate radiosity { importance 1 } }");
    assert_eq!(messages.len(), 2, "{messages:?}");
}

/// The sixteen points of a flat patch.
const FLAT_PATCH: &str = "<0,0,0><1,0,0><2,0,0><3,0,0> <0,1,0><1,1,0><2,1,0><3,1,0> <0,2,0><1,2,0><2,2,0><3,2,0> <0,3,0><1,3,0><2,3,0><3,3,0>";

#[test]
fn the_items_of_patches_are_read_in_any_order() {
    let commas = FLAT_PATCH.replace("><", ">, <").replace("> <", ">, <");
    let plain = format!(
        "{:?}",
        shape(&format!("bicubic_patch {{ type 0 {FLAT_PATCH} }}"))
    );
    for text in [
        format!("type 1 flatness 0.01 u_steps 3 v_steps 3 {FLAT_PATCH}"),
        format!("v_steps 3, u_steps 3, type 1, accuracy 0.01, {commas}"),
        format!("0 3 3 {FLAT_PATCH}"),
        format!("1, 3, 3, {commas},"),
        format!("2 0.01 3 3 {FLAT_PATCH}"),
        format!("type 1 {}", FLAT_PATCH.replace('>', ",1>")),
    ] {
        let found = shape(&format!("bicubic_patch {{ {text} }}"));
        assert_eq!(format!("{found:?}"), plain, "{text}");
    }
    let Shape::BicubicPatch(patch) = shape(&format!(
        "bicubic_patch {{ type 1 uv_vectors <0,0><1,0>,<1,1><0,1> {} uv_mapping rotate x inverse }}",
        FLAT_PATCH.replace("<1,1,0>", "<1,1,0,2.5>")
    )) else {
        panic!("no patch");
    };
    assert_eq!(patch.weights()[1], [1.0, 2.5, 1.0, 1.0]);
    assert_eq!(patch.points()[1][1], DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn mistakes_in_patches_are_explained() {
    for (text, expected) in [
        (FLAT_PATCH.to_owned(), "begins with its `type`"),
        ("type 1 <0,0,0> <1,0,0>".to_owned(), "error"),
        (
            format!("type 1 {}", FLAT_PATCH.replace("<1,1,0>", "<1,1,0,1,1>")),
            "three components, or four with a weight, found 5",
        ),
        (
            format!(
                "type 1 {}",
                FLAT_PATCH.replace("<1,1,0>", "<1,1e200*1e200,0>")
            ),
            "control point of the bicubic patch 5 is not finite",
        ),
        (
            format!("type 1 {}", FLAT_PATCH.replace("<1,1,0>", "<1,1,0,-1>")),
            "weight of the bicubic patch must be greater than 0, found -1",
        ),
        (
            format!("type 1 {}", "<1,2,3>".repeat(16)),
            "its control points lie on a line",
        ),
    ] {
        let text = format!("sphere {{ 0, 1 }} bicubic_patch {{ {text} }}");
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        assert!(
            messages.iter().any(|m| m.contains(expected)),
            "{text}: {messages:?}"
        );
    }
}

/// A plane surface of degree 1 over the unit square.
const FLAT_NURBS: &str = "degree 1 row { <0,0,0>, <1,0,0> } row { <0,1,0>, <1,1,0> }";

#[test]
fn the_items_of_nurbs_are_read_in_any_order() {
    let plain = format!("{:?}", shape(&format!("nurbs {{ {FLAT_NURBS} }}")));
    for text in [
        "row { 0, x } row { y, x + y } degree <1, 1>",
        "u_knots { 0, 0, 1, 1 } row { 0 x } row { <0,1,0,1> <1,1,0,1> }, v_knots { 0 0, 1 1 } degree 1",
        // The words are names as elsewhere, and directives work.
        "#declare degree = 7; degree 1 #for (I, 0, 1) row { I * y, I * y + x } #end",
        "#declare row = 3; #declare hole = 2; degree 1 row { 0, x } row { y, x + y }",
    ] {
        let found = shape(&format!("nurbs {{ {text} }}"));
        assert_eq!(format!("{found:?}"), plain, "{text}");
    }
    let found = shape(
        "nurbs { degree <2, 1> row { 0, <1,1,0,2>, x * 2 } row { z, <1,1,1,2>, x * 2 + z } pigment { rgb 1 } uv_mapping scale 2 }",
    );
    let Shape::Nurbs(nurbs) = &found else {
        panic!("no NURBS surface");
    };
    assert_eq!(nurbs.elements(), 1);
    // Scenes may use the word as a name.
    let (read, _) = scene("#declare nurbs = sphere { 0, 1 } object { nurbs }");
    assert_eq!(read.objects.0.len(), 1);
}

#[test]
fn nurbs_are_trimmed_by_polygons_and_curves() {
    let hits = |text: &str, x: f64, y: f64| {
        let found = shape(&format!("nurbs {{ {FLAT_NURBS} {text} }}"));
        let ray = Ray::new(DVec3::new(x, y, -1.0), DVec3::Z);
        found.any_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
    };
    assert!(hits("", 0.5, 0.5) && hits("", 0.1, 0.9));
    let square = "{ <0.25, 0.25>, <0.75, 0.25>, <0.75, 0.75>, <0.25, 0.75> }";
    assert!(
        hits(&format!("trim {square}"), 0.5, 0.5) && !hits(&format!("trim {square}"), 0.1, 0.9)
    );
    assert!(
        !hits(&format!("hole {square}"), 0.5, 0.5) && hits(&format!("hole {square}"), 0.1, 0.9)
    );
    // A half disc: an arc, and a line back.
    let half = "trim { curve { degree 2 knots { 0, 0, 0, 1, 1, 2, 2, 2 }
          <0.9, 0.5>, <0.9, 0.9, sqrt(0.5)>, <0.5, 0.9>, <0.1, 0.9, sqrt(0.5)>, <0.1, 0.5> }
        curve { <0.1, 0.5>, <0.9, 0.5> } }";
    let (inner, outer) = (0.5 + 0.399 * 0.6, 0.5 + 0.401 * 0.6);
    let up = |x: f64| 0.5 + (x - 0.5) / 0.6 * 0.8;
    assert!(
        hits(half, inner, up(inner)) && !hits(half, outer, up(outer)) && !hits(half, 0.5, 0.49)
    );
}

/// The box of a trimmed surface is that of what its loops leave.
#[test]
fn extents_of_nurbs_are_those_of_what_is_left() {
    let extents = |text: &str| {
        let text = format!(
            "#declare N = nurbs {{ {FLAT_NURBS} {text} }} #declare A = min_extent(N); #declare B = max_extent(N);
             sphere {{ 0, B.x - A.x }} sphere {{ 0, B.y - A.y }}"
        );
        let (read, _) = scene(&text);
        let widths = read.objects.0.iter().map(|object| match &object.kind {
            ObjectKind::Shape(Shape::Sphere(sphere)) => sphere.radius(),
            other => panic!("{other:?}"),
        });
        widths.collect::<Vec<_>>()
    };
    let square = "{ <0.25, 0.25>, <0.75, 0.25>, <0.75, 0.75>, <0.25, 0.75> }";
    let whole = extents("");
    for (part, left) in whole.iter().zip(extents(&format!("trim {square}"))) {
        assert!((left / part - 0.5).abs() < 0.2, "{part} {left}");
    }
    for (part, left) in whole.iter().zip(extents(&format!("hole {square}"))) {
        assert!((left / part - 1.0).abs() < 1e-5, "{part} {left}");
    }
}

/// A face of thousands of corners is read in time.
#[test]
fn wide_faces_of_subdivision_surfaces_are_read() {
    let count = 4000;
    let corners: Vec<String> = (0..count).map(|i| i.to_string()).collect();
    let point = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        format!("<{}, 0, {}>", angle.cos(), angle.sin())
    };
    let points: Vec<String> = (0..count).map(point).collect();
    let text = format!(
        "subdivision {{ points {{ {} }} face {{ {} }} }}",
        points.join(", "),
        corners.join(", ")
    );
    let Shape::Subdivision(surface) = shape(&text) else {
        panic!("no subdivision surface");
    };
    assert_eq!(surface.elements(), count);
}

#[test]
fn mistakes_in_nurbs_are_explained() {
    for (text, expected) in [
        ("", "expected `row`, `degree`, `u_knots`"),
        ("degree 3", "expected `row`, `degree`, `u_knots`"),
        (
            "degree 2.5 row { 0 }",
            "a degree is a whole number from 1 to 9",
        ),
        (
            "degree 12 row { 0 }",
            "a degree is a whole number from 1 to 9",
        ),
        (
            "row { 0, x } row { y }",
            "this row has 1 control points, but the first has 2",
        ),
        ("row { }", "this row has 0 control points"),
        (
            "row { <1, 2, 3, 4, 5> }",
            "has 3 components here, or 4 with a weight, found 5",
        ),
        (
            "row { 0, x } row { y, x + y }",
            "2 columns of control points of the NURBS surface given, 4 expected",
        ),
        (
            "degree 1 u_knots { 0, 1 } row { 0, x } row { y, x + y }",
            "2 control points in a row of degree 1 need 4 `u_knots`, found 2",
        ),
        (
            "degree <1, 2> v_knots { 0, 1 } row { 0, x } row { y, x + y } row { z, x + z }",
            "3 rows of degree 2 need 6 `v_knots`, found 2",
        ),
        (
            "degree 1 u_knots { 0, 1, 0, 1 } row { 0, x } row { y, x + y }",
            "at least as large as the one before",
        ),
        (
            "degree 1 row { <0, 0, 0, 0>, x } row { y, x + y }",
            "must be greater than 0, found 0",
        ),
        (
            "degree 1 row { 0, <1e200 * 1e200, 0, 0> } row { y, x + y }",
            "is not finite",
        ),
        (
            "degree 1 row { 0, x } row { y, x + y } trim { <0, 0>, <1, 0> }",
            "at least three corners",
        ),
        (
            "degree 1 row { 0, x } row { y, x + y } trim { curve { <0, 0>, <1, 0>, <1, 1> } }",
            "does not end where it begins",
        ),
        (
            "degree 1 row { 0, x } row { y, x + y } trim { curve { <0, 0>, <1, 2, 3, 4> } }",
            "has 2 components here",
        ),
        (
            "degree 1 row { 0, x } row { y, x + y } hole { <-1, -1>, <2, -1>, <2, 2>, <-1, 2> }",
            "leave nothing of it",
        ),
    ] {
        let text = format!("sphere {{ 0, 1 }} nurbs {{ {text} }}");
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        assert!(
            messages.iter().any(|m| m.contains(expected)),
            "{text}: {messages:?}"
        );
    }
}

/// A face of the unit cube.
const SQUARE: &str = "#declare Square = nurbs { degree 1 row { 0, x } row { y, x + y } }";
/// All of them, by one that is turned about the diagonal.
const FACES: &str = "Square object { Square translate z }
    object { Square matrix <0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0> } object { Square matrix <0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0, 0> }
    union { object { Square matrix <0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0> } object { Square matrix <0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1, 0> } }";

#[test]
fn surfaces_that_close_a_volume_are_solids() {
    for modifiers in ["", "pigment { rgb 1 } scale 1", "interior { ior 1.5 }"] {
        let found = shape(&format!("{SQUARE} brep {{ {FACES} {modifiers} }}"));
        let Shape::NurbsBrep(solid) = &found else {
            panic!("no solid");
        };
        assert_eq!((solid.face_count(), solid.elements()), (6, 6));
        let inside = found.as_solid().expect("a solid");
        assert!(inside.contains(DVec3::splat(0.5)) && !inside.contains(DVec3::splat(1.01)));
    }
    let tree = object(&format!(
        "{SQUARE} difference {{ brep {{ {FACES} }} sphere {{ 1, 0.5 }} }}"
    ));
    assert_eq!(operation(&tree).0, CsgOp::Difference);
    let said = debug(&format!(
        "{SQUARE} #declare Cube = brep {{ {FACES} }} #declare N = 0;
         #declare P = trace(Cube, <0.3, 0.4, -5>, z, N);
         #debug concat(str(inside(Cube, <0.5, 0.5, 0.5>), 0, 0), str(inside(Cube, <1.5, 0.5, 0.5>), 0, 0), \" \", vstr(3, P, \",\", 0, 2), \" \", str(N.z, 0, 2))"
    ));
    assert_eq!(said, "10 0.30,0.40,0.00 -1.00");
    // Scenes may use the word as a name.
    let (read, _) = scene("#declare brep = sphere { 0, 1 } object { brep }");
    assert_eq!(read.objects.0.len(), 1);
}

#[test]
fn a_brep_that_is_not_closed_is_surfaces_and_says_where() {
    for (text, expected, count) in [
        (
            "Square object { Square translate z }",
            "face 0 (counted from 0) has a border at <",
            2,
        ),
        ("Square", "brep is not closed: face 0", 1),
        (&format!("{FACES} Square"), "but 3 faces have it", 7),
        (
            &FACES.replacen("Square translate z", "Square translate 1.001 * z", 1),
            "brep is not closed",
            6,
        ),
    ] {
        let (read, messages) = scene(&format!("{SQUARE} brep {{ {text} pigment {{ rgb 1 }} }}"));
        assert_eq!(messages.len(), 1, "{messages:?}");
        assert!(messages[0].contains(expected), "{messages:?}");
        let (op, faces) = operation(&read.objects.0[0]);
        assert_eq!((op, faces.len()), (CsgOp::Union, count));
    }
    // The place is that of the face.
    let parsed = parse_with(
        &mut MemoryHost::new(),
        "#declare A = nurbs { degree 1 row { 0, x } row { y, x + y } }\nbrep {\n  A\n}",
    );
    let span = parsed.diagnostics[0].span;
    assert_eq!((span.line, span.column), (3, 3));
}

#[test]
fn mistakes_in_breps_are_explained() {
    for (text, expected) in [
        ("", "expected `nurbs`, or the name of such a surface"),
        (
            "pigment { rgb 1 }",
            "expected `nurbs`, or the name of such a surface",
        ),
        (
            "sphere { 0, 1 }",
            "a face of a `brep` is a `nurbs`, found sphere",
        ),
        (
            "difference { Square box { 0, 1 } }",
            "a face of a `brep` is a `nurbs`, found difference",
        ),
        ("light_source { 0, 1 }", "found a light"),
        ("nurbs { row { 0 } row { 0 } }", "columns of control points"),
        (
            "nurbs { degree 1 row { 0, <1e200 * 1e200, 0, 0> } row { y, x + y } }",
            "is not finite",
        ),
        (
            "object { Square pigment { rgb 1 } }",
            "the texture of a face is left out",
        ),
        ("Square translate x bumpy", "bumpy"),
    ] {
        let text = format!("{SQUARE} sphere {{ 0, 1 }} brep {{ {text} }}");
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        assert!(
            messages.iter().any(|m| m.contains(expected)),
            "{text}: {messages:?}"
        );
    }
}

/// A tetrahedron.
const CAGE: &str =
    "points { 0, x, y, z } face { 0, 2, 1 } face { 0, 1, 3 } face { 1, 2, 3 } face { 0, 3, 2 }";

#[test]
fn the_items_of_subdivision_surfaces_are_read() {
    let data = |text: &str| {
        let Shape::Subdivision(surface) = shape(&format!("subdivision {{ {text} }}")) else {
            panic!("no subdivision surface");
        };
        surface.data().clone()
    };
    let plain = data(CAGE);
    assert_eq!(plain.scheme, SubdivisionScheme::CatmullClark);
    assert_eq!(plain.sizes, [3; 4]);
    assert_eq!(plain.indices, [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]);
    for text in [
        format!("catmull_clark {CAGE}"),
        "points { 0 x } points { y z }, face { 0 2 1 }, face { 0 1, 3 } face { 1, 2, 3, } face { 0, 3, 2 }"
            .to_owned(),
        // The words are names as elsewhere, and directives work.
        format!("#declare face = 3; #declare points = 2; {CAGE} #declare uv = 1;"),
        format!("{CAGE} rotate 0 pigment {{ rgb 1 }}"),
    ] {
        assert_eq!(data(&text), plain, "{text}");
    }
    let sharp = data(&format!(
        "loop {CAGE} crease {{ 0, 1, 2 }} crease {{ sharpness 1.5, 2, 3 }} corner {{ sharpness 2 3 }} corner {{ 0 }}"
    ));
    assert_eq!(sharp.scheme, SubdivisionScheme::Loop);
    let forever = f64::INFINITY;
    assert_eq!(
        sharp.creases,
        [([0, 1], forever), ([1, 2], forever), ([2, 3], 1.5)]
    );
    assert_eq!(sharp.corners, [(3, 2.0), (0, forever)]);
    let textured =
        data("points { 0, x, x + y, y } face { 0, 1, 2, 3 uv { <0, 0>, <1, 0>, <1, 2>, <0, 2> } }");
    assert_eq!(textured.uvs.len(), 4);
    assert_eq!(textured.uvs[2], DVec2::new(1.0, 2.0));
    // Scenes may use the word as a name.
    let (read, _) = scene("#declare subdivision = sphere { 0, 1 } object { subdivision }");
    assert_eq!(read.objects.0.len(), 1);
}

#[test]
fn mistakes_in_subdivision_surfaces_are_explained() {
    for (text, expected) in [
        ("", "`points`, `face`, `crease`"),
        ("points { 0, x, y }", "`points`, `face`, `crease`"),
        (
            "points { 0, x, y } face { 0, 1, 3 }",
            "there is no point 3: 3 points came before",
        ),
        (
            "points { 0, x, y } face { 0, 1, 1.5 }",
            "there is no point 1.5",
        ),
        (
            "points { 0, x, y } face { 0, 1, -1 }",
            "there is no point -1",
        ),
        (
            "face { 0, 1, 2 } points { 0, x, y }",
            "there is no point 0: 0 points came before",
        ),
        (
            "points { 0, x, y } face { 0, 1 }",
            "from 3 to 10000, found 2",
        ),
        (
            "points { 0, x, y } face { 0, 1, 1 }",
            "face 0 has vertex 1 twice",
        ),
        (
            "loop points { 0, x, y, x + y } face { 0, 1, 3, 2 }",
            "3 for Loop's scheme, found 4",
        ),
        (
            "points { 0, x, y, z, -z } face { 0, 1, 2 } face { 0, 1, 3 } face { 1, 0, 4 }",
            "3 faces meet at the edge between the vertices 0 and 1",
        ),
        (
            "points { 0, x, y, z } face { 0, 1, 2 } face { 0, 1, 3 }",
            "turn different sides to the front",
        ),
        (
            "points { 0, x, y } face { 0, 1, 2 } crease { sharpness -1 0, 1 }",
            "a sharpness is 0",
        ),
        (
            "points { 0, x, y, z } face { 0, 1, 2 } crease { 0, 3 }",
            "is not an edge of a face",
        ),
        (
            "points { 0, x, y } face { 0, 1, 2 uv { 0, u } }",
            "this face has 3 corners, but 2 `uv`",
        ),
        (
            "points { 0, x, y, z } face { 0, 1, 2 uv { 0, u, v } } face { 0, 2, 3 }",
            "either all faces have `uv` or none",
        ),
        (
            "points { 0, x, <0, 1e200 * 1e200, 0> } face { 0, 1, 2 }",
            "is not finite",
        ),
        ("points { 0, x, 2 * x } face { 0, 1, 2 }", "lie on a line"),
    ] {
        let text = format!("sphere {{ 0, 1 }} subdivision {{ {text} }}");
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        assert!(
            messages.iter().any(|m| m.contains(expected)),
            "{text}: {messages:?}"
        );
    }
}

#[test]
fn terrains_are_read_with_their_items_in_any_order() {
    let plain = shape("terrain { }");
    let spelled =
        "terrain { gain 2, offset 1 octaves 8 lacunarity 2.1 h 0.9 ridged noise_generator 2 }";
    assert_eq!(plain.bounds(), shape(spelled).bounds());
    let Shape::Terrain(cut) = shape("terrain { hetero extent <3, 4>, <1, 2> octaves 4 }") else {
        panic!("no terrain");
    };
    let bounds = cut.bounds();
    assert_eq!(
        (bounds.min.x, bounds.max.x, bounds.min.z, bounds.max.z),
        (1.0, 3.0, 2.0, 4.0)
    );
    // The offset is that of the kind unless it is given.
    let Shape::Terrain(offset) =
        shape("terrain { offset 0.7 extent <3, 4>, <1, 2> octaves 4 hetero }")
    else {
        panic!("no terrain");
    };
    assert_eq!(offset.height(1.5, 2.5), cut.height(1.5, 2.5));
    shape("terrain { fbm detail <0, 2, -5>, 0.1 octaves 20 pigment { rgb 1 } scale 3 }");
    // The words are names elsewhere.
    let text = "#declare h = 3; #declare terrain = sphere { 0, h } object { terrain } #declare menger = 1; #declare extent = h;";
    assert_eq!(scene(text).0.objects.0.len(), 1);
}

#[test]
fn fractals_of_extensions_are_read() {
    let Shape::Menger(sponge) = shape("menger { <1, 1, 1>, -1, 20 pigment { rgb 1 } }") else {
        panic!("no sponge");
    };
    assert_eq!(sponge.bounds().min, DVec3::NEG_ONE);
    let Shape::Mandelbulb(bulb) = shape("mandelbulb { 8 precision 50 max_iteration 3 }") else {
        panic!("no mandelbulb");
    };
    let Shape::Mandelbulb(julia) = shape("mandelbulb { 2, julia <2, 0, 0> }") else {
        panic!("no mandelbulb");
    };
    let (bulb, julia) = (bulb.bounds().max.x, julia.bounds().max.x);
    assert!(
        bulb > 1.0 && bulb < 1.2 && (julia - 3.0).abs() < 1e-6,
        "{bulb} {julia}"
    );
}

/// POV-Ray 3.7.0.10 renders the picture of `sqr`, but for a few pixels that its steps miss.
#[test]
fn hypercomplex_cubes_are_squares_as_in_povray() {
    let julia = "julia_fractal { <-0.083, 0, -0.83, -0.025> hypercomplex";
    let text = |function: &str| format!("{julia} {function} }}");
    let shown = |function: &str| {
        let (scene, messages) = scene(&text(function));
        (format!("{:?}", scene.objects.0[0].kind), messages)
    };
    let [cube, square, power] = ["cube", "sqr", "pwr(3, 0)"].map(shown);
    assert_eq!(cube.0, square.0);
    assert_ne!(power.0, square.0);
    assert!(cube.1[0].contains("`pwr(3, 0)`"), "{cube:?}");
}

#[test]
fn mistakes_in_fractals_are_explained() {
    for (text, expected) in [
        ("terrain { lacunarity 1 }", "from 1.1 to 16, found 1"),
        ("terrain { octaves 0 }", "from 1 to 64, found 0"),
        (
            "terrain { noise_generator 4 }",
            "there is no noise generator 4",
        ),
        (
            "terrain { extent 1, 2 }",
            "two components, x and z, found 1",
        ),
        (
            "terrain { extent <1, 1>, <1, 2> }",
            "its extent has no area",
        ),
        ("terrain { detail <0, 1, 0>, 0 }", "must be greater than 0"),
        ("terrain { h -400 octaves 30 }", "its heights are too large"),
        ("terrain { bumpy }", "bumpy"),
        ("menger { 0, 1, 21 }", "from 0 to 20, found 21"),
        ("menger { 0, 1, 2.5 }", "a whole number"),
        ("menger { 0, <1, 0, 1>, 2 }", "its box is flat"),
        ("mandelbulb { 1 }", "from 2 to 16, found 1"),
        (
            "mandelbulb { 8 max_iteration 0 }",
            "from 1 to 1000, found 0",
        ),
        (
            "mandelbulb { 8 julia <1e200 * 1e200, 0, 0> }",
            "not a finite number",
        ),
    ] {
        let text = format!("sphere {{ 0, 1 }} {text}");
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        assert!(
            messages.iter().any(|m| m.contains(expected)),
            "{text}: {messages:?}"
        );
    }
}

#[test]
fn mistakes_are_shown_with_their_place() {
    let cases = [
        (
            "cylinder { x, x, 1 }",
            "both ends of the cylinder are at <1, 0, 0>",
            1,
        ),
        (
            "cone { x, 1, x, 2 }",
            "both ends of the cone are at <1, 0, 0>",
            1,
        ),
        ("plane { 0, 1 }", "the normal of the plane is zero", 9),
        (
            "cubic { <1, 2, 3> }",
            "a polynomial of order 3 has 20 coefficients, found 3",
            17,
        ),
        (
            "poly { 36, <1> }",
            "the order of a polynomial is a whole number from 2 to 35, found 36",
            8,
        ),
        (
            "polynomial { 4, xyz(2, 2, 1): 1 }",
            "the powers add up to 5, but the order is 4",
            17,
        ),
        (
            "polygon { 2, 0, x }",
            "a polygon has at least 3 corners, found 2",
            1,
        ),
        ("sphere { 0 }", "expected a number or vector, found `}`", 12),
        (
            "union { 1 }",
            "expected an item of the object, or `}`, found the number 1",
            9,
        ),
        ("object { 1 }", "expected an object, found the number 1", 10),
        (
            "object { Ball }",
            "expected an object, found the undeclared name `Ball`",
            10,
        ),
        (
            "sphere { 0, 1 clipped_by { } }",
            "expected an object, found `}`",
            28,
        ),
        (
            "sphere { 0, 1 clipped_by { 3 } }",
            "expected an object, found the number 3",
            28,
        ),
        (
            "mesh { triangle { 0, x, y 5 } }",
            "expected an item of the triangle, or `}`, found the number 5",
            27,
        ),
        (
            "mesh { triangle { 0, x * 1e300, y } }",
            "a corner of the triangle is too far away for a mesh",
            33,
        ),
        (
            "mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 3> } }",
            "there is no entry 3 in vertex_vectors, which has 3",
            57,
        ),
        (
            "mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, -1, 2> } }",
            "there is no entry -1 in vertex_vectors, which has 3",
            57,
        ),
        (
            "mesh2 { vertex_vectors { 4, 0, x, y } face_indices { 1, <0, 1, 2> } }",
            "the list should have 4 entries, found 3",
            26,
        ),
        (
            "mesh2 { vertex_vectors { 3, 0, x, y } normal_vectors { 1, z } face_indices { 1, <0, 1, 2> } }",
            "there are 1 normal_vectors for 3 vertex_vectors",
            1,
        ),
        (
            "mesh2 { vertex_vectors { 3, 0, x, y } uv_vectors { 1, 0 } face_indices { 1, <0, 1, 2> } uv_indices { 2, 0, 0 } }",
            "there are 2 uv_indices for 1 face_indices",
            1,
        ),
        (
            "mesh2 { vertex_vectors { 3, 0, x, y } texture_list { 1, texture { } } face_indices { 1, <0, 1, 2>, 1 } }",
            "there is no entry 1 in texture_list, which has 1",
            100,
        ),
    ];
    for (text, message, column) in cases {
        let found = errors(&format!("\n{text}\n"));
        assert_eq!(found.len(), 1, "{found:?}");
        let first = format!("error: {message}\n --> test.pov:2:{column}\n");
        assert!(
            found[0].starts_with(&first),
            "{text}\nexpected {first}\nfound {}",
            found[0]
        );
    }
}

#[test]
fn parsing_goes_on_behind_a_wrong_object() {
    let found = errors("cylinder { 0, 0, 1 pigment { rgb 1 } }\nsphere { 0, 1 }\nplane { 0, 1 }\n");
    assert_eq!(found.len(), 2, "{found:?}");
}

#[test]
fn items_act_in_the_order_they_stand() {
    // Whether the clipping plane rotates with the sphere depends on the order.
    let before = object("sphere { 0, 1 clipped_by { plane { y, 0 } } rotate z * 90 }");
    let after = object("sphere { 0, 1 rotate z * 90 clipped_by { plane { y, 0 } } }");
    let clip = |o: &Object| operation(o).1[1].transform.as_deref().copied();
    assert!(clip(&before).is_none());
    let turned_back = clip(&after).expect("moved against the object");
    let image = turned_back.vector_to_world(DVec3::Y);
    assert!((image - DVec3::X).length() < 1e-12, "{image}");
    assert!(before.transform.is_some() && after.transform.is_some());
}

#[test]
fn parts_take_the_material_of_the_whole_if_they_have_none() {
    let text = "union { sphere { 0, 1 } sphere { x, 1 pigment { rgb x } } pigment { rgb y } }";
    let whole = object(text);
    let parts = operation(&whole).1;
    assert!(whole.material.is_some() && parts[0].material.is_none() && parts[1].material.is_some());
    // Without a texture of its own, an object gets the default texture of the place where it enters the scene.
    let text = "#declare S = sphere { 0, 1 } #default { pigment { rgb x } } object { S }";
    let red = object(text).material.unwrap().texture.clone().unwrap();
    let Texture::Plain(red) = &*red.0 else {
        panic!("one pigment");
    };
    let color = red.pigment.color_at(&TexturePoint::in_space(DVec3::ZERO));
    assert_eq!(color.rgb, Color::new(1.0, 0.0, 0.0));
}

#[test]
fn objects_know_name_and_place() {
    let (scene, _) = scene("#declare Wheel = torus { 2, 1 }\n  object { Wheel }\nsphere { 0, 1 }");
    let [wheel, ball] = scene.objects.0.as_slice() else {
        panic!("two objects");
    };
    assert_eq!(wheel.name.as_deref(), Some("Wheel"));
    assert_eq!((wheel.span.line, wheel.span.column), (2, 3));
    assert_eq!((ball.name.as_deref(), ball.span.line), (None, 3));
}

#[test]
fn switches_can_be_turned_off() {
    let seen = object("sphere { 0, 1 no_shadow no_image off no_reflection on }").visibility;
    assert_eq!(
        (seen.shadow, seen.camera, seen.secondary),
        (false, true, false)
    );
    let seen = object("sphere { 0, 1 no_shadow no_image no_shadow off }").visibility;
    assert_eq!(
        (seen.shadow, seen.camera, seen.secondary),
        (true, false, true)
    );
}

#[test]
fn bounds_are_only_hints() {
    shape("sphere { 0, 1 bounded_by { box { -0.1, 0.1 } } }");
    let clipped =
        object("sphere { 0, 1 bounded_by { box { -1, 1 } } scale 2 clipped_by { bounded_by } }");
    let (op, parts) = operation(&clipped);
    assert_eq!((op, parts.len()), (CsgOp::Clip, 2));
    let (_, messages) = scene("sphere { 0, 1 clipped_by { bounded_by } }");
    assert!(
        messages[0].contains("there is no `bounded_by`"),
        "{messages:?}"
    );
}

/// An object with enough parts for its uses to be shared.
const LARGE: &str = "#declare Large = union { #for (I, 0, 19) sphere { I * x, 0.4 } #end }\n";

#[test]
fn large_objects_are_shared() {
    let text = format!("{LARGE} #for (I, 1, 1000) object {{ Large translate I * y }} #end");
    let (scene, _) = scene(&text);
    assert_eq!((scene.objects.0.len(), scene.groups.len()), (1000, 1));
    assert_eq!(operation(&scene.groups[0].objects.0[0]).1.len(), 20);
    assert_eq!(scene.groups[0].name.as_deref(), Some("Large"));
    let kinds = scene
        .objects
        .0
        .iter()
        .map(|o| matches!(o.kind, ObjectKind::Instance(id) if id.0 == 0));
    assert!(kinds.into_iter().all(|instance| instance));
}

#[test]
fn popular_objects_are_shared() {
    let small = "#declare Small = union { sphere { 0, 1 } sphere { x, 1 } }";
    let (scene, _) = scene(&format!(
        "{small} #for (I, 1, 100) object {{ Small translate I * y }} #end"
    ));
    assert_eq!(scene.groups.len(), 1);
    let copies = scene
        .objects
        .0
        .iter()
        .filter(|o| matches!(o.kind, ObjectKind::Csg { .. }));
    assert_eq!(copies.count(), 16);
}

#[test]
fn equal_isosurfaces_are_one_shape() {
    let (scene, _) = scene(
        "#macro Ball(R, G) isosurface { function { x*x + y*y + z*z - R } contained_by { box { -2, 2 } } max_gradient G } #end \
         Ball(1, 4) Ball(2, 4) object { Ball(1, 4) translate x } Ball(1, 5)",
    );
    let shapes: Vec<&Arc<Isosurface>> = scene
        .objects
        .0
        .iter()
        .map(|object| match &object.kind {
            ObjectKind::Shape(Shape::Isosurface(shape)) => shape,
            other => panic!("{other:?}"),
        })
        .collect();
    assert!(Arc::ptr_eq(shapes[0], shapes[2]));
    assert!(!Arc::ptr_eq(shapes[0], shapes[1]) && !Arc::ptr_eq(shapes[0], shapes[3]));
}

#[test]
fn a_lone_shape_is_no_group() {
    let (scene, _) =
        scene("#declare S = sphere { 0, 1 } #for (I, 1, 100) object { S translate I * y } #end");
    assert_eq!((scene.objects.0.len(), scene.groups.len()), (100, 0));
}

#[test]
fn what_is_used_once_is_put_in_its_place() {
    let (scene, _) = scene(&format!(
        "{LARGE} object {{ Large scale 2 pigment {{ rgb x }} }}"
    ));
    assert_eq!(scene.groups.len(), 0);
    assert_eq!(operation(&scene.objects.0[0]).1.len(), 20);
    assert!(scene.objects.0[0].transform.is_some());
}

#[test]
fn a_scene_built_up_step_by_step_is_no_tower() {
    let text = "#declare All = sphere { 0, 1 } #for (I, 1, 20000) #declare All = union { object { All } sphere { I * x, 1 } } #end object { All }";
    let (scene, _) = scene(text);
    assert_eq!((scene.objects.0.len(), scene.groups.len()), (1, 0));
    let mut spheres = 0;
    let mut waiting = vec![&scene.objects.0[0]];
    while let Some(object) = waiting.pop() {
        match &object.kind {
            ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
            ObjectKind::Shape(_) => spheres += 1,
            ObjectKind::Instance(_) => panic!("an instance is left"),
            ObjectKind::Light(_) => panic!("a light is no part"),
        }
    }
    assert_eq!(spheres, 20001);
}

#[test]
fn each_material_from_outside_has_its_group() {
    let uses = "object { Large pigment { rgb x } } object { Large pigment { rgb x } translate y } object { Large pigment { rgb y } } object { Large pigment { rgb y } translate -y }";
    let (scene, _) = scene(&format!("{LARGE} {uses}"));
    assert_eq!(scene.groups.len(), 2);
    let materials: Vec<_> = scene
        .groups
        .iter()
        .map(|g| g.objects.0[0].material.clone())
        .collect();
    assert_ne!(materials[0], materials[1]);
    // A material that no part inherits has no effect.
    let textured = LARGE.replace("0.4 }", "0.4 pigment { rgb z } }");
    let (scene, _) = self::scene(&format!("{textured} {uses}"));
    assert_eq!(scene.groups.len(), 1);
}

#[test]
fn groups_hold_groups() {
    let larger = LARGE.replace("19", "4999");
    let text = format!(
        "{larger} #declare Two = union {{ object {{ Large }} object {{ Large translate y }} #for (I, 0, 9) sphere {{ I * z, 1 }} #end }} object {{ Two }} object {{ Two translate z }} object {{ Large translate -y }}"
    );
    let (scene, _) = scene(&text);
    assert_eq!(scene.groups.len(), 2);
    let inner = |group: usize| {
        let children = operation(&scene.groups[group].objects.0[0]).1;
        children
            .iter()
            .filter(|c| matches!(c.kind, ObjectKind::Instance(_)))
            .count()
    };
    let mut instances = [inner(0), inner(1)];
    instances.sort_unstable();
    assert_eq!(instances, [0, 2]);
}

/// Halves within halves: eleven levels of instances would cost rays ten times as much as one group of balls.
#[test]
fn small_objects_are_copied_into_the_groups_that_use_them() {
    let tower = |balls: u32| {
        let text = format!(
            "#declare O = union {{ #for (I, 1, {balls}) sphere {{ I * x, 0.1 }} #end }}
             #for (I, 0, 2) #declare O = union {{ object {{ O }} object {{ O translate y * pow(2, I) }} }} #end
             object {{ O }} object {{ O translate z }} #declare M = mesh {{ #for (I, 1, 99) triangle {{ 0, x, I * y }} #end }}
             #declare U = union {{ object {{ M }} object {{ M translate x }} sphere {{ 0, 1 }} #for (I, 1, 9) sphere {{ I * y, 1 }} #end }}
             object {{ U }} object {{ U translate z }}"
        );
        let (scene, _) = scene(&text);
        let (mut spheres, mut instances) = (0, 0);
        for group in &scene.groups {
            let mut waiting: Vec<_> = group.objects.0.iter().collect();
            while let Some(object) = waiting.pop() {
                match &object.kind {
                    ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
                    ObjectKind::Shape(Shape::Sphere(_)) => spheres += 1,
                    ObjectKind::Shape(_) => {}
                    ObjectKind::Instance(_) => instances += 1,
                    ObjectKind::Light(_) => panic!("a light is no part"),
                }
            }
        }
        (scene.groups.len(), spheres, instances)
    };
    // Eight times twenty balls in one group; ten of the object that shares a mesh, in another; the mesh.
    assert_eq!(tower(20), (3, 8 * 20 + 10, 2));
    // Too many to be copied: the group has eight instances of another.
    assert_eq!(tower(5000), (4, 5000 + 10, 8 + 2));
}

#[test]
fn operations_get_the_parts_of_what_they_use() {
    let text = format!(
        "{LARGE} difference {{ box {{ -1, 30 }} object {{ Large }} object {{ Large translate y }} }}"
    );
    let (scene, _) = scene(&text);
    assert_eq!(scene.groups.len(), 0);
    let (op, parts) = operation(&scene.objects.0[0]);
    assert_eq!((op, parts.len()), (CsgOp::Difference, 3));
    assert_eq!(operation(&parts[1]).1.len(), 20);
    assert_eq!(operation(&parts[2]).1.len(), 20);
    assert!(parts[2].transform.is_some());
    // The same if a small object contains it.
    let text = format!(
        "{LARGE} #declare U = union {{ object {{ Large }} sphere {{ 0, 1 }} }} difference {{ box {{ -1, 30 }} object {{ U }} }}"
    );
    let (scene, _) = self::scene(&text);
    let holder = &operation(&scene.objects.0[0]).1[1];
    assert_eq!(operation(&operation(holder).1[0]).1.len(), 20);
}

#[test]
fn meshes_share_vertices_and_split_by_texture() {
    let Shape::TriangleMesh(mesh) =
        shape("mesh { triangle { 0, x, y } triangle { x, x + y, y } triangle { 0, x, z } }")
    else {
        panic!("a mesh");
    };
    assert_eq!((mesh.triangle_count(), mesh.positions().len()), (3, 5));
    let text = "mesh { triangle { 0, x, y } triangle { x, x + y, y texture { pigment { rgb x } } } triangle { 0, x, z } pigment { rgb y } }";
    let whole = object(text);
    let (op, parts) = operation(&whole);
    assert_eq!((op, parts.len()), (CsgOp::Union, 2));
    assert!(parts[0].material.is_none() && parts[1].material.is_some());
}

#[test]
fn a_mesh_without_uv_vectors_has_one_entry() {
    let coordinates = |lists: &str| {
        let faces = "face_indices { 1, <0, 1, 2> }";
        let text = format!("mesh2 {{ vertex_vectors {{ 3, 0, x, y }} {lists}");
        let text = text.replace("faces", faces) + " }";
        let Shape::TriangleMesh(mesh) = shape(&text) else {
            panic!("a mesh");
        };
        [0, 1, 2].map(|vertex| mesh.uv(vertex))
    };
    let zeros = coordinates("uv_vectors { 1, 0 } faces uv_indices { 1, 0 }");
    assert!(zeros.iter().all(Option::is_some));
    // As Wings 3D writes it.
    assert_eq!(
        coordinates("uv_vectors { 0} faces uv_indices { 1, <0,0,0>}"),
        zeros
    );
    assert_eq!(coordinates("faces uv_indices { 1, 0 }"), zeros);
    assert_eq!(coordinates("uv_vectors { 0 } faces"), [None; 3]);
    let refused = "mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 2> } uv_indices { 1, <0, 1, 0> } }";
    assert!(errors(refused)[0].contains("there is no entry 1 in uv_vectors"));
}

#[test]
fn closed_meshes_are_solids_however_they_are_wound() {
    let vertices = "vertex_vectors { 4, 0, x, y, z }";
    for faces in [
        "<0, 2, 1>, <0, 1, 3>, <1, 2, 3>, <2, 0, 3>",
        "<0, 1, 2>, <0, 1, 3>, <1, 2, 3>, <2, 0, 3>",
    ] {
        let text = format!("mesh2 {{ {vertices} face_indices {{ 4, {faces} }} inside_vector y }}");
        assert!(matches!(shape(&text), Shape::Brep(_)), "{text}");
        let asked = debug(&format!(
            "#declare M = {text} #debug str(inside(M, <0.1, 0.1, 0.1>), 0, 0) #debug str(inside(M, 1), 0, 0)"
        ));
        assert_eq!(asked, "10");
    }
    let (_, messages) = scene(&format!(
        "mesh2 {{ {vertices} face_indices {{ 2, <0, 1, 2>, <0, 1, 3> }} inside_vector y }}"
    ));
    assert!(messages[0].contains("has no inside"), "{messages:?}");
}

#[test]
fn questions_see_instances_and_meshes() {
    let text = "#declare N = y; #declare All = union { object { Large } object { Large translate 10 * y } } \
                #debug concat(vstr(3, max_extent(All), \",\", 0, 3), \" \", vstr(3, trace(All, <3, 50, 0>, -y, N), \",\", 0, 3), \" \", vstr(3, N, \",\", 0, 3))";
    assert_eq!(
        debug(&format!("{LARGE} {text}")),
        "19.400,10.400,0.400 3.000,10.400,0.000 0.000,1.000,0.000"
    );
}

#[test]
fn descriptions_of_objects_are_small() {
    // A scene with a million spheres has a million of these.
    assert!(size_of::<Object>() <= 176, "{}", size_of::<Object>());
}

#[test]
fn a_declared_object_may_stand_in_the_braces_of_any() {
    let (scene, messages) = scene(
        "#declare S = sphere { 0, 1 } #declare M = mesh { triangle { 0, x, y } }
         sphere { S translate x } union { S pigment { rgb 1 } } mesh { M } box { M scale 2 }
         union { object { S } sphere { x, 1 } }",
    );
    assert_eq!(scene.objects.0.len(), 5, "{messages:?}");
    assert!(messages.is_empty(), "{messages:?}");
}

#[test]
fn a_point_that_misses_the_first_by_rounding_closes_the_curve() {
    let ring = |miss: &str| {
        format!(
            "<{miss}, 0>, <1, 0>, <1, 1>, <0, 0>,
             <{miss} + 0.1, 0.05>, <0.9, 0.05>, <0.9, 0.8>, <0.1, 0.05>"
        )
    };
    for (miss, warnings) in [("0", 0), ("9e-11", 0), ("-1e-15", 0), ("1.1e-10", 1)] {
        let points = ring(miss);
        for (kind, text) in [
            ("polygon", format!("polygon {{ 8, {points} }}")),
            ("prism", format!("prism {{ 0, 1, 8, {points} }}")),
        ] {
            let (scene, messages) = scene(&text);
            assert_eq!(messages.len(), warnings, "{kind} {miss}: {messages:?}");
            let ObjectKind::Shape(shape) = &scene.objects.0[0].kind else {
                panic!("{kind} is a shape");
            };
            match shape {
                Shape::Polygon(polygon) => {
                    assert_eq!(polygon.rings().count(), 2 - warnings, "{kind} {miss}");
                }
                Shape::Prism(prism) => assert_eq!(prism.outline().gaps(), warnings, "{miss}"),
                other => panic!("{other:?}"),
            }
        }
    }
}
