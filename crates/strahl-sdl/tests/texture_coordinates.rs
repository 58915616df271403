//! Textures with `uv_mapping`: one pixel of each scene of `data/texture_coordinates.tsv`, which has the values of POV-Ray 3.7.

use crate::groups;

groups! {
    include_str!("data/texture_coordinates.tsv");
    surfaces_with_coordinates_of_their_own,
    other_surfaces_are_mapped_by_x_and_y_of_the_world,
    normals_by_texture_coordinates_are_tilted_in_the_world,
    a_texture_with_uv_mapping_tilts_normals_in_its_own_space,
    boxes_without_thickness_show_the_face_turned_away,
    boxes_are_not_mirrored_with_their_textures,
    uv_mapping_of_an_object_is_that_of_its_parts,
    uv_mapping_is_a_texture_pigment_or_normal_of_its_own,
}
