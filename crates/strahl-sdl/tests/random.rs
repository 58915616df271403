//! What random scenes (`cargo xtask differ`) have found: one pixel of each scene of `data/random.tsv`, which has the values of POV-Ray 3.7.

mod common;

use common::pixel;

/// Described at [`pixel::agree`].
const CASES: &str = include_str!("data/random.tsv");

#[test]
fn a_layer_vanishes_below_adc_bailout() {
    pixel::agree(CASES, "a_layer_vanishes_below_adc_bailout");
}

#[test]
fn light_from_behind_ends_where_its_grey_value_is_below_adc_bailout() {
    pixel::agree(
        CASES,
        "light_from_behind_ends_where_its_grey_value_is_below_adc_bailout",
    );
}

#[test]
fn the_reflection_of_a_lower_layer_weighs_the_grey_value_of_what_passes() {
    pixel::agree(
        CASES,
        "the_reflection_of_a_lower_layer_weighs_the_grey_value_of_what_passes",
    );
}

#[test]
fn numbers_of_blocks_are_not_repeated() {
    pixel::agree(CASES, "numbers_of_blocks_are_not_repeated");
}

#[test]
fn image_pattern_ignores_phase_without_frequency() {
    pixel::agree(CASES, "image_pattern_ignores_phase_without_frequency");
}

#[test]
fn a_replaced_block_pattern_leaves_frequency_0() {
    pixel::agree(CASES, "a_replaced_block_pattern_leaves_frequency_0");
}

#[test]
fn a_normal_keeps_the_map_of_the_pattern_it_replaces() {
    pixel::agree(CASES, "a_normal_keeps_the_map_of_the_pattern_it_replaces");
}

#[test]
fn the_inverse_of_a_clipped_object_is_clipped() {
    pixel::agree(CASES, "the_inverse_of_a_clipped_object_is_clipped");
}

#[test]
fn a_bump_map_lies_on_the_surface() {
    pixel::agree(CASES, "a_bump_map_lies_on_the_surface");
}

#[test]
fn interpolate_3_is_bicubic() {
    pixel::agree(CASES, "interpolate_3_is_bicubic");
}

#[test]
fn interpolation_ends_at_the_edges_of_once() {
    pixel::agree(CASES, "interpolation_ends_at_the_edges_of_once");
}

#[test]
fn normal_of_a_panoramic_camera() {
    pixel::agree(CASES, "normal_of_a_panoramic_camera");
}
