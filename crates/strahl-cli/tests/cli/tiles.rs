//! `render --tile` and `merge`: the picture of all tiles is that of one process, bit for bit.

use super::{Path, fails, stderr, strahl};
use std::fs;

/// Focal blur, area lights, glass, textures, noise: everything whose rays might depend on a pixel's neighbours.
const SCENE: &str = "\
#version 3.7;
global_settings { assumed_gamma 1 }
#include \"ball.inc\"
camera { location <0, 2, -6> look_at <0, 0.7, 0> aperture 0.2 blur_samples 5 focal_point <0, 1, 0> }
light_source { <4, 8, -6> rgb 1 area_light <2, 0, 0>, <0, 0, 2>, 3, 3 adaptive 1 jitter }
plane { y, 0 pigment { checker rgb 0.9 rgb 0.1 } finish { reflection 0.2 crand 0.1 } }
sphere { <0, 1, 0>, R + clock / 10 pigment { bozo color_map { [0 rgb <1, 0, 0>] [1 rgb <0, 1, 1, 0.7>] } } interior { ior 1.4 } }
torus { 1.6, 0.2 translate y * 0.3 pigment { rgb <0.2, 0.4, 1> } }
";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.pov"), SCENE).expect("writable");
    fs::write(folder.path().join("ball.inc"), "#declare R = 1;").expect("writable");
    folder
}

fn run(folder: &Path, words: &str) {
    let words: Vec<&str> = words.split_whitespace().collect();
    let output = strahl(folder, &words);
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
}

/// Renders the scene at once and in tiles.
fn both(folder: &Path, options: &str, count: u32) {
    run(
        folder,
        &format!("render scene.pov -q -o whole.exr --stats whole.json {options} --threads 2"),
    );
    for number in 1..=count {
        run(
            folder,
            &format!(
                "render scene.pov -q -o t{number}.exr {options} --tile {number}/{count} --threads 1"
            ),
        );
    }
}

fn tiles(count: u32) -> String {
    let names: Vec<String> = (1..=count).rev().map(|n| format!("t{n}.exr")).collect();
    names.join(" ")
}

#[test]
fn tiles_make_the_file_of_one_process() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    for options in [
        "--sampling center --layers",
        "--sampling corners --layers --alpha",
        "--sampling 2x2",
        "--sampling adaptive:0.1,3 --layers",
        "--sampling adaptive:0.1,2 --alpha",
        "--sampling recursive:0.1,3",
        "--sampling recursive:0.1,2 --layers --alpha",
        "+A0.2 +R2 +AM1",
        "+A0.2 +R2 +AM2 +UA",
        "--sampling center --clock 1 --declare Q=2 --no-packets",
    ] {
        let options = format!("{options} --size 100x70");
        both(folder.path(), &options, 4);
        run(
            folder.path(),
            &format!("merge {} -q -o merged.exr --stats stats.json", tiles(4)),
        );
        let (whole, merged) = (fs::read(at("whole.exr")), fs::read(at("merged.exr")));
        // Colours, layers and metadata, among them the hash of the film.
        assert!(whole.unwrap() == merged.unwrap(), "{options}");
        let hash = |name: &str| {
            let json: serde_json::Value =
                serde_json::from_slice(&fs::read(at(name)).unwrap()).unwrap();
            json["image"]["sha256"].as_str().expect("a text").to_owned()
        };
        assert_eq!(hash("stats.json"), hash("whole.json"), "{options}");
    }
}

#[test]
fn tiles_make_the_png_of_one_process() {
    let folder = folder();
    both(folder.path(), "--size 70x40", 2);
    run(folder.path(), "merge t1.exr t2.exr -q -o merged.png");
    run(
        folder.path(),
        "render scene.pov -q -o whole.png --size 70x40",
    );
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("merged.png") == read("whole.png"));
}

#[test]
fn what_is_wrong_with_tiles_is_told() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let small = "--size 100x70 --sampling center";
    both(folder.path(), small, 4);
    let merge = |tiles: &str, parts: &[&str]| {
        let words = format!("merge {tiles} -o picture.png");
        let words: Vec<&str> = words.split_whitespace().collect();
        fails(folder.path(), &words, 1, parts);
    };
    merge("t1.exr t4.exr", &["tiles are missing: 2-3 of 4"]);
    merge("t1.exr t2.exr t2.exr t3.exr t4.exr", &["both tile 2 of 4"]);
    merge("whole.exr t1.exr", &["whole.exr", "not a tile"]);
    merge("none.exr", &["there is no file `none.exr`"]);

    run(
        folder.path(),
        &format!("render scene.pov -q -o other.exr {small} --tile 2/4 --seed 7 --max-depth 3"),
    );
    merge(
        "t1.exr other.exr t3.exr t4.exr",
        &[
            "other.exr",
            "seed 7 instead of 0",
            "max-depth 3 instead of",
            "missing: 2 of 4",
        ],
    );
    run(
        folder.path(),
        &format!("render scene.pov -q -o other.exr {small} --tile 2/5"),
    );
    merge(
        "t1.exr other.exr t3.exr t4.exr",
        &["one of 5 tiles, the others of 4"],
    );
    run(
        folder.path(),
        &format!("render scene.pov -q -o other.exr {small} --tile 2/4@0,0,32x70"),
    );
    merge("t1.exr other.exr t3.exr t4.exr", &["both have the pixels"]);

    // The include file has changed between two tiles.
    fs::write(at("ball.inc"), "#declare R = 1.01;").unwrap();
    run(
        folder.path(),
        &format!("render scene.pov -q -o other.exr {small} --tile 2/4"),
    );
    merge(
        "t1.exr other.exr t3.exr t4.exr",
        &["other.exr: is of another scene"],
    );

    let bytes = fs::read(at("t2.exr")).unwrap();
    fs::write(at("t2.exr"), &bytes[..bytes.len() - 100]).unwrap();
    merge(
        "t1.exr t2.exr t3.exr t4.exr",
        &["t2.exr", "not a complete", "missing: 2 of 4"],
    );
}

#[test]
fn impossible_tiles_are_told() {
    let folder = folder();
    for (words, code, parts) in [
        ("--tile 5/4", 2, &["K/N"][..]),
        ("--tile 1/100 --size 64x64", 1, &["64x64", "4 at most"]),
        ("--tile 1/2 -o tile.png", 1, &[".exr"]),
        ("--tile 1/2 -o -", 1, &[".exr"]),
        ("--tile 1/2 --region 0,0,4x4", 2, &["--region"]),
    ] {
        let words = format!("render scene.pov -q {words}");
        let words: Vec<&str> = words.split_whitespace().collect();
        fails(folder.path(), &words, code, parts);
    }
    fs::write(folder.path().join("time.pov"), "sphere { now * 0, 1 }").unwrap();
    let words = "render time.pov --tile 1/1 --size 64x40";
    let words: Vec<&str> = words.split_whitespace().collect();
    let warned = stderr(&strahl(folder.path(), &words));
    assert!(warned.contains("reads the time"), "{warned}");
    run(folder.path(), "render scene.pov -q --tile 1/2 --size 64x40");
    assert!(folder.path().join("scene-1of2.exr").is_file());
    fails(
        folder.path(),
        &["merge", "scene-1of2.exr", "-o", "scene-1of2.exr"],
        1,
        &["is one of the tiles"],
    );
}

#[test]
fn machines_with_other_vector_instructions_find_the_same_tiles() {
    let folder = folder();
    let options = "--size 130x100 --sampling center";
    both(folder.path(), options, 3);
    run(
        folder.path(),
        &format!("render scene.pov -q -o t2.exr {options} --tile 2/3 --simd scalar --threads 2"),
    );
    run(folder.path(), "merge t1.exr t2.exr t3.exr -q -o merged.exr");
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("merged.exr") == read("whole.exr"));
}
