//! Cameras.

use super::{LIGHT, SETTINGS, THINGS};
use crate::common::pictures::{agree, agree_within};

fn seen(camera: &str) -> String {
    format!("{SETTINGS}camera {{ {camera} }}\n{LIGHT}{THINGS}")
}

#[test]
fn wide_cameras_see_as_povrays() {
    let place = "location <1, 2, -6> look_at <0, 0, 0>";
    let scenes = [
        ("fisheye", "fisheye angle 150"),
        ("all around", "fisheye angle 360 right x up y"),
        ("mirrored fisheye", "fisheye right -x up 0.75 * y"),
        ("ultra wide angle", "ultra_wide_angle angle 160"),
        ("omnimax", "omnimax angle 100"),
        ("narrow omnimax", "omnimax right 0.8 * x up y"),
        ("panoramic", "panoramic angle 120"),
        ("cylinder 1", "cylinder 1 angle 150 right 2 * x up 2 * y"),
        ("cylinder 2", "cylinder 2 angle 90 right 1.5 * x"),
        ("cylinder 3", "cylinder 3 angle 220 right 2 * x up 4 * y"),
        ("cylinder 4", "cylinder 4 angle 90 right 4 * x up 3 * y"),
        ("spherical", "spherical angle 270, 100"),
        ("half as high", "spherical angle 160"),
        (
            "mirrored sphere",
            "spherical right -x angle 160 rotate 20 * z scale <1, 1.5, 1>",
        ),
        ("bumpy", "normal { bumps 0.3 scale 0.2 }"),
        (
            "wavy fisheye",
            "fisheye angle 150 normal { bumps 0.2 scale 0.3 rotate 20 * x }",
        ),
    ];
    let scenes = scenes.map(|(name, camera)| (name, seen(&format!("{camera} {place}"))));
    agree(0.01, &scenes);
}

#[test]
fn meshes_see_as_povrays() {
    // A face for each pixel, with the uv coordinates of its position.
    let face = "#macro Face(I, J)
          triangle {
            <I / 10 - 3.2, 2.4 - J / 10, -4>, <I / 10 - 3.1, 2.4 - J / 10, -4>, <I / 10 - 3.2, 2.3 - J / 10, -4>
            uv_vectors <I, 48 - J> / <64, 48>, <I + 1, 48 - J> / <64, 48>, <I, 47 - J> / <64, 48>
          }
        #end
        #macro Grid(W, H, D) mesh { #for (J, 0, H - 1) #for (I, 0, W - 1) Face(I + D, J) #end #end } #end
        #declare G = Grid(64, 48, 0)
        #declare Half = Grid(32, 48, 10)
        #declare Top = Grid(64, 20, 0)
        #declare Rest = Grid(64, 28, 0)\n";
    let scenes = [
        ("each", "mesh_camera { 1 0 mesh { G } }"),
        (
            "backwards",
            "mesh_camera { 1 0 mesh { G translate 8 * z } } location <0, 0, 0.5> direction -z",
        ),
        (
            "several",
            "mesh_camera { 2 0 mesh { G } mesh { G rotate 20 * y } }",
        ),
        (
            "joined",
            "mesh_camera { 1 1 mesh { Top } mesh { Rest translate 0.3 * x } }",
        ),
        (
            "side by side",
            "mesh_camera { 1 2 mesh { Half } mesh { Half translate 0.5 * x } }",
        ),
        ("by uv", "mesh_camera { 1 3 mesh { G } }"),
    ];
    let scenes = scenes.map(|(name, camera)| {
        let text = seen(camera).replace("\ncamera {", &format!("\n{face}camera {{"));
        (name, text)
    });
    // POV-Ray uses the faces of the row above, except in the first row, so the pictures are shifted by a pixel.
    agree_within(3.0 / 255.0, 0.15, &scenes);
}

#[test]
fn lenses_blur_as_povrays() {
    // Both sample the lens, POV-Ray also the pixel. (Its orthographic cameras with a lens show a single point.)
    let lens = "location <1, 2, -6> look_at 0 aperture 0.8 blur_samples 400, 400 variance 0 confidence 0.99";
    let scenes = [
        ("before the plane", "focal_point <0, 0, 6>"),
        ("within the scene", "focal_point <0, 0, 0>"),
        ("turned", "focal_point <0, 0, 3> rotate 30 * y translate x"),
        (
            "long lens",
            "focal_point <0, 0, 6> right 3 * x up 2.25 * y direction 2 * z",
        ),
    ];
    let scenes = scenes.map(|(name, more)| (name, seen(&format!("{more} {lens}"))));
    agree_within(1.0 / 255.0, 0.06, &scenes);
}

#[test]
fn cameras_see_as_povrays() {
    let scenes = [
        ("default lens", "location <0, 1, -7>"),
        (
            "looking before standing",
            "look_at <0, 0, 0> location <3, 2, -5>",
        ),
        (
            "right-handed",
            "location <1, 2, -6> right -4/3 * x look_at 0",
        ),
        (
            "square pixels",
            "location <1, 2, -6> right x * image_width / image_height look_at 0",
        ),
        (
            "wide pixels",
            "location <1, 2, -6> right 2 * x up y look_at 0",
        ),
        (
            "exporter",
            "location <0, 0, -8> direction <0, 0, 2.5> right <1.33, 0, 0> up <0, 1, 0> sky <0, 1, 0>",
        ),
        (
            "z up",
            "location <6, 1, 4> sky z up z right 4/3 * x angle 45 look_at <0, 0, 0.5>",
        ),
        ("tilted sky", "location <1, 2, -6> sky <1, 2, 0> look_at 0"),
        (
            "angle before right",
            "angle 60 right 1.6 * x up 1.2 * y location <1, 2, -6> look_at 0",
        ),
        (
            "turned before",
            "rotate 20 * y location <0, 1, -6> look_at <0, 0.5, 0>",
        ),
        (
            "turned after",
            "location <0, 1, -6> look_at <0, 0.5, 0> rotate 20 * y translate 0.5 * x",
        ),
        ("from above", "location <0, 8, 0> look_at 0 angle 40"),
        (
            "skewed",
            "location <1, 2, -6> right <1.33, 0.3, 0> up <0, 1, 0.2> direction <0.1, -0.2, 1>",
        ),
        (
            "orthographic",
            "orthographic location <1, 2, -6> right 6 * x up 4.5 * y look_at 0",
        ),
        (
            "orthographic as perspective",
            "orthographic location <1, 2, -6> look_at 0",
        ),
        (
            "orthographic by angle",
            "orthographic angle 40 location <1, 2, -6> right 2 * x up 1.2 * y look_at 0",
        ),
        ("no angle", "angle 0 location <1, 2, -6> look_at 0"),
        (
            "orthographic without an angle",
            "orthographic angle 0 right -4.39 * x up 3.4 * y direction 50 * z location <0, 0, 50> look_at 0",
        ),
        (
            "orthographic with an angle of nothing",
            "orthographic angle 0 location <1, 2, -6> right 2 * x up 1.2 * y direction 1.5 * z look_at 0",
        ),
        (
            "orthographic without a point",
            "orthographic location <0, 0.5, -5> direction 2 * z",
        ),
    ];
    agree(0.004, &scenes.map(|(name, camera)| (name, seen(camera))));
}

#[test]
fn a_declared_camera_can_be_moved() {
    let text = format!(
        "{SETTINGS}#declare C = camera {{ location <0, 1, -6> look_at 0 angle 40 }} camera {{ C rotate 30 * y }}{LIGHT}{THINGS}"
    );
    agree(0.004, &[("declared", text)]);
}
