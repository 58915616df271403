//! The directions of reflection and transparency rays, and when they are cut: one pixel of each scene of `data/mirrors.tsv`, which has the
//! values of POV-Ray 3.7.

use crate::groups;

groups! {
    include_str!("data/mirrors.tsv");
    an_interpolated_normal_is_turned_to_the_viewer,
    a_tilted_normal_reflects_to_the_side_of_the_viewer,
    total_reflection_fades_and_weighs_like_light_that_passes,
    of_blended_textures_those_that_transmit_reflect_totally,
    blended_textures_refract_by_their_own_normals,
    reflection_weighs_its_maximum_over_the_angles,
    reflectance_of_a_normal_that_faces_away,
}
