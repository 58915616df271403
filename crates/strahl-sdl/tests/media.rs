//! The media that rays are in, and their absorption: one pixel of each scene of `data/media.tsv`, which has the values of POV-Ray
//! 3.7.

mod common;

use common::parse_with;
use strahl_render::{CompileOptions, RenderOptions, compile, render};
use strahl_sdl::MemoryHost;

/// Group, case, the values of POV-Ray 3.7.0.10 (linear red, green and blue), and the scene.
const CASES: &str = include_str!("data/media.tsv");

/// Colours that encode directions change by this much if a direction changes by a thousandth.
const TOLERANCE: f64 = 1e-3;

fn shown(scene: &str) -> [f64; 3] {
    let parsed = parse_with(&mut MemoryHost::new(), scene);
    let scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{:?}", parsed.diagnostics));
    let scene = compile(&scene, &CompileOptions::default()).expect("a valid scene");
    let mut options = RenderOptions::new(&scene, 1, 1);
    options.threads = 1;
    let film = render(&scene, &options, &()).expect("a picture").film;
    film.pixels[0].map(|c| f64::from(c).clamp(0.0, 1.0))
}

fn agree(group: &str) {
    let mut wrong = vec![];
    let mut count = 0;
    for row in CASES.lines().skip(1) {
        let fields: Vec<&str> = row.split('\t').collect();
        let [of, case, red, green, blue, scene] = fields[..] else {
            panic!("six fields: {row}");
        };
        if of != group {
            continue;
        }
        count += 1;
        let theirs = [red, green, blue].map(|c| c.parse::<f64>().expect("a number"));
        let ours = shown(scene);
        if ours
            .iter()
            .zip(theirs)
            .any(|(a, b)| (a - b).abs() > TOLERANCE)
        {
            wrong.push(format!("{case}: {ours:.4?} is not {theirs:.4?}: {scene}"));
        }
    }
    assert!(count > 0, "no case of {group}");
    assert!(
        wrong.is_empty(),
        "{} of {count}:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn the_eye_is_in_all_that_contains_it() {
    agree("the_eye_is_in_all_that_contains_it");
}

#[test]
fn media_are_entered_and_left_by_turns() {
    agree("media_are_entered_and_left_by_turns");
}

#[test]
fn a_cut_with_a_medium_of_its_own_begins_there() {
    agree("a_cut_with_a_medium_of_its_own_begins_there");
}

#[test]
fn interiors_fade_where_they_are_left() {
    agree("interiors_fade_where_they_are_left");
}

#[test]
fn fog_is_in_what_is_hollow() {
    agree("fog_is_in_what_is_hollow");
}

#[test]
fn parts_are_covered_by_the_whole_and_filled_by_themselves() {
    agree("parts_are_covered_by_the_whole_and_filled_by_themselves");
}

#[test]
fn old_finishes_refract() {
    agree("old_finishes_refract");
}

#[test]
fn old_filters_leave_colour() {
    agree("old_filters_leave_colour");
}

#[test]
fn lights_shine_from_surfaces() {
    agree("lights_shine_from_surfaces");
}

#[test]
fn flat_boxes_are_sheets() {
    agree("flat_boxes_are_sheets");
}
