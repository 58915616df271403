//! POV-Ray's switches and .ini files.

use super::common::{stderr, strahl};
use super::{fails, folder, pictures, size, succeeds, write};

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
    let noted = succeeds(f, &["render", "scene.pov", "+W8", "+H6", "+UA"]);
    assert!(!noted.contains("alpha"), "{noted}");
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
    let said = succeeds(f, &["render", "run.ini[none]"]);
    assert!(said.contains("no section [none]") && said.contains("Small, Broken"));
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
        "Input_File_Name=scene\nWidth=90\nHeight=60.93\nOutput_File_Name=x.png\nAntialias=on\n",
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
        ("+FT", "scene.tga", &[0, 0, 2]),
        ("+FE", "scene.exr", &[0x76, 0x2f, 0x31, 1]),
    ] {
        succeeds(f, &["+Iscene.pov", "+W8", "+H6", switch]);
        let bytes = std::fs::read(f.join(name)).expect(name);
        assert!(bytes.starts_with(magic), "{name}");
    }
    succeeds(f, &["+Iscene.pov", "+W8", "+H6", "+FNG", "+Ogrey"]);
    let bytes = std::fs::read(f.join("grey.png")).expect("written");
    assert_eq!(bytes[24..26], [16, 0], "bits, grey");
    let parts = ["--grayscale", ".png, .ppm"];
    let words = ["+Iscene.pov", "+W8", "+H6", "Grayscale_Output=on", "+FJ"];
    fails(f, &words, 1, &parts);
    let output = strahl(f, &["+Iscene.pov", "+W8", "+H6", "+O-", "+FP", "-GA"]);
    assert!(output.stdout.starts_with(b"P6"), "{}", stderr(&output));
    let output = strahl(f, &["+Iscene.pov", "+W8", "+H6", "+Ostdout"]);
    assert!(output.stdout.starts_with(b"\x89PNG"), "{}", stderr(&output));
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
fn pictures_lie_beside_their_scenes() {
    let folder = folder();
    let f = folder.path();
    std::fs::create_dir(f.join("scenes")).expect("a folder");
    std::fs::rename(f.join("scene.pov"), f.join("scenes/a.pov")).expect("renamed");
    write(f, "run.ini", "Input_File_Name=scenes/a.pov\n+W4 +H3\n");
    let absolute = format!("+I{}", f.join("scenes/a.pov").display());
    for words in [
        &["+Iscenes/a.pov", "+W4", "+H3"][..],
        &[&absolute, "+W4", "+H3"],
        &["run.ini"],
    ] {
        succeeds(f, words);
        assert_eq!(size(f, "scenes/a.png"), (4, 3), "{words:?}");
        std::fs::remove_file(f.join("scenes/a.png")).expect("it was there");
    }
    succeeds(f, &["run.ini", "+KFF2"]);
    assert_eq!(pictures(&f.join("scenes")), ["a1.png", "a2.png"]);
    // strahl's own options decide about the rest of the name.
    succeeds(f, &["run.ini", "--picture-format", "jpg"]);
    assert!(f.join("scenes/a.jpg").exists());
    assert!(pictures(f).is_empty());
    succeeds(f, &["run.ini", "+O./"]);
    succeeds(f, &["run.ini", "-o", "b.png"]);
    assert_eq!(pictures(f), ["a.png", "b.png"]);
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
    // Settings of old povray.ini files.
    write(
        f,
        "old.ini",
        "Histogram_Type=CSV\nHistogram_Name=h.csv\nHistogram_Grid_Size=4.3\nCreate_Histogram=on\n+W4 +H3\n",
    );
    let words = ["old.ini", "+Iscene.pov", "+B", "-B", "+B100", "-RTR"];
    let said = succeeds(f, &words);
    assert_eq!(said.matches("histograms are not written").count(), 1);
    assert!(!said.contains("real time"), "{said}");
    for word in ["+RTR", "Real_Time_Raytracing=on"] {
        let said = succeeds(f, &["+Iscene.pov", "+W4", "+H3", word]);
        assert!(said.contains("real time"), "{said}");
    }
    fails(
        f,
        &["+Iscene.pov", "+W4", "+H3", "Dither=on", "--strict"],
        3,
        &["--strict"],
    );
}

#[test]
fn quality_is_a_switch_and_an_option() {
    let folder = folder();
    let f = folder.path();
    let text = "sphere { 0, 1 pigment { rgb 1 quick_color rgb <1, 0, 0> } finish { reflection 0.3 } }\n\
                light_source { <3, 4, -5>, 1 } camera { location -3*z } background { rgb <0, 0, 1> }\n";
    write(f, "quick.pov", text);
    let picture = |name: &str, words: &[&str]| {
        let output = format!("{name}.ppm");
        let start = ["render", "quick.pov", "+W8", "+H6", "-A", "-o", &output];
        let printed = succeeds(f, &[&start, words].concat());
        assert!(!printed.contains("quality"), "{printed}");
        std::fs::read(f.join(&output)).expect("written")
    };
    let full = picture("full", &[]);
    for (name, words) in [
        ("nine", ["+Q9"]),
        ("eleven", ["+Q11"]),
        ("ten", ["--quality=10"]),
    ] {
        assert_eq!(picture(name, &words), full);
    }
    let five = picture("five", &["+Q5"]);
    assert_ne!(five, full);
    for (name, words) in [
        ("minus", ["-Q5"]),
        ("key", ["Quality=5"]),
        ("option", ["--quality=5"]),
    ] {
        assert_eq!(picture(name, &words), five);
    }
    // strahl's own option overrides the switch.
    assert_eq!(picture("both", &["+Q2", "--quality", "5"]), five);
    // The colour itself in the middle, the background at the edge.
    let flat = picture("flat", &["+Q0"]);
    let pixel = |x: usize, y: usize| flat[flat.len() - 144 + (8 * y + x) * 3..][..3].to_vec();
    assert_eq!(
        (pixel(4, 3), pixel(0, 0)),
        (vec![255, 0, 0], vec![0, 0, 255])
    );
    let told = [
        "explain",
        "quick.pov",
        "--size",
        "8x6",
        "--pixel",
        "4,3",
        "--quality",
        "0",
    ];
    let told = String::from_utf8_lossy(&strahl(f, &told).stdout).into_owned();
    assert!(
        told.contains("(255, 0, 0)") && told.contains("quality 0 leaves out: light, shadows"),
        "{told}"
    );
    assert_eq!(picture("twelve", &["+Q12"]), full);
    for bad in ["+Qx", "+Q", "Quality=-1"] {
        fails(
            f,
            &["render", "quick.pov", bad],
            2,
            &["Quality: expected a whole number from 0"],
        );
    }
    fails(
        f,
        &["render", "quick.pov", "--quality", "12"],
        2,
        &["expected a quality from 0 to 11, found `12`"],
    );
}

#[test]
fn numbers_end_where_povray_ends_them() {
    let folder = folder();
    let f = folder.path();
    let words = ["+Iscene.pov", "+W8", "+H6", "Clock=1/2", "Quality=9x"];
    let said = succeeds(f, &words);
    for part in ["clock 1.000", "`1/2` is read as 1", "`9x` is read as 9"] {
        assert!(said.contains(part), "no `{part}` in {said}");
    }
}
