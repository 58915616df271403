//! Scenes in POV-Ray's language, and POV-Ray's command lines.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const SCENE: &str = "\
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -5> look_at 0 }
light_source { <3, 4, -6> rgb 1 }
sphere { <clock, 0, 0>, 1 pigment { rgb <1, 0.5, 0.2> } }
#debug concat(\"frame \", str(frame_number, 0, 0), \" of \", str(final_frame, 0, 0), \" clock \", str(clock, 0, 3), \"\\n\")
";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "scene.pov", SCENE);
    folder
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).expect("writable");
}

fn strahl(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strahl"));
    command.current_dir(folder).args(args).stdin(Stdio::null());
    command.output().expect("the program starts")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[track_caller]
fn succeeds(folder: &Path, args: &[&str]) -> String {
    let output = strahl(folder, args);
    assert!(output.status.success(), "{args:?}: {}", stderr(&output));
    stderr(&output)
}

#[track_caller]
fn fails(folder: &Path, args: &[&str], code: i32, parts: &[&str]) -> String {
    let output = strahl(folder, args);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{args:?}: {text}");
    for part in parts {
        assert!(text.contains(part), "{args:?}: no `{part}` in\n{text}");
    }
    text
}

/// Width and height of a PNG.
#[track_caller]
fn size(folder: &Path, name: &str) -> (u32, u32) {
    let bytes = std::fs::read(folder.join(name)).expect(name);
    let number = |at| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    (number(16), number(20))
}

fn pictures(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let names = entries.map(|e| e.expect("an entry").file_name());
    let names = names.map(|n| n.to_string_lossy().into_owned());
    let mut pictures: Vec<String> = names.filter(|n| n.ends_with(".png")).collect();
    pictures.sort();
    pictures
}

#[test]
fn every_command_reads_pov_scenes() {
    let folder = folder();
    let f = folder.path();
    succeeds(
        f,
        &["render", "scene.pov", "--size", "16x12", "-o", "a.png"],
    );
    assert_eq!(size(f, "a.png"), (16, 12));
    let info = strahl(f, &["info", "scene.pov"]);
    assert!(String::from_utf8_lossy(&info.stdout).contains("1 sphere"));
    let check = strahl(f, &["check", "scene.pov"]);
    assert!(check.status.success(), "{}", stderr(&check));
    let explain = strahl(f, &["explain", "scene.pov", "--pixel", "400,300"]);
    assert!(String::from_utf8_lossy(&explain.stdout).contains("scene.pov:5"));
    let formats = strahl(f, &["formats"]);
    assert!(String::from_utf8_lossy(&formats.stdout).contains(".pov"));
}

#[test]
fn a_scene_comes_from_the_standard_input() {
    let folder = folder();
    for args in [
        &[
            "render", "-", "--format", "pov", "-o", "a.png", "--size", "8x6",
        ][..],
        &["render", "+I-", "+Oa.png", "+W8", "+H6"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_strahl"))
            .current_dir(folder.path())
            .args(args)
            .stdin(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let mut stdin = child.stdin.take().expect("piped");
        stdin.write_all(SCENE.as_bytes()).expect("it reads");
        drop(stdin);
        assert!(child.wait().expect("it ends").success(), "{args:?}");
        assert_eq!(size(folder.path(), "a.png"), (8, 6));
        std::fs::remove_file(folder.path().join("a.png")).expect("it was there");
    }
}

#[test]
fn without_a_scene_there_is_a_demonstration() {
    let folder = folder();
    let said = succeeds(folder.path(), &["render", "--size", "32x24"]);
    assert_eq!(size(folder.path(), "demo.png"), (32, 24));
    assert!(!said.contains("warning"), "{said}");
}

#[test]
fn povray_switches_render() {
    let folder = folder();
    let f = folder.path();
    let line = "render +Iscene.pov +Ob.png +W20 +H10 +A0.3 +AM2 +R2 +Linc -D +Q9 +WT1 +FN16 -P +V";
    succeeds(f, &line.split(' ').collect::<Vec<_>>());
    assert_eq!(size(f, "b.png"), (20, 10));
    assert_eq!(
        std::fs::read(f.join("b.png")).expect("written")[24],
        16,
        "bits"
    );
    // A region within a picture of the full size.
    succeeds(f, &["render", "scene.pov", "+W20", "+H10", "+SC0.5", "+Oc"]);
    assert_eq!(size(f, "c.png"), (20, 10));
    fails(f, &["render", "scene.pov", "+Y3"], 2, &["+Y3", "--help"]);
    let noted = succeeds(f, &["render", "scene.pov", "+W8", "+H6", "+Q3", "+UA"]);
    assert!(
        noted.contains("quality 3") && !noted.contains("alpha"),
        "{noted}"
    );
    let bytes = std::fs::read(f.join("scene.png")).expect("written");
    assert_eq!(bytes[25], 6, "colours with alpha");
    fails(
        f,
        &["scene.pov", "--alpha", "-o", "a.jpg"],
        1,
        &[".png, .exr"],
    );
}

#[test]
fn ini_files_have_sections() {
    let folder = folder();
    let f = folder.path();
    let ini = "Input_File_Name=scene.pov ; the scene\n+W12 +H9\nDeclare=Unused=3\nAntialias=Off\n\
               [Small]\nWidth=4\nHeight=3\nOutput_File_Name=small.png\n[Broken]\nWidht=3\n";
    write(f, "run.ini", ini);
    succeeds(f, &["render", "run.ini"]);
    assert_eq!(size(f, "scene.png"), (12, 9));
    succeeds(f, &["render", "run.ini[small]"]);
    assert_eq!(size(f, "small.png"), (4, 3));
    // Later words override earlier ones.
    succeeds(f, &["render", "run[Small]", "+W5", "+Olater.png"]);
    assert_eq!(size(f, "later.png"), (5, 3));
    let parts = ["run.ini:10", "Widht", "`Width`"];
    fails(f, &["render", "run.ini[broken]"], 2, &parts);
    fails(
        f,
        &["render", "run.ini[none]"],
        2,
        &["[none]", "Small, Broken"],
    );
}

#[test]
fn declared_numbers_reach_the_scene() {
    let folder = folder();
    let f = folder.path();
    write(
        f,
        "d.pov",
        "#debug concat(\"R is \", str(R, 0, 2), \"\\n\") sphere { 0, R }",
    );
    for args in [["--declare", "R=1.25"], ["Declare=R=1.25", "-GA"]] {
        let all = [&["render", "d.pov", "--size", "8x6"][..], &args].concat();
        let said = succeeds(f, &all);
        assert!(said.contains("R is 1.25"), "{said}");
    }
    fails(f, &["render", "d.pov"], 1, &["`R`", "d.pov:1"]);
    fails(f, &["check", "d.pov", "--declare", "R=red"], 2, &["`red`"]);
}

#[test]
fn frames_are_numbered_and_timed() {
    let folder = folder();
    let f = folder.path();
    let small = ["render", "scene.pov", "+W8", "+H6", "-A"];
    let said = succeeds(f, &[&small[..], &["+KFF10", "+SF9"]].concat());
    assert_eq!(pictures(f), ["scene09.png", "scene10.png"]);
    for line in ["frame 9 of 10 clock 0.889", "frame 10 of 10 clock 1.000"] {
        assert!(said.contains(line), "{said}");
    }
    let said = succeeds(
        f,
        &[
            &small[..],
            &["+KFI3", "+KFF4", "+KC", "+KI2", "+KF4", "+Oc"],
        ]
        .concat(),
    );
    assert!(
        said.contains("frame 3 of 5 clock 2.000\nframe 4 of 5 clock 3.000"),
        "{said}"
    );
    assert_eq!(pictures(f)[..2], ["c3.png", "c4.png"]);
    // Without an animation, the frame numbers are zero.
    let said = succeeds(f, &[&small[..], &["+K0.5"]].concat());
    assert!(said.contains("frame 0 of 0 clock 0.500"), "{said}");
    write(f, "a.nff", "s 0 0 0 1\n");
    fails(f, &["render", "a.nff", "--final-frame", "3"], 1, &[".pov"]);
}

#[test]
fn resuming_keeps_complete_frames_only() {
    let folder = folder();
    let f = folder.path();
    let args = ["render", "scene.pov", "--size", "8x6", "--final-frame", "4"];
    succeeds(f, &args);
    let whole = std::fs::read(f.join("scene2.png")).expect("written");
    // A picture with other pixels shows whether it was kept: it is complete, but not what would be rendered.
    let other = std::fs::read(f.join("scene4.png")).expect("written");
    std::fs::write(f.join("scene1.png"), &other).expect("writable");
    std::fs::write(f.join("scene2.png"), &whole[..whole.len() - 20]).expect("writable");
    std::fs::remove_file(f.join("scene3.png")).expect("it was there");
    let said = succeeds(f, &[&args[..], &["--resume"]].concat());
    assert!(said.contains("2 were complete"), "{said}");
    assert!(
        !said.contains("frame 1 of") && said.contains("frame 3 of"),
        "{said}"
    );
    assert_eq!(std::fs::read(f.join("scene1.png")).expect("kept"), other);
    assert_eq!(std::fs::read(f.join("scene2.png")).expect("again"), whole);
    assert_eq!(pictures(f).len(), 4);
    // Pictures of another size don't belong to this animation.
    succeeds(
        f,
        &[
            "render",
            "scene.pov",
            "--size",
            "4x3",
            "--final-frame",
            "4",
            "--resume",
        ],
    );
    assert_eq!(size(f, "scene1.png"), (4, 3));
}

#[test]
fn an_error_shows_line_caret_and_trace() {
    let folder = folder();
    let f = folder.path();
    write(
        f,
        "shapes_of_mine.inc",
        "#macro Ball(R)\n  sphere { 0, Radius }\n#end\n",
    );
    write(f, "bad.pov", "#include \"shapes_of_mine.inc\"\nBall(1)\n");
    let text = fails(
        f,
        &["render", "bad.pov"],
        1,
        &[
            "`Radius`",
            "shapes_of_mine.inc:2:15",
            "2 |   sphere { 0, Radius }",
            "^^^^^^",
            "in macro `Ball`, called at bad.pov:2",
        ],
    );
    assert!(!f.join("bad.png").exists(), "{text}");
    fails(f, &["check", "bad.pov"], 1, &["in macro `Ball`"]);
    // The scene's last message must not hide the error.
    write(f, "said.pov", "#debug \"half a line\"\nbox { 1 }");
    fails(f, &["check", "said.pov"], 1, &["half a line\nerror: "]);
    fails(
        f,
        &["render", "shapes_of_mine.inc"],
        1,
        &["include file", ".pov"],
    );
}

#[test]
fn includes_are_searched_in_library_paths() {
    let folder = folder();
    let f = folder.path();
    std::fs::create_dir(f.join("lib")).expect("a folder");
    write(f, "lib/extra.inc", "#declare R = 1;");
    write(f, "e.pov", "#include \"extra.inc\" sphere { 0, R }");
    fails(f, &["check", "e.pov"], 1, &["extra.inc"]);
    for path in [&["-L", "lib"][..], &["-Llib"], &["--library-path", "lib"]] {
        succeeds(f, &[&["check", "e.pov"][..], path].concat());
    }
    succeeds(f, &["render", "+Ie.pov", "+Llib", "+W8", "+H6"]);
}

/// A scene that writes a file, reads it back, and contains a sphere with the radius it read.
fn writing(name: &str) -> String {
    format!(
        "#fopen F \"{name}\" write\n#write(F, \"#declare R = 1;\\n\")\n#fclose F\n#include \"{name}\"\nsphere {{ 0, R }}"
    )
}

#[test]
fn only_render_writes_files_of_scenes() {
    let folder = folder();
    let f = folder.path();
    write(f, "w.pov", &writing("a.inc"));
    for args in [
        &["check", "w.pov"][..],
        &["info", "w.pov"],
        &["explain", "w.pov", "--pixel", "1,1", "--size", "4x3"],
        &["trace-ray", "w.pov", "--pixel", "1,1", "--size", "4x3"],
        &["compare", "w.pov", "--size", "4x3", "--with", "bvh"],
        &["heatmap", "w.pov", "--size", "4x3", "-o", "heat.png"],
        &["check", "w.pov", "--allow-write", "."],
    ] {
        succeeds(f, args);
        assert!(
            !f.join("w.out").exists() && !f.join("a.inc").exists(),
            "{args:?}"
        );
    }
    // A scene may overwrite its own output of an earlier run.
    for _ in 0..2 {
        succeeds(f, &["render", "w.pov", "--size", "4x3"]);
        assert!(f.join("w.out/a.inc").exists() && !f.join("a.inc").exists());
    }
    succeeds(f, &["render", "w.pov", "--size", "4x3", "+KFF2"]);
}

#[test]
fn scenes_overwrite_nothing() {
    let folder = folder();
    let f = folder.path();
    for name in ["in", "allowed"] {
        std::fs::create_dir(f.join(name)).expect("a folder");
    }
    write(f, "in/inside.pov", &writing("a.txt"));
    let allowed = [
        "render",
        "in/inside.pov",
        "--size",
        "4x3",
        "--allow-write",
        "allowed",
    ];
    succeeds(f, &allowed);
    assert!(f.join("allowed/a.txt").exists() && !f.join("in/inside.out").exists());
    write(f, "allowed/a.txt", "mine");
    fails(f, &allowed, 1, &["a.txt", "no scene has written"]);
    assert_eq!(
        std::fs::read(f.join("allowed/a.txt")).expect("kept"),
        b"mine"
    );
    // The scene itself, hidden files and other folders are protected.
    for name in [
        "self.pov",
        "../b.txt",
        ".bashrc",
        "x/.git",
        "/tmp/strahl-was-here",
    ] {
        write(f, "self.pov", &writing(name));
        let args = ["render", "self.pov", "--size", "4x3", "--allow-write", "."];
        fails(f, &args, 1, &["may not write"]);
    }
    assert!(!f.join("b.txt").exists() && !f.join(".bashrc").exists());
    let args = ["render", "self.pov", "--allow-write", "nowhere"];
    fails(f, &args, 1, &["no folder nowhere"]);
    // A typing error on the command line must not overwrite the scene either.
    let args = ["render", "scene.pov", "--stats", "scene.pov"];
    fails(f, &args, 1, &["the scene itself"]);
    assert_eq!(
        std::fs::read(f.join("scene.pov")).expect("kept"),
        SCENE.as_bytes()
    );
}

#[cfg(unix)]
#[test]
fn a_link_does_not_lead_a_scene_out_of_its_folder() {
    let folder = folder();
    let f = folder.path();
    std::fs::create_dir(f.join("home")).expect("a folder");
    std::os::unix::fs::symlink(f.join("home"), f.join("w.out")).expect("a link");
    write(f, "w.pov", &writing("a.inc"));
    fails(
        f,
        &["render", "w.pov", "--size", "4x3"],
        1,
        &["may not write", "w.out"],
    );
    assert_eq!(
        std::fs::read_dir(f.join("home")).expect("a folder").count(),
        0
    );
}

#[test]
fn render_may_be_left_out() {
    let folder = folder();
    let f = folder.path();
    for (line, name) in [
        ("+Iscene.pov +W8 +H6", "scene.png"),
        ("scene.pov --size 8x6 -o a.png", "a.png"),
        ("scene +W8 +H6 +Ob", "b.png"),
        ("--strict +Iscene +W8 +H6 +Oc.png", "c.png"),
    ] {
        succeeds(f, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(size(f, name), (8, 6), "{line}");
    }
    write(
        f,
        "run.ini",
        "Input_File_Name=scene\nWidth=90\nHeight=60\nOutput_File_Name=x.png\nAntialias=on\n",
    );
    // Options of strahl override those of POV-Ray.
    succeeds(
        f,
        &[
            "run.ini",
            "--size",
            "8x6",
            "-o",
            "d.png",
            "--sampling",
            "center",
        ],
    );
    assert_eq!(size(f, "d.png"), (8, 6));
    succeeds(f, &["run", "+W10"]);
    assert_eq!(size(f, "x.png"), (10, 60));
    let version = strahl(f, &["render", "-V"]);
    assert!(String::from_utf8_lossy(&version.stdout).starts_with("strahl "));
    fails(f, &["rendr", "scene.pov"], 2, &["unrecognized", "render"]);
}

#[test]
fn pictures_of_povs_types_are_written() {
    let folder = folder();
    let f = folder.path();
    for (switch, name, magic) in [
        ("+FB", "scene.bmp", &b"BM"[..]),
        ("+FJ", "scene.jpg", &[0xff, 0xd8, 0xff]),
        ("+FP", "scene.ppm", b"P6"),
        ("+FT", "scene.tga", &[0, 0, 10]),
        ("+FE", "scene.exr", &[0x76, 0x2f, 0x31, 1]),
    ] {
        succeeds(f, &["+Iscene.pov", "+W8", "+H6", switch]);
        let bytes = std::fs::read(f.join(name)).expect(name);
        assert!(bytes.starts_with(magic), "{name}");
    }
    let output = strahl(f, &["+Iscene.pov", "+W8", "+H6", "+O-", "+FP", "-GA"]);
    assert!(output.stdout.starts_with(b"P6"), "{}", stderr(&output));
    let output = strahl(
        f,
        &["scene.pov", "--size", "8x6", "-o", "-", "--stats", "s.json"],
    );
    assert!(output.stdout.starts_with(b"\x89PNG"), "{}", stderr(&output));
    assert!(f.join("s.json").exists() && !f.join("-").exists());
    let output = strahl(f, &["scene.pov", "--size", "8x6", "--stats", "-", "-q"]);
    assert!(output.stdout.starts_with(b"{"), "{}", stderr(&output));
    std::fs::create_dir(f.join("out")).expect("a folder");
    succeeds(
        f,
        &[
            "scene.pov",
            "--size",
            "8x6",
            "-o",
            "out/",
            "--picture-format",
            "jpg",
        ],
    );
    assert!(f.join("out/scene.jpg").exists());
    let help = ["scene.pov", "-o", "a", "--picture-format", "gif"];
    fails(f, &help, 2, &["png", "jpg", "tga"]);
}

#[test]
fn a_header_is_included_before_the_scene() {
    let folder = folder();
    let f = folder.path();
    write(f, "head.inc", "#declare R = 2; #debug \"header\\n\"");
    write(
        f,
        "h.pov",
        "#debug concat(\"R \", str(R, 0, 0), \"\\n\") sphere { 0, R }",
    );
    for args in [
        &["+Ih.pov", "+HIhead.inc", "+W4", "+H3"][..],
        &["check", "h.pov", "--include", "head.inc"],
    ] {
        let said = succeeds(f, args);
        assert!(said.contains("header\nR 2\n"), "{said}");
    }
    fails(
        f,
        &["check", "h.pov", "--include", "none.inc"],
        1,
        &["none.inc"],
    );
}

#[test]
fn what_is_left_out_is_noted() {
    let folder = folder();
    let f = folder.path();
    let said = succeeds(
        f,
        &[
            "+Iscene.pov",
            "+W4",
            "+H3",
            "+GDlog.txt",
            "Dither=on",
            "Field_Render=on",
        ],
    );
    for part in ["not written to files", "not dithered", "fields"] {
        assert!(said.contains(part), "{said}");
    }
    assert!(!f.join("log.txt").exists());
    fails(
        f,
        &["+Iscene.pov", "+W4", "+H3", "Dither=on", "--strict"],
        3,
        &["--strict"],
    );
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_whole_frames() {
    let folder = folder();
    let f = folder.path();
    let child = Command::new(env!("CARGO_BIN_EXE_strahl"))
        .current_dir(f)
        .args(["render", "scene.pov", "+W160", "+H120", "+KFF900", "-GA"])
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let start = std::time::Instant::now();
    while !f.join("scene002.png").exists() && start.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let pid = child.id().to_string();
    let killed = Command::new("kill").args(["-INT", &pid]).status();
    assert!(killed.expect("kill runs").success(), "it ended too early");
    let output = child.wait_with_output().expect("it ends");
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{said}");
    let names = pictures(f);
    let text = format!(
        "interrupted; {} of 900 frames are complete; --resume",
        names.len()
    );
    assert!(said.contains(&text), "no `{text}` in\n{said}");
    for name in &names {
        let bytes = std::fs::read(f.join(name)).expect("a picture");
        assert!(bytes[bytes.len() - 8..].starts_with(b"IEND"), "{name}");
    }
    // Only the scene and its pictures, no partial files.
    let files = std::fs::read_dir(f).expect("a folder").count();
    assert_eq!(files, names.len() + 1);
}

/// The output of the program until it ends after Ctrl-C, and the seconds that takes.
#[cfg(unix)]
fn interrupted(folder: &Path, args: &[&str]) -> (String, f64) {
    let child = Command::new(env!("CARGO_BIN_EXE_strahl"))
        .current_dir(folder)
        .args(args)
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let pid = child.id().to_string();
    let start = std::time::Instant::now();
    let killed = Command::new("kill").args(["-INT", &pid]).status();
    assert!(killed.expect("kill runs").success(), "it ended too early");
    let output = child.wait_with_output().expect("it ends");
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{args:?}: {said}");
    (said, start.elapsed().as_secs_f64())
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_middle_of_something_long() {
    let folder = folder();
    let f = folder.path();
    write(
        f,
        "loop.pov",
        "#declare I = 0; #while (I < 1e12) #declare I = I + 1; #end sphere { 0, 1 }",
    );
    // Two mirrors that face each other: ray trees of ten thousand levels, with a thousand shadow rays at each hit.
    let mirrors = "camera { location 0 look_at z } global_settings { adc_bailout 0 }\n\
                   light_source { y/2 rgb 1 area_light x, z, 32, 32 }\n\
                   plane { z, 1 pigment { rgb 1 } finish { reflection 1 } } plane { z, -1 pigment { rgb 1 } finish { reflection 1 } }";
    write(f, "mirrors.pov", mirrors);
    for args in [
        &[
            "check",
            "loop.pov",
            "--limit",
            "steps=1e17",
            "--limit",
            "idle_steps=1e17",
        ][..],
        &[
            "render",
            "loop.pov",
            "--limit",
            "steps=1e17",
            "--limit",
            "idle_steps=1e17",
        ],
        &[
            "render",
            "mirrors.pov",
            "--size",
            "2x2",
            "--max-depth",
            "10000",
            "--max-tree-rays",
            "4000000000",
        ],
    ] {
        let (said, seconds) = interrupted(f, args);
        assert!(said.contains("interrupted"), "{args:?}: {said}");
        // One second, plus the delays of a busy machine.
        assert!(seconds < 3.0, "{args:?}: {seconds} s");
    }
    assert!(pictures(f).is_empty());
}
