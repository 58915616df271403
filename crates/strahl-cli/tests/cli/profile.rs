//! `strahl render --profile`.

use super::{fails, folder_with_scene};
use crate::common::{stderr, strahl};
use serde_json::Value;

const RENDER: [&str; 4] = ["render", "scene.nff", "-o", "out.png"];

#[test]
fn a_table_tells_what_the_time_went_into() {
    let folder = folder_with_scene();
    let args = [&RENDER[..], &["--size", "400x300", "--profile"]].concat();
    let output = strahl(folder.path(), &args);
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("profile of scene.nff: reading "), "{said}");
    // By phase, ray, object and light; the object with its line.
    for part in [
        "by phase",
        "by ray",
        "by object",
        "shadow rays",
        "scene.nff:",
    ] {
        assert!(said.contains(part), "no {part}: {said}");
    }
    assert!(folder.path().join("out.png").is_file());
}

#[test]
fn the_file_has_the_same_as_json_and_the_picture_is_the_same() {
    let folder = folder_with_scene();
    let f = folder.path();
    let args = [&RENDER[..], &["--size", "400x300", "-q"]].concat();
    assert!(strahl(f, &args).status.success());
    let picture = std::fs::read(f.join("out.png")).expect("written");
    let output = strahl(f, &[&args[..], &["--profile=p.json"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(output.stderr.is_empty(), "{}", stderr(&output));
    assert_eq!(std::fs::read(f.join("out.png")).expect("written"), picture);
    let json: Value =
        serde_json::from_slice(&std::fs::read(f.join("p.json")).expect("written")).expect("JSON");
    assert_eq!(json["scene"], "scene.nff");
    assert!(json["time_s"]["trace"].as_f64().is_some_and(|t| t > 0.0));
    let samples = json["samples"].as_u64().expect("a number");
    let phases = json["phases"].as_array().expect("a list");
    let each = phases.iter().map(|part| part["samples"].as_u64().unwrap());
    assert_eq!(each.sum::<u64>(), samples);
    for list in ["rays", "primitives", "objects", "textures", "lights"] {
        assert!(json[list].is_array(), "{list}");
    }
}

#[test]
fn a_profile_has_one_picture_and_an_output_of_its_own() {
    let folder = folder_with_scene();
    let f = folder.path();
    std::fs::write(f.join("a.pov"), "sphere { clock, 1 }").expect("writable");
    let animated = ["render", "a.pov", "+KFF3", "--profile"];
    fails(f, &animated, 1, &["--profile works for a single picture"]);
    let both = [
        "render",
        "scene.nff",
        "--stats",
        "-",
        "--profile=-",
        "-o",
        "o.png",
    ];
    fails(f, &both, 1, &["statistics and profile can't both"]);
    let picture = ["render", "scene.nff", "-o", "-", "--profile=-"];
    fails(f, &picture, 1, &["can't both go to the standard output"]);
    let over = ["render", "scene.nff", "-o", "o.png", "--profile=scene.nff"];
    fails(f, &over, 1, &["is the scene itself"]);
    let nowhere = [
        "render",
        "scene.nff",
        "-o",
        "o.png",
        "--profile=missing/p.json",
    ];
    fails(f, &nowhere, 1, &["missing"]);
}

#[test]
fn a_switch_or_a_scene_may_follow() {
    let folder = folder_with_scene();
    let f = folder.path();
    std::fs::write(f.join("a.pov"), "sphere { 0, 1 }").expect("writable");
    for args in [
        &["render", "a.pov", "+W8", "+H6", "--profile", "+A0.3"][..],
        &["render", "+W8", "+H6", "--profile", "-L", ".", "a.pov"],
        &["render", "+W8", "+H6", "--profile", "a.pov"],
    ] {
        let output = strahl(f, args);
        let said = stderr(&output);
        assert!(output.status.success(), "{args:?}: {said}");
        assert!(said.contains("profile of a.pov: reading "), "{said}");
    }
}
