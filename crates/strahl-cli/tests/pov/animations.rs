//! Animations: frames, clocks, and `--resume`.

use super::{fails, folder, pictures, size, succeeds, write};

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
