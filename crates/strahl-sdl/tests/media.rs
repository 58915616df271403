//! The media that rays are in, and their absorption: one pixel of each scene of `data/media.tsv`, which has the values of POV-Ray
//! 3.7.

use crate::groups;

groups! {
    include_str!("data/media.tsv");
    the_eye_is_in_all_that_contains_it,
    media_are_entered_and_left_by_turns,
    a_cut_with_a_medium_of_its_own_begins_there,
    interiors_fade_where_they_are_left,
    fog_is_in_what_is_hollow,
    parts_are_covered_by_the_whole_and_filled_by_themselves,
    old_finishes_refract,
    old_filters_leave_colour,
    lights_shine_from_surfaces,
    flat_boxes_are_sheets,
    films_interfere,
    glass_in_something_reflects_only_where_it_is_entered,
}
