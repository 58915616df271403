//! The program as its users run it.

use serde_json::Value;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const SCENE: &str = "\
b 0.1 0.2 0.4
v
from 0 1 6
at 0 0 0
up 0 1 0
angle 40
hither 0.1
resolution 48 40
l 5 6 7
f 0.9 0.8 0.7 0.7 0.3 20 0 1
s 0 0 0 1
f 1 1 1 0.1 0.1 50 0.8 1.5
s 1.5 0 1 0.6
f 0.4 0.6 0.4 0.9 0 1 0 1
p 4
-4 -1 4
4 -1 4
4 -1 -4
-4 -1 -4
";

fn strahl(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strahl"));
    command.current_dir(folder).args(args).stdin(Stdio::null());
    command.output().expect("the program starts")
}

fn folder_with_scene() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("scene.nff"), SCENE).expect("writable");
    folder
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn stats(folder: &Path, args: &[&str]) -> Value {
    let all = [
        &[
            "render",
            "scene.nff",
            "-o",
            "out.png",
            "--quiet",
            "--stats",
            "stats.json",
        ],
        args,
    ]
    .concat();
    let output = strahl(folder, &all);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(
        output.stderr.is_empty(),
        "quiet means quiet: {}",
        stderr(&output)
    );
    let bytes = std::fs::read(folder.join("stats.json")).expect("written");
    serde_json::from_slice(&bytes).expect("JSON")
}

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
fn explain_prints_a_tree_that_sums_up_to_the_pixel() {
    let folder = folder_with_scene();
    let args = [
        "explain",
        "scene.nff",
        "--pixel",
        "24,20",
        "--sampling",
        "center",
    ];
    let text = strahl(folder.path(), &args);
    let text = String::from_utf8(text.stdout).expect("text");
    for part in [
        "primary ray",
        "sphere",
        "scene.nff:11",
        "ka·Ia",
        "kd(n·l)",
        "ks(h·n)^p",
        "kr·Xr",
        "linear colour",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let json = strahl(folder.path(), &[&args[..], &["--format", "json"]].concat());
    let json: Value = serde_json::from_slice(&json.stdout).expect("JSON");
    let rays = json["samples"][0]["rays"].as_array().expect("rays");
    let channel = |v: &Value, i: usize| v[i].as_f64().expect("a number");
    // Add the tree up again, from the printed numbers alone.
    let mut totals = vec![[0.0; 3]; rays.len()];
    for ray in rays.iter().rev() {
        let id = ray["id"].as_u64().expect("id") as usize;
        totals[id] = std::array::from_fn(|i| {
            let mut sum = channel(&ray["local"], i);
            let (mut reflected, mut transmitted) = (0.0, 0.0);
            for child in ray["children"].as_array().expect("children") {
                let child = child.as_u64().expect("id") as usize;
                match rays[child]["kind"].as_str() {
                    Some("reflection") => reflected = totals[child][i],
                    _ => transmitted = totals[child][i],
                }
            }
            if !ray["hit"].is_null() {
                sum = sum
                    + channel(&ray["hit"]["kr"], i) * reflected
                    + channel(&ray["hit"]["kt"], i) * transmitted;
            }
            sum * channel(&ray["attenuation"], i)
        });
    }
    for (i, total) in totals[0].iter().enumerate() {
        assert_eq!(*total, channel(&json["color"], i));
        assert_eq!(*total as f32, channel(&json["film"], i) as f32);
    }
    let dot = strahl(folder.path(), &[&args[..], &["--format", "dot"]].concat());
    let dot = String::from_utf8(dot.stdout).expect("text");
    assert!(dot.starts_with("digraph") && dot.trim_end().ends_with('}'));
    if let Some(program) = tool("dot") {
        let mut child = Command::new(program)
            .args(["-Tsvg", "-o", "tree.svg"])
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .spawn()
            .expect("starts");
        child
            .stdin
            .take()
            .expect("piped")
            .write_all(dot.as_bytes())
            .expect("read");
        assert!(child.wait().expect("ends").success());
    }
}

#[test]
fn info_check_and_formats_tell_what_there_is() {
    let folder = folder_with_scene();
    let out = |args: &[&str]| {
        let output = strahl(folder.path(), args);
        assert!(output.status.success(), "{}", stderr(&output));
        String::from_utf8(output.stdout).expect("text")
    };
    let info = out(&["info", "scene.nff"]);
    for part in [
        "2 sphere",
        "1 polygon",
        "perspective",
        "48x40",
        "point light",
        "bounds",
        "memory",
    ] {
        assert!(info.contains(part), "{part}: {info}");
    }
    assert!(out(&["check", "scene.nff"]).contains("no problems"));
    let formats = out(&["formats"]);
    for part in [
        ".nff", ".obj", ".ply", ".stl", ".glb", ".png", ".exr", ".hdr", ".ppm",
    ] {
        assert!(formats.contains(part), "{part}");
    }
}

/// Runs a command that must fail with one clear message and leave no file behind.
fn fails(folder: &Path, args: &[&str], code: i32, parts: &[&str]) {
    let before = listing(folder);
    let output = strahl(folder, args);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{args:?}: {message}");
    for part in parts {
        assert!(
            message.contains(part),
            "{args:?} should mention {part:?}: {message}"
        );
    }
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(message.matches("error").count(), 1, "one error: {message}");
    assert_eq!(listing(folder), before, "{args:?} left something behind");
}

fn listing(folder: &Path) -> Vec<PathBuf> {
    let mut names: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("readable").path())
        .collect();
    names.sort();
    names
}

#[test]
fn bad_input_gives_one_clear_error() {
    let folder = folder_with_scene();
    let f = folder.path();
    let write = |name: &str, bytes: &[u8]| std::fs::write(f.join(name), bytes).expect("writable");
    fails(f, &["render", "none.nff", "-o", "x.png"], 1, &["none.nff"]);
    fails(
        f,
        &["render", "scene.nff", "-o", "x.jpg"],
        1,
        &[".jpg", ".png"],
    );
    fails(f, &["render", "scene.nff", "-o", "no/x.png"], 1, &["no"]);
    fails(
        f,
        &["render", "scene.nff", "-o", "x.png", "--size", "0x10"],
        1,
        &["0 x 10"],
    );
    fails(
        f,
        &["render", "scene.nff", "-o", "x.png", "--size", "wide"],
        2,
        &["1280x720"],
    );
    fails(
        f,
        &[
            "render",
            "scene.nff",
            "-o",
            "x.png",
            "--region",
            "40,0,10x10",
        ],
        1,
        &["region", "48 x 40"],
    );
    fails(
        f,
        &[
            "render",
            "scene.nff",
            "-o",
            "x.png",
            "--size",
            "4000000000x4000000000",
        ],
        1,
        &["memory", "--region"],
    );
    fails(
        f,
        &["render", "scene.nff", "-o", "x.png", "--layers"],
        1,
        &[".exr"],
    );
    fails(
        f,
        &["render", "scene.nff", "-o", "x.png", "--accelerator", "kd"],
        2,
        &["list, spheres, bvh2, bvh, grid, grids, octree"],
    );
    fails(f, &["render", "-", "-o", "x.png"], 1, &["--format"]);
    fails(
        f,
        &["explain", "scene.nff", "--pixel", "48,0"],
        1,
        &["48,0", "47,39"],
    );
    write("what.xyz", b"hello");
    fails(f, &["render", "what.xyz", "-o", "x.png"], 1, &["what.xyz"]);
    write(
        "garbage.nff",
        &[0u8, 159, 146, 150, 255, 254, 7, 8, 9, 10, 200],
    );
    fails(
        f,
        &["render", "garbage.nff", "-o", "x.png"],
        1,
        &["garbage.nff"],
    );
    write("empty.ply", b"");
    fails(f, &["render", "empty.ply", "-o", "x.png"], 1, &["empty"]);
    write("nan.nff", b"f 1 1 1 1 0 1 0 1\ns 0 nan 0 1\n");
    fails(
        f,
        &["render", "nan.nff", "-o", "x.png"],
        1,
        &["nan.nff:2:5", "^"],
    );
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    write("short.ply", format!("{header}0 0 0\n1 0 0\n").as_bytes());
    fails(
        f,
        &["render", "short.ply", "-o", "x.png"],
        1,
        &["short.ply"],
    );
    write(
        "range.ply",
        format!("{header}0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n").as_bytes(),
    );
    fails(f, &["render", "range.ply", "-o", "x.png"], 1, &["7"]);
    write("range.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    fails(
        f,
        &["render", "range.obj", "-o", "x.png"],
        1,
        &["range.obj:4", "9"],
    );
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
    // Seen in the middle, not at the border.
    let at = |x: usize, y: usize| &pixels[(y * 64 + x) * 3..][..3];
    assert_ne!(at(32, 34), at(1, 34));
}

/// Says that a test, or a part of it, did not run.
#[expect(
    clippy::print_stdout,
    reason = "a skipped test must leave a visible line"
)]
fn skipped(why: &str) {
    println!("skipped: {why}");
}

/// A program to compare with; without it the caller skips, unless the environment requires all tools.
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
        skipped(&format!("{name} is not installed"));
    }
    found
}

/// Ray counts of the Standard Procedural Databases; docs/src/spd.md explains the limits.
#[test]
fn ray_counts_agree_with_the_published_ones() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/spd");
    if !scenes.is_dir() {
        skipped("the SPD scenes are not there");
        return;
    }
    let folder = folder_with_scene();
    // Primary hits, shadow rays, reflection and refraction rays: SPD 3.14's document.
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

#[test]
fn compare_gives_one_row_for_each_accelerator_with_one_picture() {
    let folder = folder_with_scene();
    let small = [
        "compare",
        "scene.nff",
        "--size",
        "24x20",
        "--sampling",
        "center",
    ];
    let output = strahl(folder.path(), &[&small[..], &["--json"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).expect("JSON");
    for name in ["list", "spheres", "bvh2", "bvh", "grid", "grids", "octree"] {
        let row = rows.iter().find(|r| r["accelerator"] == name).expect(name);
        for key in [
            "build_s",
            "bytes",
            "nodes",
            "references",
            "rays",
            "hits",
            "tests_per_ray",
            "rays_per_s",
        ] {
            assert!(row[key].is_number(), "{name} {key}");
        }
        assert_eq!(row["sha256"], rows[0]["sha256"]);
        assert_eq!(row["equal"], true);
        let (hits, rays) = (row["hits"].as_u64(), row["rays"].as_u64());
        assert!(hits > Some(0) && hits < rays, "{hits:?} of {rays:?}");
    }
    let output = strahl(
        folder.path(),
        &[
            &small[..],
            &[
                "--csv",
                "--with",
                "octree:split=centre,depth=4",
                "--with",
                "list",
            ],
        ]
        .concat(),
    );
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 3, "{text}");
    assert!(
        lines[1].starts_with("\"list\",")
            && lines[2].starts_with("\"octree:depth=4,split=centre\",")
    );
}

#[test]
fn heat_maps_have_a_legend_or_a_layer() {
    let folder = folder_with_scene();
    for metric in ["tests", "steps", "time", "depth", "rays"] {
        let args = [
            "heatmap",
            "scene.nff",
            "--size",
            "40x30",
            "--metric",
            metric,
            "-o",
            "heat.png",
        ];
        let output = strahl(
            folder.path(),
            &[&args[..], &["--accelerator", "grid"]].concat(),
        );
        assert!(output.status.success(), "{}", stderr(&output));
        let png = std::fs::read(folder.path().join("heat.png")).expect("written");
        // Width and height of the header: 40 rows of legend are below the picture.
        assert_eq!(&png[16..24], &[0, 0, 0, 40, 0, 0, 0, 70]);
    }
    let args = [
        "heatmap",
        "scene.nff",
        "--size",
        "40x30",
        "--scale",
        "10",
        "-o",
        "heat.exr",
    ];
    assert!(strahl(folder.path(), &args).status.success());
    let exr = std::fs::read(folder.path().join("heat.exr")).expect("written");
    assert!(exr.windows(10).any(|w| w == b"cost.value"));
    fails(
        folder.path(),
        &["heatmap", "scene.nff", "--scale", "0", "-o", "x.png"],
        2,
        &["above 0"],
    );
}

#[test]
fn trace_ray_tells_the_way() {
    let folder = folder_with_scene();
    let ask = |accelerator: &str| {
        let args = [
            "trace-ray",
            "scene.nff",
            "--pixel",
            "24,20",
            "--json",
            "--accelerator",
        ];
        let output = strahl(folder.path(), &[&args[..], &[accelerator]].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        serde_json::from_slice::<Value>(&output.stdout).expect("JSON")
    };
    let reference = ask("list");
    for (accelerator, place) in [
        ("spheres", "leaf sphere"),
        ("bvh", "leaf"),
        ("bvh2", "leaf"),
        ("grid", "cell"),
        ("octree:traversal=trial-plane", "leaf"),
    ] {
        let way = ask(accelerator);
        assert_eq!(way["hit"], reference["hit"], "{accelerator}");
        let events = way["events"].as_array().expect("a list");
        assert!(
            events.iter().any(|e| e["event"] == place),
            "{accelerator}: {way:#}"
        );
        assert!(
            events
                .iter()
                .any(|e| e["event"] == "test" && !e["hit"].is_null())
        );
        if accelerator.starts_with("octree") {
            assert!(events.iter().any(|e| e["exit"]["region"].is_number()));
        }
    }
    let text = strahl(
        folder.path(),
        &[
            "trace-ray",
            "scene.nff",
            "--pixel",
            "24,20",
            "--accelerator",
            "grid",
        ],
    );
    let text = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(
        text.contains("exit -z") && text.contains("hit   t ="),
        "{text}"
    );
    fails(
        folder.path(),
        &["trace-ray", "scene.nff", "--pixel", "99,0"],
        1,
        &["no pixel 99,0"],
    );
}

/// `strahl info ... | head -0`: whoever reads may have enough.
#[test]
fn a_reader_who_has_enough_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_strahl"))
        .arg("formats")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("strahl runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("strahl ends");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.is_empty() && output.status.success(), "{said}");
}
