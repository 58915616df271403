//! The media that rays are in, and their absorption: one pixel of each scene of `data/media.tsv`, which has the values of POV-Ray
//! 3.7.

mod common;

use common::pixel;

/// Described at [`pixel::agree`].
const CASES: &str = include_str!("data/media.tsv");

fn agree(group: &str) {
    pixel::agree(CASES, group);
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

#[test]
fn films_interfere() {
    agree("films_interfere");
}
