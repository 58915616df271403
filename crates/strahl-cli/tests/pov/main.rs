//! Scenes in POV-Ray's language, and POV-Ray's command lines.

mod animations;
#[path = "../common/mod.rs"]
mod common;
mod interrupts;
mod reading;
mod switches;
mod writing;

use common::{stderr, strahl};
use std::path::Path;

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
