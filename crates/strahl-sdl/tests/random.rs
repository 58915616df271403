//! What random scenes (`cargo xtask differ`) have found: one pixel of each scene of `data/random.tsv`, which has the values of POV-Ray 3.7.

mod common;

groups! {
    include_str!("data/random.tsv");
    a_layer_vanishes_below_adc_bailout,
    light_from_behind_ends_where_its_grey_value_is_below_adc_bailout,
    the_reflection_of_a_lower_layer_weighs_the_grey_value_of_what_passes,
    numbers_of_blocks_are_not_repeated,
    image_pattern_ignores_phase_without_frequency,
    a_replaced_block_pattern_leaves_frequency_0,
    a_normal_keeps_the_map_of_the_pattern_it_replaces,
    the_inverse_of_a_clipped_object_is_clipped,
    a_bump_map_lies_on_the_surface,
    interpolate_3_is_bicubic,
    interpolation_ends_at_the_edges_of_once,
    normal_of_a_panoramic_camera,
    maps_may_fall,
    layers_with_different_weights_have_rays_of_their_own,
    aoi_and_slope_see_the_normal_evaluated_last,
    slope_begins_again_beside_its_ranges,
    a_blob_below_its_threshold_is_nothing_and_its_inverse_everything,
    angles_on_their_axis,
    water_does_not_rise_above_a_height_field,
    triangles_have_fronts,
    parts_have_the_interior_texture_of_the_whole,
    components_of_blobs_keep_their_textures,
    default_pigments_are_those_of_objects,
    a_repeated_black_hole_lies_in_its_block,
    beside_a_single_bump_map_are_its_other_edges,
    inverse_objects_end_with_their_boxes,
    light_through_one_of_blended_textures_weighs_all_that_passes_it,
    nothing_is_seen_with_an_adc_bailout_of_1,
    radial_with_frequency_0_goes_beyond_1,
    parts_of_unions_that_are_not_split_are_not_hidden,
    height_fields_end_with_their_lowest_point,
    parallel_light_fades_by_its_distance_from_its_plane,
}
