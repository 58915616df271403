//! Checks that every command of the lecture shows what its page says.

use super::factors::check;
use super::{stderr, strahl};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Output;
use strahl::formats::image::{TextureUse, read_texture};
use strahl::shade::image_texture::TextureImage;

const PAGE: &str = include_str!("../../../../docs/src/lecture.md");

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs a command of the page in its own folder, with additional arguments.
fn output(folder: &Path, command: &str, more: &[&str]) -> Output {
    assert!(
        PAGE.contains(&format!("    {command}\n")),
        "not on the page: {command}"
    );
    let scene = |word: &str| match word.strip_prefix("scenes/") {
        Some(rest) => repository().join("scenes").join(rest).display().to_string(),
        None => word.to_owned(),
    };
    let words: Vec<String> = command.split(' ').skip(1).map(scene).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let output = strahl(folder, &[&words[..], more].concat());
    assert!(output.status.success(), "{command}: {}", stderr(&output));
    output
}

fn run(command: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let output = output(folder.path(), command, &[]);
    let text = String::from_utf8(output.stdout).expect("text");
    // The places of line breaks depend on the lengths of paths.
    text.replace("\n    ", " ")
        .split(' ')
        .filter(|w| !w.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
}

fn json(command: &str, more: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let output = output(folder.path(), command, more);
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// The tree of an `explain` command, with its factors checked.
fn tree(command: &str) -> Value {
    let json = json(command, &["--format", "json"]);
    check(&json);
    json["samples"][0]["rays"].clone()
}

/// The picture of a `render` command.
struct Picture(TextureImage);

impl Picture {
    fn of(command: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        output(folder.path(), command, &["--quiet"]);
        let name = command.rsplit(' ').next().expect("a name");
        let read = read_texture(folder.path().join(name), TextureUse::Data);
        Self(read.expect("a picture"))
    }

    /// The codes of a pixel.
    fn at(&self, x: u32, y: u32) -> [u8; 3] {
        let [r, g, b, _] = self.0.fetch(x, y);
        [r, g, b].map(|code| (code * 255.0).round() as u8)
    }
}

/// The rows of the table of `compare`, by the names of the accelerators: steps, tests, sha256.
fn costs(command: &str) -> Vec<(String, f64, f64, String)> {
    let table = run(command);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| cells[i].parse().expect("a number");
        (
            cells[0].to_owned(),
            number(5),
            number(6),
            cells[10].to_owned(),
        )
    };
    let rows = table.lines().skip(1);
    rows.take_while(|line| !line.starts_with("steps"))
        .map(row)
        .collect()
}

#[test]
fn every_command_of_the_page_is_tried_here() {
    let here = include_str!("lecture.rs").replace(" \\\n         ", " ");
    let mut count = 0;
    for line in PAGE.lines() {
        let Some(command) = line.strip_prefix("    strahl ") else {
            continue;
        };
        count += 1;
        assert!(
            here.contains(&format!("\"strahl {command}\"")),
            "not tried: strahl {command}"
        );
    }
    assert!(count > 20, "{count} commands");
}

#[test]
fn lecture_01_has_every_kind_of_ray() {
    let command = "strahl explain scenes/lecture/01_principle.pov --size 320x180 --sampling center --pixel 205,100";
    let printed = run(command);
    for part in [
        "#0 primary ray",
        "reflection ray of #",
        "transparency ray of #",
        "shadow ray from",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    assert!(
        printed.find("adds to the sample") < printed.find("#0 primary ray"),
        "{printed}"
    );
    tree(command);
    let folder = tempfile::tempdir().expect("a folder");
    let dot = output(folder.path(), command, &["--format", "dot"]);
    assert!(dot.stdout.starts_with(b"digraph"));
}

#[test]
fn lecture_02_sends_rays_from_one_eye() {
    let left = tree(
        "strahl explain scenes/lecture/02_perspective.pov --size 320x180 --sampling center --pixel 40,120",
    );
    let right = tree(
        "strahl explain scenes/lecture/02_perspective.pov --size 320x180 --sampling center --pixel 280,120",
    );
    assert_eq!(left[0]["ray"]["origin"], right[0]["ray"]["origin"]);
    assert_ne!(left[0]["ray"]["direction"], right[0]["ray"]["direction"]);
    let depth = Picture::of(
        "strahl render scenes/lecture/02_perspective.pov --size 320x180 --shading depth -o depth.png",
    );
    // At the lower edge the floor is nearer than in the middle of the picture.
    let (near, far) = (depth.at(160, 175)[0], depth.at(160, 100)[0]);
    assert!(near < far, "{near} {far}");
}

#[test]
fn lecture_03_sends_parallel_rays() {
    let left = tree(
        "strahl explain scenes/lecture/03_orthographic.pov --size 320x180 --sampling center --pixel 40,120",
    );
    let right = tree(
        "strahl explain scenes/lecture/03_orthographic.pov --size 320x180 --sampling center --pixel 280,120",
    );
    assert_eq!(left[0]["ray"]["direction"], right[0]["ray"]["direction"]);
    assert_ne!(left[0]["ray"]["origin"], right[0]["ray"]["origin"]);
}

#[test]
fn lecture_04_prints_every_term_and_other_models() {
    let command = "strahl explain scenes/lecture/04_shading.pov --size 320x180 --sampling center --pixel 262,80";
    let printed = run(command);
    for part in [
        "ambient = ka · Ia",
        "diffuse · (n·l) · C · L",
        "specular · (h·n)^(1/roughness) · L",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    // All three rays count: each is more than a step of an 8-bit channel.
    let rays = tree(command);
    let light = &rays[0]["lights"][0];
    for term in [
        &rays[0]["hit"]["ka_Ia"],
        &light["diffuse"],
        &light["highlight"],
    ] {
        assert!(term[0].as_f64() > Some(0.02), "{term}");
    }
    let phong = run(
        "strahl explain scenes/lecture/04_shading.pov --size 320x180 --sampling center --pixel 262,80 --shading phong",
    );
    assert!(
        phong.contains("(r·v)^(1/roughness)") && !phong.contains("(h·n)"),
        "{phong}"
    );
    let lambert = Picture::of(
        "strahl render scenes/lecture/04_shading.pov --size 320x180 --shading lambert -o lambert.png",
    );
    // The highlight of the last ball is almost white, the ball is not.
    let [r, _, b] = lambert.at(262, 80);
    assert!(r > 2 * b, "{r} {b}");
}

#[test]
fn lecture_05_names_what_weakens_and_what_blocks() {
    let command = "strahl explain scenes/lecture/05_shadows.pov --size 320x180 --sampling center --pixel 225,123";
    assert!(run(command).contains("passes polygon ("));
    let rays = tree(command);
    let met = &rays[0]["lights"][0]["shadow_rays"][0]["met"][0];
    assert_eq!(met["blocks"], false, "{met}");
    assert!(
        met["filter"][0].as_f64() > Some(0.5) && met["filter"][1].as_f64() < Some(0.2),
        "{met}"
    );
    let blocked = run(
        "strahl explain scenes/lecture/05_shadows.pov --size 320x180 --sampling center --pixel 80,130",
    );
    assert!(blocked.contains("is blocked by sphere ("), "{blocked}");
}

#[test]
fn lecture_06_ends_after_one_image_or_goes_on() {
    let two = Picture::of(
        "strahl render scenes/lecture/06_reflection.pov --size 320x180 --max-depth 2 -o two.png",
    );
    let command = "strahl explain scenes/lecture/06_reflection.pov --size 320x180 --sampling center --pixel 80,60";
    let rays = tree(command);
    assert!(rays.as_array().map(Vec::len) >= Some(4), "{rays:#}");
    // The picture with --max-depth 2 is darker where reflections of reflections are.
    let whole = json(command, &["--format", "json"])["rgb8"][1].as_u64();
    assert!(u64::from(two.at(80, 60)[1]) < whole.expect("a number"));
    let cut = json(command, &["--format", "json", "--max-depth", "2"]);
    assert_eq!(
        cut["samples"][0]["rays"][1]["ended"][0]["reason"],
        "depth limit"
    );
}

#[test]
fn lecture_07_names_indices_and_angles() {
    let command = "strahl explain scenes/lecture/07_transparency.pov --size 320x180 --sampling center --pixel 182,95";
    let printed = run(command);
    assert!(
        printed.contains("n1 = 1, n2 = 1.5") && printed.contains("n1 = 1.5, n2 = 1"),
        "{printed}"
    );
    assert!(printed.contains("Fresnel's F = "), "{printed}");
    let mut surfaces = 0;
    for ray in tree(command).as_array().expect("rays") {
        let hit = &ray["hit"];
        let (Some(cos_1), Some(cos_2)) = (hit["cos_theta1"].as_f64(), hit["cos_theta2"].as_f64())
        else {
            continue;
        };
        let sine = |cos: f64| (1.0 - cos * cos).sqrt();
        let (n1, n2) = (
            hit["n1"].as_f64().expect("n1"),
            hit["n2"].as_f64().expect("n2"),
        );
        assert!((n1 * sine(cos_1) - n2 * sine(cos_2)).abs() < 1e-9, "{hit}");
        surfaces += 1;
    }
    assert!(surfaces >= 2);
}

#[test]
fn lecture_08_says_where_all_light_is_reflected() {
    let command = "strahl explain scenes/lecture/08_total_reflection.pov --size 320x180 --sampling center --pixel 20,60";
    let printed = run(command);
    assert!(
        printed.contains("total internal reflection: sin θ2 = n1/n2 · sin θ1 = 1.1"),
        "{printed}"
    );
    let rays = tree(command);
    assert_eq!(rays[0]["hit"]["total_reflection"], true);
    assert_eq!(rays[0]["ended"][0]["reason"], "total internal reflection");
}

#[test]
fn lecture_10_gives_each_face_one_colour() {
    let normals = Picture::of(
        "strahl render scenes/lecture/10_polygon.pov --size 320x180 --shading normals -o normals.png",
    );
    // The wall with the window is one polygon; below and beside the window it has the same colour.
    let wall = normals.at(50, 80);
    assert_eq!(wall, normals.at(75, 110));
    let icosahedron: std::collections::BTreeSet<[u8; 3]> = (140..180)
        .flat_map(|x| [80, 90, 100].map(|y| normals.at(x, y)))
        .collect();
    assert!((4..60).contains(&icosahedron.len()), "{icosahedron:?}");
}

#[test]
fn lecture_11_counts_nodes_and_tests() {
    let rows = costs(
        "strahl compare scenes/lecture/11_bounding_volumes.pov --size 160x90 --sampling center --with list --with spheres --with bvh",
    );
    let [
        (_, _, list, sha),
        (_, steps, spheres, sha_2),
        (_, _, boxes, sha_3),
    ] = &rows[..]
    else {
        panic!("{rows:?}");
    };
    assert!(sha == sha_2 && sha == sha_3);
    assert!(
        *steps > 0.5 && 5.0 * spheres < *list && 2.0 * boxes < *list,
        "{rows:?}"
    );
    let walk = run(
        "strahl trace-ray scenes/lecture/11_bounding_volumes.pov --size 320x180 --pixel 200,90 --accelerator spheres",
    );
    assert!(
        walk.contains("sphere around (") && walk.contains("test sphere"),
        "{walk}"
    );
}

#[test]
fn lecture_12_follows_a_ray_from_cell_to_cell() {
    let grid = run(
        "strahl trace-ray scenes/lecture/12_space_subdivision.pov --size 320x180 --pixel 200,90 --accelerator grid",
    );
    assert!(
        grid.matches("cell ").count() > 3 && grid.contains("exit +z"),
        "{grid}"
    );
    let octree = run(
        "strahl trace-ray scenes/lecture/12_space_subdivision.pov --size 320x180 --pixel 200,90 --accelerator octree:traversal=trial-plane",
    );
    assert!(
        octree.contains("leaf ") && octree.contains(", region "),
        "{octree}"
    );
    let rows = costs(
        "strahl compare scenes/lecture/12_space_subdivision.pov --size 160x90 --sampling center --with list --with grid --with octree",
    );
    let [
        (_, _, list, sha),
        (_, _, grid, sha_2),
        (_, _, octree, sha_3),
    ] = &rows[..]
    else {
        panic!("{rows:?}");
    };
    assert!(sha == sha_2 && sha == sha_3);
    assert!(4.0 * grid < *list && 4.0 * octree < *list, "{rows:?}");
}

#[test]
fn lecture_13_names_the_leaf() {
    let printed = run(
        "strahl explain scenes/lecture/13_csg.pov --size 320x180 --sampling center --pixel 163,35",
    );
    assert!(
        printed.contains("hits cylinder \"Drills\" (") && printed.contains("13_csg.pov:22:3"),
        "{printed}"
    );
}

#[test]
fn lecture_14_shows_what_acceleration_saves() {
    let rows = costs(
        "strahl compare scenes/lecture/14_many.pov --declare Side=20 --size 64x36 --sampling center --with list --with bvh",
    );
    let [(_, _, list, sha), (_, _, bvh, sha_2)] = &rows[..] else {
        panic!("{rows:?}");
    };
    assert!(sha == sha_2 && 500.0 * bvh < *list, "{rows:?}");
}
