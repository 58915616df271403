//! What `bounded_by` hides, and from whom.

use super::SETTINGS;
use crate::common::pictures::agree;

const CAMERA: &str = "camera { location -6*z look_at 0 angle 40 } background { rgb <0, 0, 0.4> }
#default { finish { ambient 1 diffuse 0 } }
";
const RED: &str = "pigment { rgb x }";

fn seen(objects: &[(&'static str, &str)]) {
    let scenes: Vec<_> = objects
        .iter()
        .map(|(name, object)| (*name, format!("{SETTINGS}{CAMERA}{object}")))
        .collect();
    agree(0.005, &scenes);
}

#[test]
fn operations_and_polynomials_are_seen_through_their_bounds() {
    let two = "cylinder { -y, y, 1 } cylinder { -y, y, 0.5 }";
    let ball = "bounded_by { sphere { 0, 0.6 } }";
    seen(&[
        ("union", &format!("union {{ {two} {ball} {RED} }}")),
        ("merge", &format!("merge {{ {two} {ball} {RED} }}")),
        (
            "intersection",
            &format!("intersection {{ {two} {ball} {RED} }}"),
        ),
        (
            "difference",
            &format!("difference {{ {two} {ball} {RED} }}"),
        ),
        (
            "poly",
            &format!("poly {{ 2, <1,0,0,0,-1,0,0,1,0,-.1> {ball} rotate 30*x {RED} }}"),
        ),
        (
            "a wide bound",
            &format!(
                "union {{ {two} bounded_by {{ box {{ <-9, -0.3, -1.2>, <9, 0.3, 1.2> }} }} {RED} }}"
            ),
        ),
        (
            "an unbounded bound",
            &format!("union {{ {two} bounded_by {{ plane {{ x, 0 }} }} {RED} }}"),
        ),
        (
            "a bound that clips",
            &format!("union {{ {two} {ball} clipped_by {{ bounded_by }} {RED} }}"),
        ),
        (
            "the eye within",
            &format!("union {{ {two} bounded_by {{ sphere {{ -6*z, 1 }} }} {RED} }}"),
        ),
        (
            "before the eye",
            &format!(
                "union {{ {two} bounded_by {{ box {{ <-0.5, -0.5, -3>, <0.5, 0.5, -2.5> }} }} {RED} }}"
            ),
        ),
        (
            "behind the object",
            &format!(
                "union {{ {two} bounded_by {{ box {{ <-0.5, -0.5, 3>, <0.5, 0.5, 3.5> }} }} {RED} }}"
            ),
        ),
        (
            "behind the eye",
            &format!(
                "union {{ {two} bounded_by {{ sphere {{ -9*z, 1 }} }} {RED} }} box {{ -0.2, 0.2 }}"
            ),
        ),
        (
            "declared",
            &format!(
                "#declare U = union {{ {two} {ball} }} object {{ U scale <2, 1, 1> bounded_by {{ sphere {{ 0.5*x, 0.6 }} }} {RED} }}"
            ),
        ),
    ]);
}

#[test]
fn other_objects_are_seen_through_the_box_around_their_bounds() {
    let ball = "bounded_by { sphere { 0, 0.6 } }";
    let object = |text: &str| format!("{text} {ball} {RED} }}");
    seen(&[
        ("cylinder", &object("cylinder { -y, y, 1")),
        ("quadric", &object("quadric { <1, 1, 0>, 0, 0, -1")),
        ("torus", &object("torus { 0.5, 0.4 rotate 90*x")),
        (
            "lathe",
            &object("lathe { linear_spline 4, <0, -1>, <1, -0.5>, <1, 0.5>, <0, 1>"),
        ),
        ("large disc", &object("disc { 0, z, 100")),
        (
            "isosurface",
            &object(
                "isosurface { function { x*x + y*y + z*z - 1 } max_gradient 4 contained_by { box { -1.1, 1.1 } }",
            ),
        ),
        (
            "a larger box",
            &format!(
                "cylinder {{ -y, y, 1 bounded_by {{ box {{ <-0.5, -1.5, -1.5>, <0.5, 1.5, 1.5> }} }} {RED} }}"
            ),
        ),
        (
            "a slightly smaller box",
            &format!(
                "cylinder {{ -y, y, 1 bounded_by {{ box {{ <-0.5, -1.4, -1.4>, <0.5, 1.4, 1.4> }} }} {RED} }}"
            ),
        ),
        (
            "turned",
            &format!(
                "cylinder {{ -y, y, 1 bounded_by {{ box {{ -0.5, 0.5 }} }} rotate 45*z {RED} }}"
            ),
        ),
        (
            "two bounds",
            &format!(
                "cylinder {{ -y, y, 1 bounded_by {{ sphere {{ 0, 1 }} box {{ -0.7, 0.7 }} }} {RED} }}"
            ),
        ),
    ]);
}

#[test]
fn objects_that_are_found_quickly_have_no_bounds() {
    let ball = "bounded_by { sphere { 0, 0.2 } }";
    seen(&[
        ("sphere", &format!("sphere {{ 0, 1 {ball} {RED} }}")),
        ("box", &format!("box {{ -1, 1 {ball} rotate 30 {RED} }}")),
        ("plane", &format!("plane {{ z, 0 {ball} {RED} }}")),
        (
            "triangle",
            &format!("triangle {{ <-1, -1, 0>, <1, -1, 0>, y {ball} {RED} }}"),
        ),
        (
            "mesh",
            &format!("mesh {{ triangle {{ <-1, -1, 0>, <1, -1, 0>, y }} {ball} {RED} }}"),
        ),
        (
            "blob",
            &format!("blob {{ threshold 0.5 sphere {{ 0, 2, 1 }} {ball} {RED} }}"),
        ),
        (
            "height field",
            &format!(
                "height_field {{ function 10, 10 {{ x }} translate -0.5 scale 2 rotate -30*x {ball} {RED} }}"
            ),
        ),
        ("small disc", &format!("disc {{ 0, z, 1 {ball} {RED} }}")),
    ]);
}

#[test]
fn bounds_of_parts_hide_the_parts_surface_and_not_its_inside() {
    seen(&[
        (
            "a part",
            &format!("union {{ cylinder {{ -y, y, 0.5 bounded_by {{ box {{ -0.4, 0.4 }} }} }} cylinder {{ -y, y, 0.5 translate x }} {RED} }}"),
        ),
        (
            "a hole",
            &format!("difference {{ box {{ -1, 1 }} cylinder {{ -2*z, 2*z, 0.7 bounded_by {{ box {{ <-0.3, -0.7, -0.5>, <0.3, 0.7, 0.5> }} }} pigment {{ rgb <1, 1, 0> }} }} {RED} rotate 10*y }}"),
        ),
        (
            "the whole of an intersection",
            &format!("intersection {{ cylinder {{ -y, y, 1 bounded_by {{ box {{ -0.6, 0.6 }} }} }} sphere {{ 0, 1.1 }} {RED} }}"),
        ),
        (
            "shadows",
            "plane { z, 4 pigment { rgb y } finish { ambient 0 diffuse 1 } } light_source { -20*z, 1 }
             cylinder { -y, y, 1 bounded_by { box { -0.6, 0.6 } } no_image }",
        ),
        (
            "mirrors",
            &format!("plane {{ z, 4 pigment {{ rgb 0 }} finish {{ reflection 1 }} }} cylinder {{ -y, y, 1 bounded_by {{ box {{ -0.6, 0.6 }} }} {RED} }}"),
        ),
        (
            "many",
            &format!("#for (I, 0, 30) cylinder {{ -y, y, 0.2 bounded_by {{ box {{ <-0.1, -0.6, -0.1>, <0.1, 0.6, 0.1> }} }} translate <mod(I, 6) - 2.5, I/10 - 1.5, 0> {RED} }} #end"),
        ),
    ]);
}
