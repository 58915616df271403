//! Reading scenes: the standard input, includes, declared numbers and errors.

use super::common::{stderr, strahl};
use super::{SCENE, fails, folder, size, succeeds, write};
use std::io::Write;
use std::process::{Command, Stdio};

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
fn scenes_of_switches_have_any_ending() {
    let folder = folder();
    let f = folder.path();
    for (name, picture) in [
        ("noext", "noext.png"),
        ("weird.txt", "weird.png"),
        ("head.inc", "head.png"),
    ] {
        write(f, name, SCENE);
        succeeds(f, &[&format!("+I{name}"), "+W4", "+H3"]);
        assert_eq!(size(f, picture), (4, 3));
    }
    write(f, "run.ini", "Input_File_Name=weird.txt\n+W5 +H3\n");
    succeeds(f, &["run.ini"]);
    assert_eq!(size(f, "weird.png"), (5, 3));
    // Without the switch the name must tell the format.
    fails(f, &["weird.txt", "+W4", "+H3"], 1, &["weird.txt"]);
    fails(f, &["+Inone", "+W4", "+H3"], 1, &["none.pov"]);
}

#[test]
fn without_a_scene_there_is_a_demonstration() {
    let folder = folder();
    let said = succeeds(folder.path(), &["render", "--size", "32x24"]);
    assert_eq!(size(folder.path(), "demo.png"), (32, 24));
    assert!(!said.contains("warning"), "{said}");
    write(folder.path(), "size.ini", "Width=8\n");
    for words in [&["size.ini"][..], &["+W8", "+H6"], &["render", "Width=8"]] {
        fails(folder.path(), words, 2, &["no scene", "+Iscene.pov"]);
    }
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
