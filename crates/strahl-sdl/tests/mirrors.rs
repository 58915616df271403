//! The directions of reflection and transparency rays, and when they are cut: one pixel of each scene of `data/mirrors.tsv`, which has the
//! values of POV-Ray 3.7.

mod common;

use common::pixel;

/// Described at [`pixel::agree`].
const CASES: &str = include_str!("data/mirrors.tsv");

fn agree(group: &str) {
    pixel::agree(CASES, group);
}

#[test]
fn an_interpolated_normal_is_turned_to_the_viewer() {
    agree("an_interpolated_normal_is_turned_to_the_viewer");
}

#[test]
fn a_tilted_normal_reflects_to_the_side_of_the_viewer() {
    agree("a_tilted_normal_reflects_to_the_side_of_the_viewer");
}

#[test]
fn total_reflection_fades_and_weighs_like_light_that_passes() {
    agree("total_reflection_fades_and_weighs_like_light_that_passes");
}

#[test]
fn reflection_weighs_its_maximum_over_the_angles() {
    agree("reflection_weighs_its_maximum_over_the_angles");
}

#[test]
fn reflectance_of_a_normal_that_faces_away() {
    agree("reflectance_of_a_normal_that_faces_away");
}
