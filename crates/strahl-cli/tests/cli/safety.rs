//! Hostile and careless input: memory, terminals, threads, warnings.

use crate::{fails, folder_with_scene, stderr, strahl};
use serde_json::Value;
use std::io::Write;
use std::path::Path;

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).expect("writable");
}

/// A picture that statistics replace would be lost.
#[test]
fn two_outputs_have_two_names() {
    let folder = folder_with_scene();
    let f = folder.path();
    let render = ["render", "scene.nff", "--size", "4x3", "-o", "a.png"];
    for more in [
        &["--stats", "a.png"][..],
        &["--stats", "./a.png"],
        &["--profile=a.png"],
        &["--stats", "s.json", "--profile=s.json"],
    ] {
        fails(f, &[&render[..], more].concat(), 1, &["named twice"]);
    }
    let output = strahl(f, &[&render[..], &["--stats", "a.json"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    // Names of one file are found out, too.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("a.png", f.join("b.png")).expect("a link");
        let more = ["--stats", "b.png"];
        fails(f, &[&render[..], &more].concat(), 1, &["named twice"]);
    }
    let tile = ["render", "scene.nff", "--tile", "1/1", "-o", "t.exr"];
    assert!(strahl(f, &tile).status.success());
    let merge = ["merge", "t.exr", "-o", "m.png", "--stats"];
    fails(f, &[&merge[..], &["m.png"]].concat(), 1, &["named twice"]);
    let over = [&merge[..], &["t.exr"]].concat();
    fails(f, &over, 1, &["t.exr is one of the tiles"]);
    let both = ["merge", "t.exr", "-o", "-", "--stats", "-"];
    fails(f, &both, 1, &["standard output"]);
}

#[test]
fn heat_maps_spare_their_scene() {
    let folder = folder_with_scene();
    let f = folder.path();
    std::fs::write(f.join("scene.png"), crate::SCENE).expect("writable");
    let words = ["heatmap", "scene.png", "--format", "nff", "-o", "scene.png"];
    fails(f, &words, 1, &["scene.png is the scene itself"]);
    let kept = std::fs::read_to_string(f.join("scene.png")).expect("kept");
    assert_eq!(kept, crate::SCENE);
}

#[test]
fn memory_that_is_not_allowed_is_an_error_with_a_reason() {
    let folder = folder_with_scene();
    let f = folder.path();
    // A loop that allocates without end.
    write(
        f,
        "loop.pov",
        "#declare A = array[1000000]; #declare I = 0; #while (I < 1000000) #declare A[I] = concat(\"a rather long text of number \", str(I, 0, 0)); \
         #declare I = I + 1; #end sphere { 0, 1 }",
    );
    fails(
        f,
        &["check", "loop.pov", "--max-memory", "24M"],
        1,
        &["out of memory", "reading loop.pov", "--max-memory"],
    );
    // A small PNG file that decompresses to much: 12000 x 12000 pixels of one colour.
    let mut png = vec![];
    let rows = vec![0u8; 1 + 3 * 12_000];
    let mut packed = flate2::write::ZlibEncoder::new(vec![], flate2::Compression::fast());
    for _ in 0..12_000 {
        packed.write_all(&rows).expect("packed");
    }
    let packed = packed.finish().expect("packed");
    png.extend(b"\x89PNG\r\n\x1a\n");
    let mut chunk = |name: &[u8; 4], data: &[u8]| {
        png.extend((data.len() as u32).to_be_bytes());
        let mut sum = flate2::Crc::new();
        sum.update(name);
        sum.update(data);
        png.extend(name);
        png.extend(data);
        png.extend(sum.sum().to_be_bytes());
    };
    let side = 12_000u32.to_be_bytes();
    chunk(b"IHDR", &[&side[..], &side, &[8, 2, 0, 0, 0]].concat());
    chunk(b"IDAT", &packed);
    chunk(b"IEND", &[]);
    std::fs::write(f.join("bomb.png"), &png).expect("writable");
    write(
        f,
        "bomb.pov",
        "plane { z, 1 pigment { image_map { png \"bomb.png\" } } }",
    );
    fails(
        f,
        &["check", "bomb.pov", "--max-memory", "100M"],
        1,
        &["bomb.png", "memory", "bomb.pov:1"],
    );
    // Gzip.
    let mut packed = flate2::write::GzEncoder::new(vec![], flate2::Compression::fast());
    for _ in 0..60 {
        packed.write_all(&vec![b' '; 1 << 20]).expect("packed");
    }
    std::fs::write(f.join("bomb.nff.gz"), packed.finish().expect("packed")).expect("writable");
    fails(
        f,
        &["check", "bomb.nff.gz", "--max-memory", "40M"],
        1,
        &["bomb.nff.gz", "memory"],
    );
    // The rendered picture itself.
    let large = [
        "render",
        "scene.nff",
        "--size",
        "20000x20000",
        "--max-memory",
        "500M",
        "-o",
        "x.png",
    ];
    fails(f, &large, 1, &["memory", "--region"]);
    fails(
        f,
        &["check", "scene.nff", "--max-memory", "lots"],
        2,
        &["500M"],
    );
}

#[test]
fn scenes_cannot_command_the_terminal() {
    let folder = folder_with_scene();
    let f = folder.path();
    let hostile = "a\u{1b}[2J\u{1b}]0;owned\u{7}b\u{9b}31m\r\u{202e}c";
    write(
        f,
        "e.pov",
        &format!("#debug \"{hostile}\\n\"\n#warning \"{hostile}\"\nsphere {{ 0, \"{hostile}\" }}"),
    );
    for args in [
        &["check", "e.pov"][..],
        &["render", "e.pov"],
        &["check", "none\u{1b}[2J.pov"],
    ] {
        let said = stderr(&strahl(f, args));
        assert!(said.contains("\\x1b[2J"), "{said}");
        let plain = |c: char| !c.is_control() || matches!(c, '\n' | '\t');
        assert!(
            said.chars().all(|c| plain(c) && c != '\u{202e}'),
            "{said:?}"
        );
    }
}

#[test]
fn errors_have_colours_only_where_they_are_wanted() {
    let folder = folder_with_scene();
    let run = |variables: &[(&str, &str)]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_strahl"));
        command
            .current_dir(folder.path())
            .args(["check", "none.pov"]);
        for name in ["NO_COLOR", "CLICOLOR_FORCE", "CLICOLOR"] {
            command.env_remove(name);
        }
        command.envs(variables.iter().copied());
        stderr(&command.output().expect("the program starts"))
    };
    assert!(!run(&[]).contains('\u{1b}'), "no terminal, no colours");
    assert!(run(&[("CLICOLOR_FORCE", "1")]).contains("\u{1b}[31merror"));
    assert!(!run(&[("NO_COLOR", "1")]).contains('\u{1b}'));
}

#[test]
fn one_fault_is_one_error() {
    let folder = folder_with_scene();
    let f = folder.path();
    let texts = [
        "#declare A = Missing + 1;\nsphere { 0, A }\nsphere { x, A }\nbox { -A, A }\n",
        "sphere { 0, Missing }\nsphere { x, Missing }\nbox { -1, Missing }\n",
    ];
    for text in texts {
        write(f, "one.pov", text);
        fails(f, &["check", "one.pov"], 1, &["`Missing`", "one.pov:1"]);
    }
}

#[test]
fn strict_takes_warnings_for_errors() {
    let folder = folder_with_scene();
    let f = folder.path();
    write(
        f,
        "w.pov",
        "sphere { 0, 1 }\nsphere { 0, 0 }\n#warning \"beware\"",
    );
    let small = ["render", "w.pov", "--size", "4x3"];
    assert!(strahl(f, &small).status.success());
    std::fs::remove_file(f.join("w.png")).expect("written");
    fails(
        f,
        &[&small[..], &["--strict"]].concat(),
        3,
        &["--strict", "warning"],
    );
    fails(f, &["check", "w.pov", "--strict"], 3, &["--strict"]);
    assert!(
        strahl(f, &["check", "scene.nff", "--strict"])
            .status
            .success()
    );
    // `--quiet` keeps errors and the reason of a failure.
    let quiet = strahl(f, &[&small[..], &["-q"]].concat());
    assert!(quiet.status.success() && quiet.stderr.is_empty());
    std::fs::remove_file(f.join("w.png")).expect("written");
    fails(
        f,
        &[&small[..], &["-q", "--strict"]].concat(),
        3,
        &["--strict"],
    );
    write(f, "bad.pov", "sphere { 0 }");
    fails(f, &["render", "bad.pov", "-q"], 1, &["bad.pov:1"]);
}

#[test]
fn threads_are_no_more_than_processors() {
    let folder = folder_with_scene();
    let f = folder.path();
    let args = [
        "render",
        "scene.nff",
        "--threads",
        "100000",
        "-o",
        "a.png",
        "--stats",
        "s.json",
    ];
    let output = strahl(f, &args);
    let said = stderr(&output);
    assert!(
        output.status.success() && said.contains("note: 100000 threads"),
        "{said}"
    );
    let stats: Value =
        serde_json::from_slice(&std::fs::read(f.join("s.json")).expect("written")).expect("JSON");
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    assert_eq!(stats["threads"].as_u64(), Some(most as u64));
}

#[test]
fn several_scenes_are_checked_at_once() {
    let folder = folder_with_scene();
    let f = folder.path();
    write(f, "bad.pov", "sphere { 0, Missing }\n");
    let output = strahl(f, &["check", "scene.nff", "bad.pov", "scene.nff"]);
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(told.matches("scene.nff: no problems").count(), 2, "{told}");
    let output = strahl(f, &["check", "--json", "scene.nff", "bad.pov"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stderr.is_empty(), "{}", stderr(&output));
    let told: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(
        (&told[0]["ok"], &told[1]["ok"]),
        (&true.into(), &false.into())
    );
    let found = &told[1]["diagnostics"][0];
    assert_eq!(found["severity"], "error");
    assert_eq!(found["file"], "bad.pov");
    assert_eq!((&found["line"], &found["column"]), (&1.into(), &13.into()));
}

#[test]
fn shells_and_man_know_the_program() {
    let folder = folder_with_scene();
    let f = folder.path();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = strahl(f, &["completions", shell]);
        let script = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            script.contains("strahl") && script.contains("accelerator"),
            "{shell}"
        );
    }
    let page = |args: &[&str]| String::from_utf8_lossy(&strahl(f, args).stdout).into_owned();
    assert!(page(&["man"]).contains(".TH strahl 1"));
    let slurm = page(&["man", "submit", "slurm"]);
    assert!(slurm.contains(".TH strahl-submit-slurm 1") && slurm.contains("partition"));
    let render = page(&["man", "render"]);
    assert!(
        render.contains(".TH strahl-render 1") && render.contains("max\\-memory"),
        "{render}"
    );
    fails(
        f,
        &["man", "nothing"],
        1,
        &["nothing", "render, view, explain"],
    );
    let nothing = ["man", "submit", "nothing"];
    fails(f, &nothing, 1, &["nothing", "slurm, openjd, status"]);
    fails(f, &["man", "render", "x"], 1, &["no commands of its own"]);
}

#[test]
fn heat_maps_take_one_sample_per_pixel() {
    let folder = folder_with_scene();
    let f = folder.path();
    let mean = |more: &[&str]| {
        let args = [
            &["heatmap", "scene.nff", "--metric", "rays", "-o", "h.png"][..],
            more,
        ]
        .concat();
        let said = stderr(&strahl(f, &args));
        let (_, rest) = said.split_once("mean ").expect("told");
        rest.split(',')
            .next()
            .and_then(|n| n.parse::<f64>().ok())
            .expect("a number")
    };
    assert_eq!(mean(&[]), mean(&["--sampling", "center"]));
    assert!(mean(&[]) < mean(&["--sampling", "2x2"]));
}

#[test]
fn unknown_formats_are_answered_with_all() {
    let folder = folder_with_scene();
    let f = folder.path();
    for args in [
        &["check", "scene.nff", "--format", "xyz"][..],
        &["check", "what.xyz"],
    ] {
        if args.len() == 2 {
            write(f, "what.xyz", "hello");
        }
        let output = strahl(f, args);
        let said = stderr(&output);
        for name in ["pov", "nff", "obj", "ply", "stl", "gltf"] {
            assert!(said.contains(name), "{args:?}: no {name} in {said}");
        }
    }
}
