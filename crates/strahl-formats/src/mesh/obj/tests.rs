use crate::input::ahead::assert_parts_make_no_difference;
use crate::scene::{Loaded, SceneFormat, load_bytes, load_path};
use proptest::prelude::*;
use std::fs;
use std::sync::Arc;
use strahl_geometry::{Primitive, Shape, TriangleMesh};
use strahl_math::{DVec2, DVec3, Interval, Ray};
use strahl_scene::{Object, ObjectKind, Scene};
use strahl_shade::{Color, Material};

fn load(text: &str) -> Loaded {
    load_bytes(text.as_bytes(), "part.obj", SceneFormat::Obj, None)
}

fn messages(loaded: &Loaded) -> Vec<String> {
    loaded.diagnostics.iter().map(ToString::to_string).collect()
}

fn scene(text: &str) -> Scene {
    let loaded = load(text);
    assert_eq!(messages(&loaded), [""; 0]);
    loaded.scene.expect("no errors")
}

fn mesh(object: &Object) -> Arc<TriangleMesh> {
    match &object.kind {
        ObjectKind::Shape(Shape::TriangleMesh(mesh)) => mesh.clone(),
        other => panic!("{other:?}"),
    }
}

fn names(scene: &Scene) -> Vec<&str> {
    scene
        .objects
        .0
        .iter()
        .map(|o| o.name.as_deref().unwrap_or(""))
        .collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn all_forms_of_corners_are_read() {
    let text = format!(
        "{SQUARE}vt 0.25\nvt 0.5 0.75\nvt 1 1 0\nvn 0 0 2\nf 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//1 3//1\n\
         f 1/1/1 2/2/1 3/3/1\nf -4 -3 -2\nf -4/-3/-1 -3/-2/-1 \\\n -2/-1/-1\n"
    );
    let scene = scene(&text);
    assert_eq!(names(&scene), ["part.obj"]);
    let mesh = mesh(&scene.objects.0[0]);
    assert_eq!(mesh.triangle_count(), 6);
    // Corners with equal numbers are one vertex, however they are written.
    assert_eq!(mesh.positions().len(), 12);
    assert_eq!(mesh.indices()[4], mesh.indices()[0]);
    assert_eq!(mesh.indices()[5], mesh.indices()[3]);
    assert_eq!(mesh.face_line(5), Some(14));
}

/// The surface where a ray along -z meets the mesh.
fn look_down(mesh: &TriangleMesh, x: f64, y: f64) -> strahl_geometry::SurfacePoint {
    let ray = Ray::new(DVec3::new(x, y, 9.0), DVec3::NEG_Z);
    let hit = mesh
        .closest_hit(&ray, Interval::FORWARD, None, &mut Default::default())
        .expect("a hit");
    mesh.surface_at(&ray, &hit)
}

#[test]
fn texture_coordinates_count_from_the_top() {
    let scene = scene(&format!("{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n"));
    let uv = look_down(&mesh(&scene.objects.0[0]), 0.75, 0.25).uv;
    assert!((uv - DVec2::new(0.75, 0.75)).length() < 1e-12, "{uv}");
}

#[test]
fn polygons_are_cut_concave_ones_too() {
    let scene = scene("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv 0 0 1\nf 1 2 3 4\ng cube\nf 1 2 4\n");
    let dart = mesh(&scene.objects.0[0]);
    let area: f64 = (0..2)
        .map(|i| dart.corners(i))
        .map(|[a, b, c]| (b - a).cross(c - a).z)
        .sum();
    assert_eq!((dart.triangle_count(), area), (2, 8.0));
    assert_eq!(names(&scene), ["part.obj", "cube"]);
}

#[test]
fn names_and_materials_tell_meshes_apart() {
    let text = format!(
        "{SQUARE}o a\nf 1 2 3\nusemtl red\nf 1 2 3\ng b\nf 1 2 3\no c # not a comment? it is\nf 1 2 3\no a\ng\nf 1 3 4\n"
    );
    let loaded = load(&text);
    let scene = loaded.scene.as_ref().expect("warnings only");
    assert_eq!(
        names(scene),
        ["a", "a", "a/b", "c # not a comment? it is/b"]
    );
    assert_eq!(mesh(&scene.objects.0[1]).triangle_count(), 2);
    assert_eq!(scene.objects.0[1].span.line, 8);
    assert_eq!(
        messages(&loaded)[0],
        "warning: `a` gets the default material: there is no material `red`"
    );
}

/// A roof: two squares that meet in an edge, at a right angle.
const ROOF: &str = "v -1 0 0\nv -1 1 0\nv 0 1 1\nv 0 0 1\nv 1 0 0\nv 1 1 0\n";

#[test]
fn smoothing_groups_give_smooth_normals_and_off_gives_none() {
    let faces = "f 1 4 3 2\nf 4 5 6 3\n";
    let n_at_ridge = |text: &str| look_down(&mesh(&scene(text).objects.0[0]), -1e-9, 0.5).n_shade;
    let flat = n_at_ridge(&format!("{ROOF}{faces}"));
    assert!(
        (flat - DVec3::new(-0.5f64.sqrt(), 0.0, 0.5f64.sqrt())).length() < 1e-6,
        "{flat}"
    );
    let smooth = n_at_ridge(&format!("{ROOF}s 1\n{faces}"));
    assert!((smooth - DVec3::Z).length() < 1e-6, "{smooth}");
    let apart = n_at_ridge(&format!("{ROOF}s 1\nf 1 4 3 2\ns 2\nf 4 5 6 3\n"));
    assert!((apart - flat).length() < 1e-6, "{apart}");
    let off = n_at_ridge(&format!("{ROOF}s 3\ns off\n{faces}"));
    assert_eq!(off, flat);
    // A smooth face in the mesh leaves the flat ones flat.
    let mixed = n_at_ridge(&format!(
        "{ROOF}{faces}s 1\nv 9 9 9\nv 9 8 9\nv 8 8 9\nf 7 8 9\n"
    ));
    assert!((mixed - flat).length() < 1e-12, "{mixed}");
    // Normals are averaged across the border of materials.
    let two = load(&format!("{ROOF}s 1\nf 1 4 3 2\nusemtl x\nf 4 5 6 3\n"));
    let n = look_down(
        &mesh(&two.scene.expect("warnings only").objects.0[0]),
        -1e-9,
        0.5,
    )
    .n_shade;
    assert!((n - DVec3::Z).length() < 1e-6, "{n}");
}

#[test]
fn names_may_be_in_quotation_marks() {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, bytes: &[u8]| {
        fs::write(folder.path().join(name), bytes).expect("written");
    };
    put("one two.mtl", b"newmtl m\nmap_Kd \"my step.pgm\"\n");
    put("b.mtl", b"newmtl n\nmap_Kd -clamp on my step.pgm\n");
    put(
        "my step.pgm",
        &[b"P5 2 1 255\n".as_slice(), &[0, 255]].concat(),
    );
    let said = |lines: &str, faces: &str| {
        put("a.obj", format!("{lines}\n{SQUARE}{faces}").as_bytes());
        let loaded = load_path(&folder.path().join("a.obj"), None);
        let scene = loaded.scene.expect("warnings only");
        let textured = |o: &Object| o.material.as_ref().is_some_and(|m| m.pbr.is_some());
        let count = scene.objects.0.iter().filter(|o| textured(o)).count();
        let said = loaded.diagnostics.into_iter().map(|d| d.message);
        (said.collect::<Vec<_>>(), count)
    };
    let both = "usemtl m\nf 1 2 3\nusemtl n\nf 1 3 4\n";
    for lines in [
        "mtllib \"one two.mtl\" b.mtl",
        "mtllib one two.mtl\nmtllib \"b.mtl\"",
        "mtllib \"b.mtl\"  \"one two.mtl\"",
    ] {
        assert_eq!(said(lines, both), (vec![], 2), "{lines}");
    }
    // The reason is that of the whole name, unless one of its words is a file.
    let (messages, _) = said("mtllib my things/../one two.mtl", "f 1 2 3\n");
    assert_eq!(
        messages,
        [
            "the material library `my things/../one two.mtl` is not read: only files in the scene's folder or below are read, by a relative path without `..`"
        ]
    );
    let (messages, count) = said("mtllib c.mtl b.mtl", "usemtl n\nf 1 2 3\n");
    assert_eq!(
        (messages, count),
        (
            vec!["the material library `c.mtl` is not read: there is no such file".to_owned()],
            1
        )
    );
}

#[test]
fn without_anything_to_show_the_error_has_the_reason() {
    let error = |text: &str| {
        let loaded = load(text);
        let errors = loaded.diagnostics.iter().filter(|d| d.is_error());
        errors
            .map(|d| (d.message.clone(), d.span.line))
            .collect::<Vec<_>>()
    };
    let start = "`part.obj` has no faces or surfaces that can be shown: the";
    for (text, expected, line) in [
        (
            format!("{NET}{}end\n", SURF.replace("parm u 0 0 0 1 1 1\n", "")),
            "surface is left out: `parm u` is missing",
            12,
        ),
        (
            format!("{NET}{SURF}"),
            "curve or surface is left out: its `end` is missing",
            12,
        ),
        (
            format!("{SQUARE}f 1 1 2\n"),
            "face is left out: it has no area",
            5,
        ),
    ] {
        assert_eq!(error(&text), [(format!("{start} {expected}"), line)]);
    }
    assert_eq!(
        error("v 1 2 3\n"),
        [("`part.obj` has no faces".to_owned(), 0)]
    );
    // Where something is shown it stays a warning.
    assert_eq!(error(&format!("{SQUARE}f 1 1 2\nf 1 2 3\n")), []);
}

#[test]
fn errors_show_the_place_and_reading_goes_on() {
    let text =
        format!("{SQUARE}v 1 2\nf 1 2 9\nf 0 1 2\nf 1/2/3/4 2 3\nf a b c\nf 1 -9 2\nf 1/7 2 3\n");
    let all = messages(&load(&text));
    assert_eq!(
        all[1],
        "error: vertex 9 does not exist: there are 4 so far\n --> part.obj:6:7\n  |\n6 | f 1 2 9\n  |       ^"
    );
    let firsts: Vec<_> = all.iter().map(|m| m.lines().next().unwrap_or("")).collect();
    assert_eq!(
        firsts,
        [
            "error: expected a number (z), found the end of the line",
            "error: vertex 9 does not exist: there are 4 so far",
            "error: vertex 0 does not exist: OBJ counts from 1",
            "error: expected a corner such as `1`, `1/2`, `1//3` or `1/2/3`, found `1/2/3/4`",
            "error: expected the number of a vertex, found `a`",
            "error: vertex -9 does not exist: there are 4 so far",
            "error: texture coordinate 7 does not exist: there are 0 so far",
        ]
    );
}

#[test]
fn odd_faces_and_smoothing_groups_are_left_out() {
    let loaded = load(&format!(
        "{ROOF}s 1\ns\ns -1\ns 4294967296\ns loud\nf\nf 1 2\nfo 1 4 3 2\nf 4 5 6 3# the other half\n"
    ));
    assert_eq!(
        loaded
            .diagnostics
            .iter()
            .map(|d| d.message.as_str())
            .collect::<Vec<_>>(),
        [
            "a smoothing group is ignored: it is neither `off` nor a number from 0 to 4294967295 (4 times, this is the first)",
            "the face is left out: it has less than three corners (2 times, this is the first)",
        ]
    );
    let scene = loaded.scene.expect("warnings only");
    let mesh = mesh(&scene.objects.0[0]);
    assert_eq!(mesh.triangle_count(), 4);
    // The group before counts on.
    let n = look_down(&mesh, -1e-9, 0.5).n_shade;
    assert!((n - DVec3::Z).length() < 1e-6, "{n}");
}

#[test]
fn colours_of_vertices_are_remarked_upon() {
    let text = "v 0 0 0 1\nv 1 0 0 1 0.5 0\nv 1 1 0 0 1 0\nf 1 2 3\n";
    let loaded = load(text);
    assert_eq!(
        messages(&loaded),
        [
            "warning: the colours of the vertices are ignored\n --> part.obj:2:1\n  |\n2 | v 1 0 0 1 0.5 0\n  | ^\n  = help: materials do not vary from vertex to vertex; a texture does"
        ]
    );
    assert!(loaded.scene.is_some());
    assert_parts_make_no_difference(&text.repeat(20), super::read_with);
}

#[test]
fn comments_may_touch_numbers() {
    let touching = scene(
        "v 0 0 0#a\nv 1 0 0 1# a\nv 0 1 0#\nvt 0 0#\nvn 0 0 1#\ns 1#\nf 1/1/1 2/1/1 3/1/1#c\n",
    );
    assert_eq!(mesh(&touching.objects.0[0]).triangle_count(), 1);
    assert_eq!(material("Ns 20#\nKs 1 1 1#").finish.shininess, 20.0);
}

#[test]
fn only_faces_need_finite_positions() {
    let odd = "v nan 0 0\nvn -nan(ind) 0 1\nvn 1 1.#QNAN 0\nvt 0 inf\nvt 1e200 0\n";
    let loaded = load(&format!("{odd}{SQUARE}f 2/1/1 3/2/2 4/1/1\n"));
    assert_eq!(
        loaded
            .diagnostics
            .iter()
            .map(|d| d.message.as_str())
            .collect::<Vec<_>>(),
        [
            "the position of a vertex is not a finite number: no face may use it",
            "a normal that is not finite counts as none (2 times, this is the first)",
            "texture coordinates that are not finite count as none (2 times, this is the first)",
        ]
    );
    let scene = loaded.scene.expect("warnings only");
    let point = look_down(&mesh(&scene.objects.0[0]), 0.75, 0.25);
    assert_eq!((point.n_shade, point.uv), (DVec3::Z, DVec2::ZERO));
    let used = load(&format!("{odd}{SQUARE}f 2 3 4 -5\n"));
    assert_eq!(
        messages(&used)[0],
        "error: the position of vertex 1 is not a finite number\n  --> part.obj:10:9\n   |\n10 | f 2 3 4 -5\n   |         ^^"
    );
}

#[test]
fn what_has_no_surface_is_ignored_and_counted() {
    let text = format!(
        "{SQUARE}l 1 2\nl 2 3\np 1\ncurv 0 1 1 2 \\\n 3 4\nparm u 0 1\nend\nwhat 1 2\nf 1 1 2\nf 1 2 3\nscrv 0 1 1\ncon 1 0 1 1 2 0 1 1\n"
    );
    let loaded = load(&text);
    let firsts: Vec<_> = loaded
        .diagnostics
        .iter()
        .map(|d| d.message.as_str())
        .collect();
    assert_eq!(
        firsts,
        [
            "lines (`l`) are ignored: they have no surface (2 times, this is the first)",
            "points (`p`) are ignored: they have no surface",
            "free-form curves in space (`curv`) are ignored: they have no surface",
            "an unknown statement is ignored",
            "the face is left out: it has no area",
            "special curves and points (`scrv`, `sp`) are ignored: surfaces are not made of triangles that they could guide",
            "connections of surfaces (`con`) are ignored: borders are as close as the file has them",
        ]
    );
    assert!(
        messages(&load("hello world\n"))
            .iter()
            .any(|m| m.contains("`part.obj` has no faces"))
    );
    assert!(messages(&load("\0\0"))[0].contains("is not an OBJ file: it is a binary file"));
}

/// Materials of a scene in a folder of its own.
fn with_library(mtl: &str, obj: &str) -> Loaded {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("my colours.mtl"), mtl).expect("written");
    let text = format!("mtllib my colours.mtl\n{SQUARE}{obj}");
    fs::write(folder.path().join("a.obj"), text).expect("written");
    let gray = [b"P5 2 1 255\n".as_slice(), &[0, 255]].concat();
    fs::create_dir(folder.path().join("maps")).expect("made");
    fs::write(folder.path().join("maps/step.pgm"), gray).expect("written");
    load_path(&folder.path().join("a.obj"), None)
}

fn material(mtl: &str) -> Material {
    let loaded = with_library(&format!("newmtl m\n{mtl}"), "usemtl m\nf 1 2 3\n");
    assert_eq!(messages(&loaded), [""; 0]);
    let scene = loaded.scene.expect("no errors");
    Material::clone(scene.objects.0[0].material.as_ref().expect("found"))
}

#[test]
fn coefficients_follow_the_illumination_model() {
    let matte = material("Kd 0.5 0.25 0\nKs 0.3\nNs 20\nillum 1\nKe 0 0 1");
    assert_eq!(matte.name, "m");
    assert_eq!(matte.finish.diffuse, Color::new(0.5, 0.25, 0.0));
    assert_eq!(
        (matte.finish.ambient, matte.finish.specular),
        (matte.finish.diffuse, Color::BLACK)
    );
    assert_eq!(matte.finish.emission, Color::new(0.0, 0.0, 1.0));
    let shiny = material("Ka 0.1 0.1 0.1\nKs 0.3\nNs 20");
    assert_eq!(
        (shiny.finish.specular, shiny.finish.shininess),
        (Color::gray(0.3), 20.0)
    );
    assert_eq!(
        (shiny.finish.ambient, shiny.finish.reflection),
        (Color::gray(0.1), Color::BLACK)
    );
    let mirror = material("Ks 0.3 0.3 0.3\nillum 3");
    assert_eq!(
        (mirror.finish.reflection, mirror.fresnel),
        (Color::gray(0.3), false)
    );
    let lacquer = material("Ks 0.3 0.3 0.3\nillum 5\nNi 1.4");
    assert_eq!(
        (lacquer.finish.reflection, lacquer.fresnel, lacquer.eta),
        (Color::gray(0.3), true, 1.4)
    );
    let glass = material("Kd 1 1 1\nillum 7\nNi 1.45\nTf 0.9 1 0.9");
    assert_eq!(
        (glass.finish.transmission, glass.eta, glass.thin),
        (Color::new(0.9, 1.0, 0.9), 1.45, false)
    );
    assert_eq!(
        (glass.finish.reflection, glass.finish.diffuse),
        (Color::WHITE, Color::BLACK)
    );
    assert!(glass.fresnel);
    let pane = material("illum 4\nd 0.25");
    assert_eq!(
        (pane.finish.transmission, pane.thin),
        (Color::gray(0.75), true)
    );
    let veil = material("Kd 0.8 0.8 0.8\nTr 0.5");
    assert_eq!(
        (veil.finish.transmission, veil.finish.diffuse),
        (Color::gray(0.5), Color::gray(0.4))
    );
    assert_eq!((veil.eta, veil.fresnel), (1.0, false));
    let lamp = material("Kd 0.8 0.8 0.8\nillum 0");
    assert_eq!(
        (lamp.finish.emission, lamp.finish.diffuse),
        (Color::gray(0.8), Color::BLACK)
    );
}

#[test]
fn a_map_is_turned_scaled_and_moved() {
    let m = material(
        "Kd 1 1 1\nmap_Kd -clamp on -o 0.5 0 0 -s 2 3 1 -bm 0.5 maps\\step.pgm\nmap_d maps\\step.pgm\nNi 1.5\n",
    );
    let pbr = m.pbr.expect("textured");
    let texture = pbr.textures.base_color.expect("read");
    assert_eq!(texture.uv_map, [2.0, 0.0, 0.5, 0.0, 3.0, -2.0]);
    assert!(pbr.alpha_blend && m.eta == 1.0);
}

#[test]
fn what_libraries_lack_is_a_warning() {
    let loaded = with_library(
        "newmtl m\nmap_Kd none.png\nbump b.png\nmap_Ns n.png\nPr 0.5\nKa spectral x.rfl",
        "usemtl m\nf 1 2 3\n",
    );
    assert!(loaded.scene.is_some());
    let firsts: Vec<_> = loaded
        .diagnostics
        .iter()
        .map(|d| d.message.as_str())
        .collect();
    assert_eq!(
        firsts,
        [
            "the texture `none.png` is not read: there is no such file",
            "bump maps are ignored",
            "maps other than `map_Kd` and `map_d` are ignored",
            "an unknown property of a material is ignored",
            "colours as spectra or CIE XYZ are ignored",
        ]
    );
    let outside = load_bytes(
        format!("mtllib ../a.mtl\nmtllib /etc/a.mtl\nmtllib C:\\a.mtl\n{SQUARE}f 1 2 3\n")
            .into_bytes(),
        "a.obj",
        SceneFormat::Obj,
        Some(&std::env::temp_dir()),
    );
    assert!(outside.scene.is_some());
    assert!(outside.diagnostics[0].message.starts_with(
        "the material library `../a.mtl` is not read: only files in the scene's folder or below are read"
    ));
    assert!(
        outside.diagnostics[0]
            .message
            .ends_with("(3 times, this is the first)")
    );
}

#[test]
fn mistakes_in_libraries_are_warnings_that_are_placed_there() {
    let loaded = with_library(
        "Kd 1 1 1\nnewmtl m\nKd 1 x 1\nd 2\nNi\nKs -1",
        "usemtl m\nf 1 2 3\n",
    );
    let firsts: Vec<_> = loaded
        .diagnostics
        .iter()
        .map(|d| d.message.as_str())
        .collect();
    assert_eq!(
        firsts,
        [
            "what comes before the first `newmtl` is ignored",
            "expected a number (a part of a colour), found `x`: the statement is ignored (2 times, this is the first)",
            "d must be between 0 and 1, found `2`: it counts as 1",
            "a part of a colour must be at least 0, found `-1`: it counts as 0",
        ]
    );
    assert!(messages(&loaded)[1].contains("my colours.mtl:3:6\n"));
    assert!(loaded.scene.is_some());
}

#[test]
fn odd_values_of_materials_leave_something_sensible() {
    let odd = |mtl: &str| {
        let loaded = with_library(&format!("newmtl m\n{mtl}"), "usemtl m\nf 1 2 3\n");
        assert_eq!(messages(&loaded).len(), 1, "{mtl}: {:?}", messages(&loaded));
        let scene = loaded.scene.expect("warnings only");
        Material::clone(scene.objects.0[0].material.as_ref().expect("found"))
    };
    let plain = material("Kd 0.5");
    // Blender's hardness of 0.
    assert_eq!(odd("Ns -1.960784").finish.shininess, 0.0);
    for mtl in [
        "Ns nan",
        "Kd",
        "Kd 1 1 x",
        "Ks -1 0 0",
        "d 1.000001",
        "Tr -0.1",
        "illum 11",
        "illum -1",
        "map_Kd",
        "map_Kd -clamp on",
        "map_d",
        "Ni 0",
    ] {
        assert_eq!(odd(&format!("Kd 0.5\n{mtl}")), plain, "{mtl}");
    }
    assert_eq!(odd("illum 7\nNi 0").eta, 1.5);
    assert!(odd("map_Kd -foo 1 0.5 maps/step.pgm").pbr.is_some());
}

/// Valid and invalid statements.
const STATEMENTS: [&str; 29] = [
    SQUARE,
    "v 0 0 1\r\nv 1 0 1 0.5 0.5 1\r\n",
    "vt 0.5 0.5\nvn 0 0 1 \\\n\n",
    "f 1 2 3\n",
    "f 1 2 \\\n3 4\n",
    "f -1 -2 -3\n",
    "f 1//1 2//1 3//1\r",
    "f 1/1 2/1 3 # f 1 2 3 \\\n",
    "f 2 3 4\n",
    "f 1 1 2\n",
    "# f 1 2 3\\\n",
    "o thing\n",
    "g a b\n",
    "usemtl red\n",
    "s 1\n",
    "s off\n",
    "mtllib none.mtl\n",
    "l 1 2\np 1\n",
    "what 1 2\nvp 1\n",
    "\n \t\n",
    "f 1/2/3 2/2/2 3/3/3\n",
    "f 1 2 99\n",
    "f 0 1 2\n",
    "f 1 2\n",
    "f 1 x 3\n",
    "v 1 2\n",
    "v 1 2 nan\n",
    "f 1 2 3#\nfo 1 2 4\ns -1\n",
    "s loud\n",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn it_makes_no_difference_how_the_text_is_cut(
        choices in prop::collection::vec(0..STATEMENTS.len(), 0..80),
        wrong in any::<bool>(),
    ) {
        let right = STATEMENTS.len() - 9;
        let statements = choices.into_iter().map(|i| STATEMENTS[if wrong { i } else { i % right }]);
        let text: String = [SQUARE, STATEMENTS[2]].into_iter().chain(statements).collect();
        assert_parts_make_no_difference(&text, super::read_with);
    }
}

/// Three by three points over a square of side 2, the middle one raised.
const NET: &str =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 1\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n";
const SURF: &str = "cstype bspline\ndeg 2 2\nsurf 0 1 0 1 1 2 3 4 5 6 7 8 9\nparm u 0 0 0 1 1 1\nparm v 0 0 0 1 1 1\n";

/// The height at which a vertical line meets the objects.
fn height(scene: &Scene, x: f64, y: f64) -> Option<f64> {
    let scratch = &mut strahl_geometry::Scratch::default();
    let ray = Ray::new(DVec3::new(x, y, 9.0), -DVec3::Z);
    scene
        .objects
        .0
        .iter()
        .find_map(|object| match &object.kind {
            ObjectKind::Shape(shape) => {
                let hit = shape.closest_hit(&ray, Interval::FORWARD, None, scratch)?;
                Some(9.0 - hit.t)
            }
            _ => None,
        })
}

#[test]
fn free_form_surfaces_are_read() {
    let first = scene(&format!("{NET}o sail\n{SURF}end\n"));
    assert_eq!(names(&first), ["sail"]);
    assert!(matches!(
        first.objects.0[0].kind,
        ObjectKind::Shape(Shape::Nurbs(_))
    ));
    let top = height(&first, 1.0, 1.0).unwrap();
    assert!((top - 0.25).abs() < 1e-14, "{top}");
    // The same as a Bezier patch, and as a rational one whose weights are 1; numbers count back from the end, too.
    for (cstype, points) in [
        ("cstype bezier\ndeg 2", "1 2 3 4 5 6 7 8 9"),
        (
            "cstype rat bezier\ndeg 2 2",
            "-9/1/1 -8 -7 -6 -5//4 -4 -3 -2 -1",
        ),
        ("cstype rat bezier\ndeg 2.0", "1 2 3 \\\n4 5 6 7 8 9"),
    ] {
        let text = format!("{NET}{cstype}\nsurf 0 1 0 1 {points}\nparm u 0 1\nparm v 0 1\nend\n");
        let other = scene(&text);
        for (x, y) in [(1.0, 1.0), (0.3, 1.7), (2.5, 1.0)] {
            assert_eq!(height(&other, x, y), height(&first, x, y));
        }
    }
    // A weight pulls the surface; only rational surfaces have it.
    let heavy = NET.replace("1 1 1", "1 1 1 3");
    let plain = scene(&format!("{heavy}{SURF}end\n"));
    assert_eq!(height(&plain, 1.0, 1.0), Some(top));
    let pulled = scene(&format!(
        "{heavy}{}end\n",
        SURF.replace("bspline", "rat bspline")
    ));
    // 3/4 of the weighted height by 3/4 and the other quarter.
    let expected = 0.25 * 3.0 / (0.75 + 0.25 * 3.0);
    let found = height(&pulled, 1.0, 1.0).unwrap();
    assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    // A part of the surface.
    let half = scene(&format!(
        "{NET}{}end\n",
        SURF.replace("surf 0 1 0 1", "surf 0.5 1 0 1")
    ));
    assert!(height(&half, 0.9, 1.0).is_none() && height(&half, 1.1, 1.0).is_some());
}

#[test]
fn free_form_surfaces_are_trimmed() {
    let disc = "vp 0.9 0.5\nvp 0.9 0.9 0.70710678118\nvp 0.5 0.9\nvp 0.1 0.9 0.70710678118\nvp 0.1 0.5\nvp 0.1 0.1 0.70710678118\n\
                vp 0.5 0.1\nvp 0.9 0.1 0.70710678118\n\
                cstype rat bspline\ndeg 2\ncurv2 1 2 3 4 5 6 7 8 1\nparm u 0 0 0 1 1 2 2 3 3 4 4 4\nend\n";
    let square = "vp 0.4 0.4\nvp 0.6 0.4\nvp 0.6 0.6\nvp 0.4 0.6\ncstype bezier\ndeg 1\n\
                  curv2 -4 -3 -2 -1 -4\nparm u 0 1 2 3 4\nend\n";
    let text = |loops: &str| format!("{NET}{disc}{square}{SURF}{loops}\nend\n");
    let both = scene(&text("trim 0 2 1 2 4 1\nhole 0 4 2"));
    // The middle of the hole, the ring around it, the corner.
    let met = |scene: &Scene| {
        [(1.0, 1.0), (1.0, 1.5), (0.1, 0.1)].map(|(x, y)| height(scene, x, y).is_some())
    };
    assert_eq!(met(&both), [false, true, false]);
    assert_eq!(met(&scene(&text("trim 0 4 1"))), [true, true, false]);
    assert_eq!(met(&scene(&text("hole 0 4 1"))), [false, false, true]);
    // Half a disc is no loop.
    let messages = messages(&load(&text("trim 0 2 1")));
    let expected = "the surface is left out: the NURBS surface's trimming is not closed";
    assert!(
        messages.iter().any(|m| m.contains(expected)),
        "{messages:?}"
    );
}

#[test]
fn mistakes_in_free_form_surfaces_are_explained() {
    let with = |from: &str, to: &str| format!("{NET}{SURF}end\n").replace(from, to);
    for (text, expected) in [
        (
            with("bspline", "cardinal"),
            "the surface is left out: `cstype cardinal` is not supported",
        ),
        (with("cstype bspline\n", ""), "`cstype` is missing"),
        (with("cstype bspline", "cstype"), "a type of surfaces"),
        (with("parm u 0 0 0 1 1 1\n", ""), "`parm u` is missing"),
        (with("parm u", "parm w"), "`u` or `v`"),
        (
            with("parm u 0 0 0 1 1 1", "parm u 0 0 0 1 1 x"),
            "expected a number (a knot)",
        ),
        (
            with("parm u 0 0 0 1 1 1", "parm u 0 0 2 1 1 1"),
            "knot of the NURBS surface along u 3 must be",
        ),
        (
            with("deg 2 2", "deg 2.5"),
            "degree of the NURBS surface along u must be from 1 to 9",
        ),
        (
            with("deg 2 2", "deg 1e30"),
            "degree of the NURBS surface along u must be from 1 to 9",
        ),
        (
            with("8 9\n", "8\n"),
            "8 control points of the NURBS surface given, 9 expected",
        ),
        (with("8 9\n", "8 10\n"), "vertex 10 does not exist"),
        (
            with("surf 0 1 0 1", "surf 0 4 0 1"),
            "between its first and its last parameter, found 4",
        ),
        (
            with("end\n", "trim 0 1 3\nend\n"),
            "expected the number of a `curv2`, found `3`: there are 0 so far",
        ),
        (with("end\n", ""), "its `end` is missing"),
        (
            with("surf", "p"),
            "`parm` belongs between `curv2` or `surf` and `end`",
        ),
        (
            format!("{NET}trim 0 1 1\n"),
            "expected the number of a `curv2`",
        ),
        (
            format!("{NET}curv2 1 2\n"),
            "expected the number of a `vp`, found `1`: there are 0 so far",
        ),
        (
            format!(
                "vp 0 0\nvp 1 0\ncstype bmatrix\ndeg 1\ncurv2 1 2\nparm u 0 1\nend\n{NET}{SURF}trim 0 1 1\nend\n"
            ),
            "the curve `1` was left out",
        ),
    ] {
        let messages = messages(&load(&text));
        assert!(
            messages.iter().any(|m| m.contains(expected)),
            "{text}: {messages:?}"
        );
    }
    assert_parts_make_no_difference(
        &format!("{NET}{SURF}end\n{NET}{SURF}end\n"),
        super::read_with,
    );
}
