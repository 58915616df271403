//! Errors of the command line and of scenes.

use crate::{fails, folder_with_scene, stderr, strahl};

#[test]
fn wrong_numbers_are_told_with_their_option() {
    let folder = folder_with_scene();
    let f = folder.path();
    let none = "not negative";
    for (words, parts) in [
        (
            "explain scene.nff --pixel -1,3",
            ["--pixel <X,Y>", "-1,3", "negative"],
        ),
        (
            "render scene.nff --size -1x10",
            ["--size <WxH>", "-1x10", "negative"],
        ),
        (
            "render scene.nff --threads -1",
            ["--threads <N>", "'-1'", "negative"],
        ),
        (
            "render scene.nff --depth -1",
            ["--max-depth <N>", "'-1'", "negative"],
        ),
        (
            "render scene.nff --subset-start-frame -.5",
            ["--subset-start-frame", "-.5", "negative"],
        ),
        (
            "submit task a.job --task -1",
            ["--task <N>", "'-1'", "negative"],
        ),
        (
            "heatmap scene.nff -o a.png --scale -1",
            ["--scale <MAX>", "'-1'", "negative"],
        ),
        (
            "render scene.nff --threads x",
            ["--threads <N>", "'x'", none],
        ),
        (
            "render scene.nff --threads=-2",
            ["--threads <N>", "'-2'", none],
        ),
        (
            "render scene.nff --max-depth x",
            ["--max-depth <N>", "'x'", none],
        ),
        (
            "render scene.nff --clock x",
            ["--clock <T>", "'x'", "such as 0.5"],
        ),
        (
            "render scene.nff --seed 99999999999999999999",
            ["--seed <N>", "9999", "too large"],
        ),
        ("submit task a.job -q", ["-q", "unexpected", "--help"]),
        ("render scene.nff -1", ["-1", "unexpected", "--help"]),
        (
            "render scene.nff --alpha -1",
            ["-1", "unexpected", "--help"],
        ),
    ] {
        let words: Vec<&str> = words.split_whitespace().collect();
        fails(f, &words, 2, &parts);
        let said = stderr(&strahl(f, &words));
        for part in ["'-- ", "digit found", "float literal", "target type"] {
            assert!(!said.contains(part), "{words:?}: {said}");
        }
    }
}

#[test]
fn advice_names_options_that_the_command_has() {
    let folder = folder_with_scene();
    let f = folder.path();
    std::fs::write(f.join("scene.dat"), "nothing that is known").expect("writable");
    for command in ["explain", "info", "render"] {
        let more = match command {
            "explain" => &["--pixel", "3,3"][..],
            "render" => &["-o", "a.png"],
            _ => &[],
        };
        for scene in ["-", "scene.dat"] {
            let words = [&[command, scene], more].concat();
            fails(f, &words, 1, &["--scene-format"]);
        }
        // Empty, as the standard input of this test is.
        let words = [&[command, "-", "--scene-format", "nff"], more].concat();
        let said = stderr(&strahl(f, &words));
        assert!(!said.contains("unexpected argument"), "{said}");
    }
}

#[test]
fn formats_with_an_alpha_channel_are_named() {
    let folder = folder_with_scene();
    let words = ["render", "scene.nff", "--alpha", "-o", "a.ppm"];
    fails(folder.path(), &words, 1, &["(.png, .exr, .tga)"]);
}

#[test]
fn bad_input_gives_one_clear_error() {
    let folder = folder_with_scene();
    let f = folder.path();
    let write = |name: &str, bytes: &[u8]| std::fs::write(f.join(name), bytes).expect("writable");
    fails(f, &["render", "none.nff", "-o", "x.png"], 1, &["none.nff"]);
    fails(
        f,
        &["render", "scene.nff", "-o", "x.webp"],
        1,
        &[".webp", ".png", ".jpg"],
    );
    fails(f, &["render", "scene.nff", "-o", "no/x.png"], 1, &["no"]);
    fails(
        f,
        &["render", "scene.nff", "-o", "x.png", "--size", "0x10"],
        2,
        &["--size", "at least 1"],
    );
    for (option, tip) in [
        ("--width", "--size 640x480"),
        ("--spp", "--sampling 4x4"),
        ("--jobs", "--threads 4"),
        ("--out", "-o picture.png"),
    ] {
        fails(f, &["render", "scene.nff", option, "4"], 2, &[option, tip]);
    }
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
    fails(f, &["render", "-", "-o", "x.png"], 1, &["--scene-format"]);
    fails(
        f,
        &["explain", "scene.nff", "--pixel", "48,0"],
        1,
        &["48,0", "47,39"],
    );
    fails(
        f,
        &["render", "scene.nff", "-o", "x.png", "--simd", "mmx"],
        2,
        &["mmx", "scalar, sse4, avx2, avx512"],
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
