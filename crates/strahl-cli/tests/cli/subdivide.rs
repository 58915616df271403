//! `--subdivide`: the meshes of files as the surfaces that they control.

use super::explain::json;
use super::{fails, stderr, strahl};
use serde_json::Value;
use std::path::Path;

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
const OCTAHEDRON: &str = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n\
    f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

/// The same object in POV-Ray's language.
fn described(scheme: &str, file: &str) -> String {
    let mut text = format!(
        "#declare Thing = subdivision {{ {}\n",
        scheme.replace('-', "_")
    );
    for line in file.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let numbers = words[1..].join(", ");
        text += &match words[0] {
            "v" => format!("points {{ <{numbers}> }}\n"),
            _ => format!(
                "face {{ {} }}\n",
                words[1..]
                    .iter()
                    .map(|n| format!("{n} - 1"))
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
        };
    }
    text + "}\n"
}

/// What the program prints.
fn printed(folder: &Path, args: &[&str]) -> String {
    let output = strahl(folder, args);
    assert!(output.status.success(), "{args:?}: {}", stderr(&output));
    String::from_utf8_lossy(&output.stdout).into_owned() + &stderr(&output)
}

fn picture(folder: &Path, args: &[&str]) -> Vec<u8> {
    let all = [
        "render",
        "thing.obj",
        "--size",
        "40x30",
        "-o",
        "out.ppm",
        "--quiet",
    ];
    printed(folder, &[&all, args].concat());
    std::fs::read(folder.join("out.ppm")).expect("written")
}

#[test]
fn files_are_shown_as_the_surfaces_of_the_language() {
    for (scheme, file) in [("catmull-clark", CUBE), ("loop", OCTAHEDRON)] {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("thing.obj"), file).expect("writable");
        let switch = ["--subdivide", scheme];
        let (plain, smooth) = (picture(folder.path(), &[]), picture(folder.path(), &switch));
        assert_eq!(plain.len(), smooth.len());
        let other = plain.iter().zip(&smooth).filter(|(a, b)| a != b).count();
        assert!(other > 200, "{scheme}: {other} bytes differ");
        let info = printed(
            folder.path(),
            &[&["info", "thing.obj"], &switch[..]].concat(),
        );
        assert!(info.contains("1 subdivision"), "{info}");
        assert!(!printed(folder.path(), &["info", "thing.obj"]).contains("subdivision"));

        // The rays of some pixels meet the object of the language at the same points.
        let mut text = format!("#version 3.7;\n{}", described(scheme, file));
        let mut expected = vec![];
        for pixel in ["20,15", "18,14", "23,13", "19,18"] {
            let args = [
                "thing.obj",
                "--size",
                "40x30",
                "--sampling",
                "center",
                "--pixel",
                pixel,
            ];
            let tree = json(folder.path(), &[&args, &switch[..]].concat());
            let ray = &tree["samples"][0]["rays"][0];
            let (ray, hit) = (&ray["ray"], &ray["hit"]);
            assert_eq!(hit["object"], "subdivision \"thing.obj\"", "{pixel}");
            let vector = |v: &Value| [0, 1, 2].map(|i| v[i].as_f64().expect("a number"));
            let [from, along] = ["origin", "direction"].map(|key| vector(&ray[key]));
            let ([a, b, c], [d, e, f]) = (from, along);
            text += &format!(
                "#debug concat(\"met \", vstr(3, trace(Thing, <{a}, {b}, {c}>, <{d}, {e}, {f}>), \" \", 0, 12), \"\\n\")\n"
            );
            expected.push(vector(&hit["position"]));
        }
        text += "sphere { 0, 1 }\n";
        std::fs::write(folder.path().join("asked.pov"), text).expect("writable");
        let said = printed(folder.path(), &["check", "asked.pov"]);
        let found: Vec<Vec<f64>> = said
            .lines()
            .filter_map(|line| line.strip_prefix("met "))
            .map(|line| {
                line.split(' ')
                    .map(|w| w.parse().expect("a number"))
                    .collect()
            })
            .collect();
        assert_eq!(found.len(), expected.len(), "{said}");
        for (found, expected) in found.iter().zip(&expected) {
            let is_near = found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(is_near, "{scheme}: {found:?} {expected:?}");
        }
    }
}

#[test]
fn what_cannot_be_subdivided_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("thing.obj"), CUBE).expect("writable");
    std::fs::write(folder.path().join("scene.pov"), "sphere { 0, 1 }").expect("writable");
    let args = |file, scheme| ["render", file, "-o", "out.png", "--subdivide", scheme];
    let schemes = "the schemes are `catmull-clark` and `loop`";
    fails(
        folder.path(),
        &args("thing.obj", "loops"),
        2,
        &["'loops'", "--subdivide", schemes],
    );
    fails(
        folder.path(),
        &args("thing.obj", "catmull_clark"),
        2,
        &[schemes],
    );
    let angle = "`200` is not an angle from 0 to 180 degrees";
    fails(
        folder.path(),
        &args("thing.obj", "loop:crease=200"),
        2,
        &[angle],
    );
    let language = ["`scene.pov` is in POV-Ray's language", "`subdivision { }`"];
    fails(folder.path(), &args("scene.pov", "loop"), 1, &language);
}
