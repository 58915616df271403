//! Rendering and picture files.

use crate::{SCENE, folder_with_scene, skipped, stats, stderr, strahl};
use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

#[test]
fn a_scene_becomes_a_picture_with_statistics() {
    let folder = folder_with_scene();
    let stats = stats(folder.path(), &["--sampling", "center"]);
    let picture = std::fs::read(folder.path().join("out.png")).expect("written");
    assert!(picture.starts_with(b"\x89PNG\r\n\x1a\n"));
    for key in [
        "primary",
        "primary_hit",
        "shadow",
        "shadow_hit",
        "reflection",
        "reflection_hit",
        "refraction",
    ] {
        assert!(
            stats["rays"][key].as_u64().is_some_and(|n| n > 0),
            "rays.{key}: {stats}"
        );
    }
    assert_eq!(stats["rays"]["primary"], 48 * 40);
    assert!(stats["rays"]["refraction_hit"].is_u64());
    for key in [
        "build_s",
        "bytes",
        "nodes",
        "references",
        "node_visits",
        "primitive_tests",
    ] {
        assert!(stats["accelerator"][key].is_number(), "accelerator.{key}");
    }
    let bytes = |key: &str| stats["batches"][key].as_u64().expect("a number");
    let [points, rays, lists] = ["point_bytes", "ray_bytes", "list_bytes"].map(bytes);
    assert_eq!(bytes("bytes"), points + rays + lists);
    // Glass and two thousand pixels, and still less than a thousandth of what the limit of rays allows.
    assert!(points > 0 && lists > 0 && rays > 0 && rays < bytes("most_ray_bytes") / 1000);
    for key in ["load", "compile", "trace", "write", "total"] {
        assert!(
            stats["time_s"][key].as_f64().is_some_and(|t| t >= 0.0),
            "time_s.{key}"
        );
    }
    assert_eq!(stats["accelerator"]["name"], "bvh");
    assert!(stats["threads"].as_u64().is_some_and(|n| n >= 1) && stats["simd"].is_string());
    assert_eq!(
        (&stats["image"]["width"], &stats["image"]["height"]),
        (&48.into(), &40.into())
    );
    assert_eq!(stats["image"]["sha256"].as_str().map(str::len), Some(64));
}

#[test]
fn the_film_is_the_same_for_accelerators_threads_and_tile_orders() {
    let folder = folder_with_scene();
    let hash = |args: &[&str]| stats(folder.path(), args)["image"]["sha256"].clone();
    let reference = hash(&[]);
    assert_eq!(hash(&["--accelerator", "list"]), reference);
    assert_eq!(hash(&["--threads", "1"]), reference);
    assert_eq!(
        hash(&["--threads", "3", "--tile-order", "center"]),
        reference
    );
    assert_ne!(hash(&["--sampling", "center"]), reference);
    let simd = |args: &[&str]| stats(folder.path(), args)["simd"].clone();
    assert_eq!(hash(&["--simd", "scalar"]), reference);
    assert_eq!(simd(&["--simd", "scalar"]), "scalar");
    assert_eq!(simd(&["--accelerator", "grid"]), "scalar");
}

#[test]
fn every_picture_format_is_written() {
    let folder = folder_with_scene();
    for (name, magic) in [
        ("a.png", &b"\x89PNG"[..]),
        ("a.exr", b"\x76\x2f\x31\x01"),
        ("a.hdr", b"#?RADIANCE"),
        ("a.ppm", b"P6"),
    ] {
        let output = strahl(folder.path(), &["render", "scene.nff", "-o", name]);
        assert!(output.status.success(), "{}", stderr(&output));
        let bytes = std::fs::read(folder.path().join(name)).expect("written");
        assert!(bytes.starts_with(magic), "{name}");
    }
    let layered = [
        "render",
        "scene.nff",
        "-o",
        "layers.exr",
        "--layers",
        "--region",
        "5,6,20x10",
    ];
    let output = strahl(folder.path(), &layered);
    assert!(output.status.success(), "{}", stderr(&output));
    let bytes = std::fs::read(folder.path().join("layers.exr")).expect("written");
    for name in [
        "depth.Z",
        "normal.X",
        "position.Y",
        "object.id",
        "material.id",
        "tree.depth",
        "tests.count",
    ] {
        assert!(
            bytes.windows(name.len()).any(|w| w == name.as_bytes()),
            "layer {name}"
        );
    }
}

#[test]
fn a_scene_comes_from_the_standard_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = Command::new(env!("CARGO_BIN_EXE_strahl"))
        .current_dir(folder.path())
        .args(["render", "-", "--format", "nff", "-o", "out.png", "--quiet"])
        .stdin(Stdio::piped())
        .spawn()
        .expect("the program starts");
    child
        .stdin
        .take()
        .expect("piped")
        .write_all(SCENE.as_bytes())
        .expect("read");
    assert!(child.wait().expect("ends").success());
    assert!(folder.path().join("out.png").exists());
}

#[test]
fn a_bare_mesh_is_framed_and_lit() {
    let folder = tempfile::tempdir().expect("a folder");
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               element face 4\nproperty list uchar int vertex_indices\nend_header\n\
               10 10 10\n11 10 10\n10 11 10\n10 10 11\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    std::fs::write(folder.path().join("mesh.ply"), ply).expect("writable");
    let args = [
        "render", "mesh.ply", "-o", "a.ppm", "--size", "64x64", "--quiet",
    ];
    let output = strahl(folder.path(), &args);
    assert!(output.status.success(), "{}", stderr(&output));
    let bytes = std::fs::read(folder.path().join("a.ppm")).expect("written");
    let pixels = &bytes[bytes.len() - 64 * 64 * 3..];
    let (min, max) = pixels
        .iter()
        .fold((255, 0), |(a, b), v| (a.min(*v), b.max(*v)));
    assert!(
        max > 180 && min < 130,
        "the tetrahedron is lit and the background is dark: {min} {max}"
    );
    // Pixels in the middle, not at the border.
    let at = |x: usize, y: usize| &pixels[(y * 64 + x) * 3..][..3];
    assert_ne!(at(32, 34), at(1, 34));
}

/// Ray counts of the Standard Procedural Databases; docs/src/spd.md explains the tolerances.
#[test]
fn ray_counts_agree_with_the_published_ones() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/spd");
    if !scenes.is_dir() {
        skipped("the SPD scenes are not there");
        return;
    }
    let folder = folder_with_scene();
    // Primary hits, shadow rays, reflection and refraction rays, from the document of SPD 3.14.
    for (name, published) in [
        ("balls", [263_169.0, 954_368.0, 175_095.0]),
        ("gears", [245_086.0, 2_246_955.0, 512_207.0]),
        ("mount", [173_125.0, 412_922.0, 709_538.0]),
        ("teapot", [161_120.0, 407_656.0, 225_248.0]),
        ("tetra", [49_788.0, 46_112.0, 0.0]),
    ] {
        let scene = scenes.join(format!("{name}.nff.gz"));
        let scene = scene.to_str().expect("a plain path");
        let rules = [
            "--size",
            "512x512",
            "--sampling",
            "corners",
            "--max-depth",
            "5",
            "--adc-bailout",
            "0",
        ];
        let args = [
            &[
                "render", scene, "-o", "o.png", "--quiet", "--stats", "s.json",
            ],
            &rules[..],
        ]
        .concat();
        let output = strahl(folder.path(), &args);
        assert!(output.status.success(), "{}", stderr(&output));
        let stats: Value =
            serde_json::from_slice(&std::fs::read(folder.path().join("s.json")).expect("written"))
                .expect("JSON");
        let count = |key: &str| stats["rays"][key].as_f64().expect("a number");
        assert_eq!(count("primary"), 263_169.0);
        let ours = [
            count("primary_hit"),
            count("shadow"),
            count("reflection") + count("refraction"),
        ];
        for (ours, published) in ours.iter().zip(published) {
            assert!(
                (ours - published).abs() <= 0.02 * published,
                "{name}: {ours} instead of {published}"
            );
        }
    }
}

/// Whether `--resume` leaves the picture alone.
fn keeps(folder: &Path, args: &[&str]) -> bool {
    let words = [&["render"], args, &["--sampling", "center", "--resume"]].concat();
    let output = strahl(folder, &words);
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    let kept = said.contains("complete already");
    assert_ne!(kept, said.contains("Mrays/s"), "{said}");
    kept
}

#[test]
fn resume_renders_pictures_of_another_size_and_cut_off_ones_in_all_formats() {
    let folder = folder_with_scene();
    let f = folder.path();
    for format in strahl::formats::image::formats() {
        let name = format!("a.{}", format.extensions[0]);
        let args = |size| ["scene.nff", "-o", name.as_str(), "--size", size];
        assert!(!keeps(f, &args("12x9")), "{name}");
        assert!(keeps(f, &args("12x9")), "{name}");
        assert!(!keeps(f, &args("9x12")), "{name}");
        assert!(keeps(f, &args("9x12")), "{name}");
        let whole = std::fs::read(f.join(&name)).expect("written");
        for rest in [1, whole.len() / 2, whole.len() - 1] {
            std::fs::write(f.join(&name), &whole[..rest]).expect("writable");
            assert!(!keeps(f, &args("9x12")), "{name}: {rest} bytes");
        }
    }
}

#[test]
fn resume_knows_the_size_of_regions_and_of_scenes() {
    let folder = folder_with_scene();
    let f = folder.path();
    // The scene's own size is 48x40.
    assert!(!keeps(f, &["scene.nff", "-o", "own.png"]));
    assert!(keeps(f, &["scene.nff", "-o", "own.png"]));
    assert!(keeps(f, &["scene.nff", "-o", "own.png", "--size", "48x40"]));
    assert!(!keeps(
        f,
        &["scene.nff", "-o", "own.png", "--size", "40x48"]
    ));
    assert!(!keeps(f, &["scene.nff", "-o", "own.png"]));
    for format in ["png", "exr"] {
        let name = format!("part.{format}");
        let part = ["scene.nff", "-o", name.as_str(), "--region", "4,5,10x8"];
        assert!(!keeps(f, &part) && keeps(f, &part));
        let full = [&part[..], &["--full-size"]].concat();
        assert!(!keeps(f, &full) && keeps(f, &full));
        assert!(!keeps(f, &part));
    }
    assert!(!keeps(f, &["-o", "demo.png", "--size", "8x6"]));
    assert!(keeps(f, &["-o", "demo.png", "--size", "8x6"]));
    assert!(!keeps(f, &["-o", "demo.png", "--region", "0,0,4x4"]));
}
