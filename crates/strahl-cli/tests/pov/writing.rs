//! The files that scenes may and may not write.

use super::{SCENE, fails, folder, succeeds, write};

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
