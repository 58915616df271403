use crate::input::ahead::assert_parts_make_no_difference;
use crate::scene::{Loaded, SceneFormat, load_bytes, load_path};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use strahl_geometry::{Shape, TriangleMesh};
use strahl_math::DVec3;
use strahl_scene::{Background, Object, ObjectKind, Scene};
use strahl_shade::{Color, LightKind, Sides};

const VIEW: &str = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 90\nhither 1\nresolution 64 32\n";

fn load(text: &str) -> Loaded {
    load_bytes(text.as_bytes(), "test.nff", SceneFormat::Nff, None)
}

fn scene(text: &str) -> Scene {
    let loaded = load(&format!("{VIEW}{text}"));
    assert_eq!(messages(&loaded), [""; 0]);
    loaded.scene.expect("no errors")
}

fn messages(loaded: &Loaded) -> Vec<String> {
    loaded.diagnostics.iter().map(ToString::to_string).collect()
}

fn shape(object: &Object) -> &Shape {
    match &object.kind {
        ObjectKind::Shape(shape) => shape,
        other => panic!("{other:?}"),
    }
}

fn mesh(object: &Object) -> &TriangleMesh {
    match shape(object) {
        Shape::TriangleMesh(mesh) => mesh,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_view_is_camera_and_size() {
    let scene = scene("b 0.1 0.2 0.3\nf 1 1 1 1 0 0 0 0\ns 0 0 0 1");
    let camera = scene.camera.expect("a view");
    assert_eq!(
        (camera.eye, camera.direction),
        (DVec3::Z * 5.0, DVec3::NEG_Z)
    );
    assert!((camera.up - DVec3::Y).length() < 1e-15 && camera.span.line == 1);
    assert_eq!(scene.settings.size, Some((64, 32)));
    assert_eq!(
        scene.background,
        Some(Background::Solid(Color::new(0.1, 0.2, 0.3)))
    );
}

#[test]
fn lights_without_a_colour_share_the_strength_and_colours_are_taken_as_given() {
    let scene =
        scene("l 1 2 3\nl 4 5 6 1 0.5 0 # orange\nl 0 0 0\nl 9 9 9\nf 1 1 1 1 0 0 0 0\ns 0 0 0 1");
    // √4 / 8
    assert_eq!(scene.ambient, Some(Color::gray(0.25)));
    assert_eq!(scene.lights.len(), 4);
    assert_eq!(
        scene.lights[0].light.kind,
        LightKind::Point {
            position: DVec3::new(1.0, 2.0, 3.0)
        }
    );
    assert_eq!(scene.lights[0].light.color, Color::gray(0.25));
    // The format lets the program choose the strength of a light without a colour, so a given colour is used as it is.
    assert_eq!(scene.lights[1].light.color, Color::new(1.0, 0.5, 0.0));
    assert_eq!(
        (scene.lights[1].span.line, scene.lights[1].name.as_deref()),
        (9, Some("light 2"))
    );
}

#[test]
fn a_fill_is_one_shared_material_per_side() {
    let scene = scene(
        "f 1 0.5 0 0.5 0.25 30 0 0\ns 0 0 0 1\ns 3 0 0 -1\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n\
         f 1 1 1 0 0.1 100 0.9 1.5\ns 1 1 1 2\np 4 0 0 0 1 0 0 1 1 0 0 1 0\nc 0 0 0 1 0 0 2 0.5\nc 0 0 0 1\n0 0 2 1",
    );
    let objects = &scene.objects.0;
    let material = |i: usize| objects[i].material.as_ref().expect("filled");
    let opaque = material(0);
    assert_eq!(opaque.name, "fill 1 (line 8)");
    assert_eq!(opaque.finish.diffuse, Color::new(0.5, 0.25, 0.0));
    assert_eq!(opaque.finish.ambient, opaque.finish.diffuse);
    assert_eq!(
        (opaque.finish.reflection, opaque.finish.shininess),
        (Color::gray(0.25), 30.0)
    );
    assert_eq!((opaque.eta, opaque.sides), (1.0, Sides::Two));
    assert_eq!(
        material(1).sides,
        Sides::Front,
        "a negative radius shows the inside only"
    );
    assert!(std::sync::Arc::ptr_eq(material(1), material(2)));
    let glass = material(3);
    assert_eq!(
        (glass.eta, glass.finish.transmission),
        (1.5, Color::gray(0.9))
    );
    assert_eq!(
        material(4).sides,
        Sides::Two,
        "transmitters are seen from both sides"
    );
    assert!((3..=6).all(|i| std::sync::Arc::ptr_eq(glass, material(i))));
    let names: Vec<_> = objects
        .iter()
        .map(|o| o.name.as_deref().expect("named"))
        .collect();
    assert_eq!(
        names,
        [
            "sphere 1",
            "sphere 2",
            "polygon 1",
            "sphere 3",
            "polygon 2",
            "cone 1",
            "cylinder 2"
        ]
    );
    assert_eq!(objects[2].span.line, 11);
    assert!(matches!(shape(&objects[5]), Shape::Cone(c) if !c.is_capped()));
    assert!(matches!(shape(&objects[6]), Shape::Cylinder(c) if !c.is_capped()));
}

#[test]
fn triangles_of_a_fill_are_one_mesh_that_knows_the_lines() {
    let scene = scene(
        "f 1 1 1 1 0 0 0 0\np 3\n0 0 0\n1 0 0\n0 1 0\ns 0 0 0 1\np 3\n1 0 0\n1 1 0\n0 1 0\n\
         pp 3\n0 0 0  0 0 1\n1 0 0  0 0 2\n0 1 0  1 0 1\n\
         pp 4\n0 0 0  0 0 1\n1 0 0  0 0 2\n1 1 0  0 0 1\n0 1 0  1 0 1\n",
    );
    let objects = &scene.objects.0;
    assert_eq!(objects.len(), 3);
    let flat = mesh(&objects[1]);
    assert_eq!((flat.triangle_count(), flat.positions().len()), (2, 4));
    assert_eq!((flat.face_line(0), flat.face_line(1)), (Some(9), Some(14)));
    assert_eq!(objects[1].name.as_deref(), Some("triangles of fill 1"));
    let smooth = mesh(&objects[2]);
    assert_eq!((smooth.triangle_count(), smooth.positions().len()), (3, 4));
    assert_eq!(
        (smooth.face_line(0), smooth.face_line(2)),
        (Some(18), Some(22))
    );
}

#[test]
fn errors_show_the_place_and_reading_goes_on() {
    let loaded = load(
        "v\nfrom 0 0 five\nat 0 0 0\nf 1 1 1 1 0 0 0 0\ns 0 0 0\nx 1 2\ny\np 2\n0 0 0\n1 1 1\ns 1 2 nan 4\n",
    );
    assert!(loaded.scene.is_none());
    let all = messages(&loaded);
    assert_eq!(
        all[0],
        "error: expected a number (the eye), found `five`\n --> test.nff:2:10\n  |\n2 | from 0 0 five\n  |          ^^^^\n  \
         = help: numbers are written like `-1`, `0.5` or `2.5e-3`"
    );
    let firsts: Vec<_> = all.iter().map(|m| m.lines().next().unwrap_or("")).collect();
    assert_eq!(
        firsts[1..],
        [
            "error: expected a number (the sphere's radius), found `x`",
            "error: expected a statement, found `y`",
            "error: the number of corners must be at least 3, found `2`",
            "error: expected a number (the sphere's centre), found `nan`, which is not a finite number",
        ]
    );
}

#[test]
fn a_statement_that_comes_too_early_is_read() {
    let loaded = load(&format!(
        "{VIEW}f 1 1 1 1 0 0 0 0\np 3\n0 0 0\n1 0 0\ns 0 0 0 0\n"
    ));
    let problems = loaded.diagnostics.iter();
    let firsts: Vec<_> = problems.map(|d| d.message.as_str()).collect();
    assert_eq!(firsts.len(), 2, "{firsts:?}");
    assert_eq!(firsts[0], "expected a number (a corner), found `s`");
    assert!(firsts[1].contains("radius"), "{firsts:?}");
}

#[test]
fn a_missing_number_is_asked_for_where_the_next_statement_stands() {
    let loaded = load(&format!("{VIEW}f 1 1 1 1 0 0 0 0\ns 0 0 0\ns 1 1 1 1\n"));
    assert_eq!(
        messages(&loaded),
        [
            "error: expected a number (the sphere's radius), found `s`\n  --> test.nff:10:1\n   |\n10 | s 1 1 1 1\n   | ^"
        ]
    );
}

#[test]
fn impossible_values_are_refused() {
    let error_of =
        |text: &str| messages(&load(&format!("{VIEW}f 1 1 1 1 0 0 0 0\n{text}")))[0].clone();
    assert!(
        error_of("s 0 0 0 0")
            .contains("error: radius of the sphere must be different from 0, found 0")
    );
    assert!(error_of("c 0 0 0 1 0 0 0 1").starts_with("error: "));
    assert!(error_of("f 1 1 -1 1 0 0 0 0").contains("must not be negative, found `-1`"));
    assert!(
        error_of("f 1 1 1 1 0 0 2 0")
            .contains("T, the transmitted part, must be at most 1, found `2`")
    );
    assert!(
        error_of("p 99999999999\n0 0 0")
            .contains("error: expected a number (a corner), found the end of the file")
    );
    assert!(error_of(VIEW).contains("there is a second `v` statement"));
    let angle = load(&VIEW.replace("90", "180"));
    assert!(
        messages(&angle)[0].contains(
            "expected an angle between 0 and 180 degrees, found `180`\n --> test.nff:5:7"
        )
    );
    let same = load(&VIEW.replace("from 0 0 5", "from 0 0 0"));
    assert!(messages(&same)[0].contains("the eye (`from`) is at the point looked at (`at`)"));
    let half = load("v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\n");
    assert!(messages(&half)[0].contains("expected `angle` in the view, found the end of the file"));
}

#[test]
fn what_is_merely_odd_is_a_warning() {
    let text = "p 3\n0 0 0\n1 1 1\n2 2 2\np 3\n0 0 0\n0 0 0\n0 0 0\np 4\n0 0 0\n1 0 0\n1 1 1\n0 1 0\n\
                pp 3\n0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 1\n";
    let loaded = load(&format!("{VIEW}{text}"));
    let scene = loaded.scene.as_ref().expect("warnings only");
    assert_eq!(
        scene
            .objects
            .0
            .iter()
            .map(|o| mesh(o).triangle_count())
            .collect::<Vec<_>>(),
        [2, 1]
    );
    let all = messages(&loaded);
    let firsts: Vec<_> = all.iter().map(|m| m.lines().next().unwrap_or("")).collect();
    assert_eq!(firsts.len(), 4, "{firsts:?}");
    assert!(firsts[0].contains("there is no `f` statement before this object"));
    assert_eq!(
        firsts[1],
        "warning: the polygon is left out: it has no area (2 times, this is the first)"
    );
    assert!(firsts[2].starts_with("warning: the polygon is cut into triangles: "));
    assert!(
        firsts[3].contains("a corner's normal has no length; the polygon's own is taken (2 times")
    );
    let bare = load("f 1 1 1 1 0 0 0 0\n");
    assert_eq!(
        messages(&bare),
        [
            "warning: `test.nff` has no `v` statement: the camera is placed automatically",
            "warning: `test.nff` has no objects"
        ]
    );
}

#[test]
fn many_errors_do_not_flood() {
    let loaded = load(&"garbage\n".repeat(1000));
    assert_eq!(loaded.diagnostics.len(), 21);
    assert_eq!(loaded.diagnostics[20].message, "and 980 more errors");
    let binary = load("v\0\u{1}\u{2}");
    assert!(
        messages(&binary)[0]
            .starts_with("error: `test.nff` is not an NFF scene: it is a binary file")
    );
}

/// The folder with the standard scenes, if this checkout has one beside it.
fn standard_scenes() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/spd");
    folder.is_dir().then_some(folder)
}

#[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
#[test]
fn the_standard_scenes_have_the_published_numbers_of_primitives_and_lights() {
    let Some(folder) = standard_scenes() else {
        eprintln!("skipped: the standard scenes (shared/data/spd) are not here");
        return;
    };
    let published = [
        ("balls", 7382, 3),
        ("gears", 9345, 5),
        ("mount", 8196, 1),
        ("teapot", 9264, 2),
        ("tetra", 4096, 1),
    ];
    for (name, primitives, lights) in published {
        let loaded = load_path(&folder.join(format!("{name}.nff.gz")), None);
        assert_eq!(messages(&loaded), [""; 0], "{name}");
        let scene = loaded.scene.expect("no errors");
        let count = |o: &Object| match shape(o) {
            Shape::TriangleMesh(mesh) => mesh.triangle_count(),
            _ => 1,
        };
        assert_eq!(
            scene.objects.0.iter().map(count).sum::<u32>(),
            primitives,
            "{name}"
        );
        assert_eq!(scene.lights.len(), lights, "{name}");
        assert_eq!(scene.settings.size, Some((512, 512)));
    }
}

/// Valid and invalid statements, with shared corners.
const STATEMENTS: [&str; 27] = [
    "f 1 .5 0 .5 .5 3 0 0\n",
    "f 0 1 1 1 0 0 .5 1.5\n",
    "p 3\n0 0 0\n1 0 0\n0 1 0\n",
    "p 3\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n",
    "p 3 0 0 0 -0 1 0 0 0 1\n",
    "p 3\r0 0 1\r1 0 0 0 1 0\r",
    "p 3 # a comment\n1 1 1 # p 3\n\n0 1 0\n  1 0 0\n",
    "p 3 0 0 0 0 0 0 1 1 1\n",
    "p 4 0 0 0 1 0 0 1 1 0 0 1 0\n",
    "p 4 0 0 0 1 0 0 1 1 1 0 1 0\n",
    "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n",
    "pp 4 0 0 0 0 0 1\n1 0 0 0 0 0\n1 1 0 0 0 1\n0 1 0 0 1 1\n",
    "s 0.123456789012345678901 0 1e-3 2\n",
    "s 1 1 1 -0.5\n",
    "c 0 0 0 1 0 0 2 0.5\n",
    "c 0 0 0 -1 0 0 2 -1\n",
    "l 1 2 3\n",
    "l 3 2 1 .5 .5 .5\n",
    "b .1 .2 .3\n",
    "\n# p 3 0 0 0 1 0 0 0 1 0\n",
    VIEW,
    "p 3\n0 0 0\n1 0 0\n0 1 x\n",
    "p 3\n0 0 0\n1 0 0\n",
    "s 0 0 0 0\n",
    "p 3 0 0 0 1e300 0 0 0 1 0\n",
    "f 1 1 1 -1 0 0 0 0\n",
    "q 1 2\n",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn it_makes_no_difference_how_the_text_is_cut(
        choices in prop::collection::vec(0..STATEMENTS.len(), 0..80),
        wrong in any::<bool>(),
    ) {
        let right = STATEMENTS.len() - 7;
        let statements = choices.into_iter().map(|i| STATEMENTS[if wrong { i } else { i % right }]);
        let text: String = [STATEMENTS[0]].into_iter().chain(statements).collect();
        assert_parts_make_no_difference(&text, super::read_with);
    }
}

#[test]
fn threads_that_wait_for_parts_read_parts() {
    // As many texts at once as there are threads: if a thread only waited, none would finish.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let text = format!("{VIEW}{}", STATEMENTS[..18].concat().repeat(50));
    pool.expect("threads").install(|| {
        rayon::join(
            || assert_parts_make_no_difference(&text, super::read_with),
            || assert_parts_make_no_difference(&text, super::read_with),
        )
    });
}

#[test]
fn large_files_are_mapped_and_read_in_parts() {
    use std::fmt::Write;
    // A landscape in which each corner belongs to several triangles of several parts.
    let mut text = format!("{VIEW}f 1 1 1 1 0 0 0 0\n");
    let side = 360;
    for (x, y) in (0..side * side).map(|i| (i % side, i / side)) {
        let height = |x: i32, y: i32| f64::from(x * x % 7 + y * x % 5) / 8.0;
        for corners in [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]] {
            text.push_str("p 3\n");
            for (x, y) in corners.map(|(i, j)| (x + i, y + j)) {
                let height = height(x, y);
                writeln!(text, "{x}.000000000000 {y}.00000000000 {height:.9}").expect("a string");
            }
        }
    }
    assert!(text.len() > 20 << 20);
    let file = tempfile::Builder::new()
        .suffix(".nff")
        .tempfile()
        .expect("a file");
    std::fs::write(file.path(), &text).expect("written");
    let loaded = load_path(file.path(), None);
    assert_eq!(messages(&loaded), [""; 0]);
    let scene = loaded.scene.expect("no errors");
    let mesh = mesh(&scene.objects.0[0]);
    let (triangles, vertices) = (mesh.triangle_count(), mesh.positions().len());
    assert_eq!(triangles as i32, 2 * side * side);
    assert_eq!(vertices as i32, (side + 1) * (side + 1));
    // The line of the last triangle is known, and that of an error at the end.
    let lines = text.lines().count() as u32;
    assert_eq!(mesh.face_line(triangles - 1), Some(lines - 3));
    text.push_str("p 3 0 0\n");
    let wrong = messages(&load(&text));
    let place = format!("--> test.nff:{}:8", lines + 1);
    assert!(wrong[0].contains(&place), "{wrong:?}");
}
