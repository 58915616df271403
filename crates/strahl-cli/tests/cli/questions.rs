//! Commands that print information.

use crate::{fails, folder_with_scene, stderr, strahl};
use serde_json::Value;
use std::process::{Command, Stdio};

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
    // The columns are straight.
    let (tables, _) = formats.split_once("Accelerators").expect("a list");
    let rows: Vec<&str> = tables.lines().filter(|l| l.starts_with("  ")).collect();
    assert!(rows.len() > 12, "{formats}");
    for row in rows {
        let (name, endings) = row.split_at(15);
        assert!(name.ends_with(' ') && endings.starts_with('.'), "{row}");
    }
    fails(folder.path(), &["view", "-"], 1, &["needs a file"]);
    fails(folder.path(), &["view", "."], 1, &["is a folder"]);
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
        // Width and height in the header: the picture has 40 more rows for the legend.
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

/// `strahl info ... | head -0`: a reader may close the output early.
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
