//! The scenes to compare.

/// The beginning of every scene.
pub(crate) const SETUP: &str = "
#version 3.7;
global_settings { assumed_gamma 1 ambient_light 1 }
camera { location <0.3, 1.2, -6> right x * 4 / 3 up y look_at <0, 0, 0> angle 40 }
light_source { <5, 8, -9>, rgb 1 }
background { rgb <0.1, 0.2, 0.4> }
#declare Red = texture { pigment { rgb <0.9, 0.2, 0.1> } finish { ambient 0.2 diffuse 0.7 } }
#declare Green = texture { pigment { rgb <0.2, 0.8, 0.3> } finish { ambient 0.3 diffuse 0.6 } }
#declare Flat = texture { pigment { rgb <0.7, 0.7, 0.2> } finish { ambient 1 diffuse 0 } }
#default { texture { Flat } }
#declare Ball = sphere { 0, 1 }
#declare Pair = union { sphere { -x, 0.6 } box { <0.4, -0.5, -0.5>, <1.4, 0.5, 0.5> texture { Green } } }
#declare Cross = merge {
    cylinder { -x * 1.2, x * 1.2, 0.3 } cylinder { -y, y, 0.3 } cylinder { -z, z, 0.3 } sphere { 0, 0.5 }
    sphere { x, 0.4 } sphere { -x, 0.4 } sphere { y, 0.4 } sphere { -y, 0.4 }
}
";

/// Names and bodies of the scenes.
pub(crate) const SCENES: &[(&str, &str)] = &[
    ("sphere", "sphere { <0.2, 0.1, 0>, 1.1 texture { Red } }"),
    (
        "ellipsoid",
        "sphere { 0, 1 texture { Red } scale <1.5, 0.6, 1> rotate z * 30 translate x * 0.3 }",
    ),
    ("negative radius", "sphere { 0, -1 texture { Red } }"),
    (
        "box",
        "box { <-1, 1, -0.5>, <0.8, -0.7, 1> texture { Red } rotate <20, 30, 10> }",
    ),
    (
        "flat box",
        "box { <-1, -1, 0>, <1, 1, 0> texture { Red } rotate y * 30 }",
    ),
    ("plane", "plane { <0, 2, 0.1>, -1 texture { Red } }"),
    ("disc", "disc { 0, <0.3, 1, -1>, 1.4, 0.5 texture { Red } }"),
    (
        "disc without hole",
        "disc { x * 0.2 <0.3, 1, -1> 1.4 texture { Red } }",
    ),
    (
        "cylinder",
        "cylinder { <-1, -0.5, 0>, <1, 0.8, 1>, 0.5 texture { Red } }",
    ),
    (
        "open cylinder",
        "cylinder { <-1, -0.5, 0>, <1, 0.8, -2>, 0.5 open texture { Red } }",
    ),
    (
        "cone",
        "cone { <-1, -0.5, 0>, 0.9, <1, 0.8, 1>, 0.2 texture { Red } }",
    ),
    (
        "pointed cone",
        "cone { <0, -1, 0>, 0.9, <0, 1.2, 0>, 0 texture { Red } }",
    ),
    (
        "open cone",
        "cone { <-1, -0.5, 0>, 0.2, <0.5, 0.8, -2>, 0.7 open texture { Red } }",
    ),
    (
        "torus",
        "torus { 1.2, 0.4 texture { Red } rotate <-40, 0, 10> }",
    ),
    (
        "spindle torus",
        "torus { 0.5, 0.9 sturm texture { Red } rotate <-40, 0, 10> }",
    ),
    (
        "quadric",
        "intersection { quadric { <1, -1, 1>, <0, 0.2, 0>, <0, 0.1, 0>, -0.2 } sphere { 0, 1.5 } texture { Red } }",
    ),
    (
        "quadric alone",
        "quadric { <1, 2, 1>, <0.3, 0, 0>, 0, -1 texture { Red } }",
    ),
    (
        "quartic",
        "quartic { <1, 0, 0, 0, 2, 0, 0, 2, 0, -2.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 1.5, 0, 0, 0, 0, 1, 0, -2.5, 0, 0.5625> sturm texture { Red } rotate <-40, 0, 10> bounded_by { sphere { 0, 2 } } }",
    ),
    (
        "cubic",
        "cubic { <1, 0, 0, 0, -3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0> sturm texture { Red } clipped_by { sphere { 0, 1.4 } } rotate x * 60 }",
    ),
    (
        "poly",
        "intersection { poly { 6, <4, 0, 0, 0, 0, 0, 0, 0, 0, -4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0> sturm } box { <-1.5, -1, -1>, <1.5, 1, 1> } texture { Red } rotate y * 30 }",
    ),
    (
        "polynomial",
        "intersection { polynomial { 4, xyz(4, 0, 0): 4, xyz(3, 0, 0): -4, xyz(0, 2, 0): 1, xyz(0, 0, 2): 1 sturm } sphere { 0, 2 } texture { Red } rotate y * 30 }",
    ),
    (
        "inverse polynomial",
        "difference { box { -1, 1 } polynomial { 4, xyz(4, 0, 0): 1, xyz(0, 4, 0): 1, xyz(0, 0, 4): 1, xyz(0, 0, 0): -1.2 sturm inverse scale 1.1 } texture { Red } rotate <30, 40, 0> }",
    ),
    (
        "blob",
        "blob { threshold 0.6 sphere { <0.75, 0, 0>, 1, 1 } sphere { <-0.375, 0.65, 0>, 1, 1 } sphere { <-0.375, -0.65, 0>, 1, 1.3 } texture { Red } scale 1.1 }",
    ),
    (
        "blob of stretched components",
        "blob { threshold 0.5 cylinder { -x, x, 0.7, strength 1 rotate z * 20 } cylinder { -y, <0, 1, -0.3>, 0.5, 0.9 scale <1.4, 0.8, 1> } sphere { <0.2, 0.3, -0.6>, 0.8, -0.7 } component 1, 0.8, <1, 1, 0> sturm hierarchy off texture { Red } }",
    ),
    (
        "textures of a blob",
        "blob { threshold 0.4 sphere { -0.7 * x, 1.2, 1 texture { Red } } sphere { 0.7 * x, 1.2, 1 texture { Green } } cylinder { -y, y, 0.7, 1 } texture { Flat } }",
    ),
    (
        "textures of a blob that moves",
        "blob { threshold 0.4 sphere { 0, 1.2, 1 pigment { gradient x } translate -0.7 * x } sphere { 0, 1.2, 1 pigment { gradient y } finish { ambient 1 diffuse 0 } rotate z * 30 translate 0.7 * x } rotate y * 20 }",
    ),
    (
        "blob in a difference",
        "difference { box { -1, 1 } blob { threshold 0.5 sphere { <-0.6, 0.5, -1>, 1, 1 } sphere { <0.7, 0.5, -1>, 1, 1 } cylinder { <0, -2, -1>, <0, 1, -1>, 0.5, 1 } } texture { Red } rotate <20, 20, 0> }",
    ),
    (
        "superellipsoid",
        "superellipsoid { <0.3, 0.2> texture { Red } rotate <30, 40, 0> }",
    ),
    (
        "superellipsoid with a round outline",
        "superellipsoid { <1, 0.1> texture { Red } rotate <60, 40, 0> }",
    ),
    (
        "star",
        "superellipsoid { <2.5, 2.8> texture { Red } rotate <30, 40, 0> }",
    ),
    (
        "superellipsoid in a difference",
        "difference { sphere { 0, 1.3 } superellipsoid { <0.5, 1.5> rotate y * 30 } box { <-2, 0, -2>, 0 } texture { Red } }",
    ),
    (
        "triangle",
        "triangle { <-1.5, -1, 0>, <1.5, -0.8, 0.5>, <0.2, 1.2, -0.5> texture { Red } }",
    ),
    (
        "smooth triangle",
        "smooth_triangle { <-1.5, -1, 0>, <-0.5, 0, -1>, <1.5, -0.8, 0.5>, <0.7, 0, -1>, <0.2, 1.2, -0.5>, <0, 0.6, -1> texture { Red } }",
    ),
    (
        "equal normals",
        "smooth_triangle { <-1.5, -1, 0>, <-1, 0, -1>, <1.5, -0.8, 0.5>, <-1, 0, -1>, <0.2, 1.2, -0.5>, <-1, 0, -1> texture { Red } no_shadow }",
    ),
    (
        "equal normals in a mesh",
        "mesh { smooth_triangle { <-1.5, -1, 0>, <-1, 0, -1>, <1.5, -0.8, 0.5>, <-1, 0, -1>, <0.2, 1.2, -0.5>, <-1, 0, -1> } texture { Red } no_shadow }",
    ),
    (
        "polygon",
        "polygon { 5, <-1, -1>, <1, -1>, <1.4, 1>, <-0.8, 0.9>, <-1, -1> texture { Red } rotate y * 20 }",
    ),
    (
        "polygon with holes",
        "polygon { 15, <-1.5, -1.2>, <1.5, -1.2>, <1.5, 1.2>, <-1.5, 1.2>, <-1.5, -1.2>, <-1, -0.8>, <0, -0.8>, <0, 0.8>, <-1, 0.8>, <-1, -0.8>, <0.4, -0.5>, <1.2, -0.5>, <1.2, 0.5>, <0.4, 0.5>, <0.4, -0.5> texture { Red } }",
    ),
    (
        "open polygon",
        "polygon { 4, <-1, -1>, <1, -1>, <1.4, 1>, <-0.8, 0.9> texture { Red } }",
    ),
    (
        "mesh",
        "mesh { triangle { <-1, -1, 0>, <1, -1, 0>, <0, 0, -1> } triangle { <-1, -1, 0>, <0, 0, -1>, <0, 1.2, 0> texture { Green } } smooth_triangle { <1, -1, 0>, <1, 0, -1>, <0, 0, -1>, -z, <0, 1.2, 0>, <0, 1, -1> } texture { Red } rotate y * 20 }",
    ),
    (
        "mesh2",
        "mesh2 { vertex_vectors { 4, <-1, -1, 0>, <1, -1, 0>, <0, 0, -1>, <0, 1.2, 0> } texture_list { 2, texture { Red } texture { Green } } face_indices { 3, <0, 1, 2>, 0, <0, 2, 3>, 1, <1, 2, 3>, 1 } scale 1.2 }",
    ),
    (
        "mesh2 with normals",
        "mesh2 { vertex_vectors { 4 <-1, -1, 0> <1, -1, 0> <0, 0, -1> <0, 1.2, 0> } normal_vectors { 4, <-1, 0, -1>, <1, 0, -1>, <0, 0, -1>, <0, 1, -1> } face_indices { 3, <0, 1, 2>, <0, 2, 3>, <1, 2, 3> } no_shadow texture { Red } }",
    ),
    (
        "mesh2 with normal indices",
        "mesh2 { vertex_vectors { 4, <-1, -1, 0>, <1, -1, 0>, <0, 0, -1>, <0, 1.2, 0> } normal_vectors { 2, <-1, 0, -1>, <0.5, 1, -1> } uv_vectors { 2, <0, 0>, <1, 1> } face_indices { 3, <0, 1, 2>, <0, 2, 3>, <1, 2, 3> } normal_indices { 3, <0, 0, 1>, <0, 0, 0>, <1, 1, 0> } uv_indices { 3, <0, 0, 1>, <0, 0, 0>, <1, 1, 0> } no_shadow texture { Red } }",
    ),
    (
        "mesh2 with normal indices for the first faces",
        "mesh2 { vertex_vectors { 4 <-1, -1, 0> <1, -1, 0> <0, 0, -1> <0, 1.2, 0> } normal_vectors { 4, <-1, 0, -1>, <1, 0, -1>, <0, 0, -1>, <0, 1, -1> } face_indices { 3, <0, 1, 2>, <0, 2, 3>, <1, 2, 3> } normal_indices { 1, <0, 1, 2> } no_shadow texture { Red } }",
    ),
    (
        "mesh2 without normal indices",
        "mesh2 { vertex_vectors { 4 <-1, -1, 0> <1, -1, 0> <0, 0, -1> <0, 1.2, 0> } normal_vectors { 4, <-1, 0, -1>, <1, 0, -1>, <0, 0, -1>, <0, 1, -1> } face_indices { 3, <0, 1, 2>, <0, 2, 3>, <1, 2, 3> } normal_indices { 0 } no_shadow texture { Red } }",
    ),
    (
        "closed mesh2 in CSG",
        "difference { mesh2 { vertex_vectors { 4, <-1, -1, -1>, <1.5, -1, -0.5>, <0, -1, 1.5>, <0, 1.3, 0> } face_indices { 4, <0, 1, 2>, <0, 1, 3>, <1, 2, 3>, <2, 0, 3> } inside_vector y } sphere { <0, 0, -1>, 0.8 texture { Green } } texture { Red } }",
    ),
    (
        "union",
        "union { sphere { -x * 0.7, 0.8 } box { 0, 1 texture { Green } } cone { -y, 0.5, y * 0.2, 0 } texture { Red } rotate x * -20 }",
    ),
    (
        "merge",
        "merge { sphere { -x * 0.4, 0.8 } sphere { x * 0.4, 0.8 texture { Green } } pigment { rgbt <1, 0.5, 0.5, 0.5> } finish { ambient 1 diffuse 0 } }",
    ),
    (
        "union of glass",
        "union { sphere { -x * 0.4, 0.8 } sphere { x * 0.4, 0.8 } pigment { rgbt <1, 0.5, 0.5, 0.5> } finish { ambient 1 diffuse 0 } }",
    ),
    (
        "intersection",
        "intersection { sphere { -x * 0.4, 1 } box { -0.8, 0.8 texture { Green } } plane { y, 0.5 texture { Flat } } texture { Red } }",
    ),
    (
        "difference",
        "difference { box { -1, 1 } sphere { <0.2, 0.5, -1>, 0.9 texture { Green } } cylinder { -2 * x, 2 * x, 0.4 } texture { Red } rotate <10, 35, 0> }",
    ),
    (
        "nested operations",
        "difference { union { box { -1, <0, 1, 1> } sphere { x * 0.3, 0.9 } translate y * 0.1 } intersection { sphere { -z, 0.8 } plane { x, 0.2 } rotate z * 20 } merge { cylinder { -2 * y, 2 * y, 0.2 } sphere { y, 0.5 } } texture { Red } }",
    ),
    (
        "inverse",
        "intersection { box { -1, 1 } sphere { <0.5, 0.5, -1>, 1 inverse texture { Green } } texture { Red } }",
    ),
    (
        "inverse union",
        "intersection { box { -1, 1 } union { sphere { <0.5, 0.5, -1>, 0.7 } sphere { <-0.5, 0.5, -1>, 0.7 } inverse texture { Green } } texture { Red } }",
    ),
    (
        "single part",
        "intersection { sphere { 0, 1 } texture { Red } }",
    ),
    (
        "open parts",
        "union { disc { y * 0.8, <0.2, 0.5, -1>, 0.5 } triangle { -x, x, -y texture { Green } } texture { Red } }",
    ),
    (
        "open parts cut",
        "intersection { disc { 0, <0.2, 0.5, -1>, 1.5 texture { Green } } sphere { 0, 1 texture { Red } } }",
    ),
    (
        "light in a union",
        "#declare Lamp = union { light_source { <0, 1.5, -2>, rgb 0.5 } sphere { <0.6, 0, 0>, 0.5 texture { Red } } rotate y * 20 } object { Lamp translate -x } plane { y, -1 texture { Green } }",
    ),
    (
        "clipped",
        "sphere { 0, 1.2 clipped_by { plane { <0.3, 1, -0.2>, 0.3 } } texture { Red } }",
    ),
    (
        "clipped, then moved",
        "sphere { 0, 1.2 clipped_by { plane { y, 0.3 } box { -1, 1 } } rotate z * 30 scale <1, 0.8, 1> texture { Red } }",
    ),
    (
        "moved, then clipped",
        "sphere { 0, 1.2 scale <1.3, 0.8, 1> rotate z * 30 clipped_by { plane { y, 0.3 } } translate x * 0.2 texture { Red } }",
    ),
    (
        "clipped by bounds",
        "box { -1, 1 bounded_by { sphere { 0, 1.3 } } clipped_by { bounded_by } texture { Red } rotate 30 }",
    ),
    (
        "bounded by clip",
        "box { -1, 1 clipped_by { sphere { 0, 1.3 } } bounded_by { clipped_by } texture { Red } rotate 30 }",
    ),
    (
        "clipped union",
        "union { sphere { -x * 0.7, 0.8 } box { 0, 1 texture { Green } } clipped_by { plane { z, 0.2 inverse } } texture { Red } rotate y * 160 }",
    ),
    (
        "clipped part",
        "difference { sphere { 0, 1.1 clipped_by { plane { x, 0.5 } } texture { Red } } box { -1, <1, 0.2, 0.1> texture { Green } } }",
    ),
    (
        "no shadow",
        "plane { y, -1 texture { Red } } sphere { 0, 0.8 no_shadow texture { Green } } box { <1, -0.9, 0>, <1.5, 0, 0.5> texture { Green } }",
    ),
    (
        "no image",
        "plane { y, -1 texture { Red } } sphere { 0, 0.8 no_image texture { Green } }",
    ),
    (
        "other switches",
        "sphere { 0, 1 texture { Red } hollow on no_reflection double_illuminate off } union { box { 1, 1.4 hollow } texture { Red } split_union off hollow false }",
    ),
    (
        "transforms",
        "#declare T = transform { rotate z * 30 translate x * 0.5 } box { -0.7, 0.7 texture { Red } transform { T inverse } transform T scale <1, 1.5, 1> matrix <1, 0.2, 0, 0, 1, 0, 0, 0, 1, 0.1, 0.2, 0> }",
    ),
    (
        "scale by zero",
        "sphere { 0, 1 scale <1.2, 0, 1> texture { Red } }",
    ),
    (
        "singular matrix",
        "sphere { 0, 1 matrix <1.2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0.1, 0> texture { Red } }",
    ),
    (
        "declared",
        "object { Ball texture { Red } scale 0.7 translate -x } object { Ball scale 0.6 texture { Green } translate x } object { Ball scale 0.3 translate y }",
    ),
    (
        "declared union",
        "object { Pair texture { Red } rotate z * 20 translate y * 0.6 } object { Pair translate -y * 0.6 }",
    ),
    (
        "pigment of a textured object",
        "#declare S = sphere { 0, 0.8 texture { Red } } object { S pigment { rgb z } translate x } object { S translate -x }",
    ),
    (
        "texture of a textured object",
        "#declare S = sphere { 0, 0.8 texture { Red } } object { S texture { Green } translate x } object { S translate -x }",
    ),
    (
        "default after the declaration",
        "#declare S = sphere { 0, 0.8 } #default { texture { Red } } object { S }",
    ),
    (
        "instances",
        "#for (I, -3, 3) object { Cross scale 0.3 rotate <20, 30 * I, 0> translate <0.6 * I, 0, 0> #if (mod(I + 4, 2) = 0) texture { Red } #else pigment { rgb <0.2, 0.3 + I / 10, 0.8> } #end } #end",
    ),
    (
        "instances of instances",
        "#declare Row = union { #for (I, -3, 3) object { Cross scale 0.3 rotate <20, 30 * I, 0> translate <0.6 * I, 0, 0> } #end texture { Red } } object { Row translate y } object { Row texture { Green } rotate z * 5 } object { Row translate -y }",
    ),
    (
        "instances in CSG",
        "#declare Big = union { #for (I, -5, 5) sphere { x * I * 0.3, 0.25 texture { Green } } #end } difference { box { <-1.5, -1, 0>, <1.5, 0.8, 1> } object { Big } object { Big rotate z * 30 translate -y * 0.2 } texture { Red } }",
    ),
    (
        "built up",
        "#declare All = sphere { 0, 0.1 } #for (I, 1, 60) #declare All = union { object { All } sphere { <cos(I / 3), sin(I / 3), 0> * I / 50, 0.1 } } #end object { All texture { Red } }",
    ),
    (
        "built up by difference",
        "#declare All = box { <-1.3, -1.3, 0>, <1.3, 1.3, 0.2> } #for (I, 1, 40) #declare All = difference { object { All } sphere { <cos(I / 3), sin(I / 3), 0> * I / 35, 0.12 texture { Green } } } #end object { All texture { Red } }",
    ),
    (
        "degenerate parts",
        "difference { sphere { 0, 1 } sphere { 0, 0 } texture { Red } } union { sphere { x, 0 } triangle { 0, x, 2 * x } disc { y, y, 1, 2 } sphere { x * 1.4, 0.3 } texture { Green } } intersection { sphere { -x * 1.5, 0.5 } sphere { 0, 0 } }",
    ),
    (
        "height field",
        "height_field { function 30, 20 { pattern { bozo scale 0.2 } } texture { Red } no_shadow translate <-0.5, -0.3, -0.5> scale <3, 1, 3> rotate y * 20 }",
    ),
    (
        "smooth height field",
        "height_field { function 12, 16 { 0.5 + 0.3 * sin(x * 5) * cos(y * 7 + x) } smooth texture { Red } no_shadow translate <-0.5, -0.3, -0.5> scale <3, 1, 3> rotate y * 20 }",
    ),
    (
        "height field with water",
        "height_field { function 60, 70 { pattern { bozo scale 0.2 } } water_level 0.4 hierarchy off texture { Red } no_shadow translate <-0.5, -0.3, -0.5> scale <3, 1, 3> rotate y * 20 }",
    ),
    (
        "height field in CSG",
        "difference { box { <-1.4, -0.5, -1.4>, <1.4, 1, 0.3> } height_field { function 40, 40 { pattern { bozo scale 0.3 } } translate -0.5 scale <2, 1.4, 2> rotate z * 10 texture { Green } } texture { Red } rotate <-20, 30, 0> } intersection { sphere { <0, 1, 0>, 0.6 } height_field { function 40, 40 { x * y } water_level 0.2 translate -0.5 scale 2 translate y texture { Green } } texture { Red } }",
    ),
    (
        "isosurface",
        "isosurface { function { x * x + y * y * 2 + z * z + 0.3 * sin(5 * x) - 1 } contained_by { box { -1.5, 1.5 } } max_gradient 8 accuracy 0.0001 texture { Red } rotate 20 }",
    ),
    (
        "isosurface in its container",
        "isosurface { function { sin(4 * x) * cos(3 * y) + sin(4 * y) * cos(4 * z) + sin(3 * z) * cos(4 * x) } threshold 0.1 max_gradient 8 contained_by { sphere { 0, 1.3 } } accuracy 0.0001 texture { Red } no_shadow }",
    ),
    (
        "open isosurface",
        "isosurface { function { x * x + y * y + z * z - 1 } open evaluate 2, 1.2, 0.9 contained_by { box { -0.8, <0.7, 0.9, 0.8> } } max_gradient 4 accuracy 0.0001 texture { Red } no_shadow rotate <-30, 20, 0> }",
    ),
    (
        "isosurface of noise",
        "#include \"functions.inc\" isosurface { function { sqrt(x * x + y * y + z * z) - 1.3 + 0.7 * f_noise3d(x * 4, y * 4, z * 4) } contained_by { sphere { 0, 1.3 } } max_gradient 7 accuracy 0.0001 texture { Red } no_shadow }",
    ),
    (
        "isosurface of a pattern",
        "#declare F = function { pattern { bozo scale 0.4 } } isosurface { function { y + 0.4 - F(x, 0, z) * 0.5 } contained_by { box { <-1.3, -0.7, -1.3>, 1.3 } } max_gradient 3 accuracy 0.0001 texture { Red } no_shadow }",
    ),
    (
        "isosurface in CSG",
        "difference { box { -1, 1 } isosurface { function { x * x + y * y - 0.4 + 0.2 * sin(8 * z) } max_trace 4 max_gradient 4 accuracy 0.0001 contained_by { box { -1.1, 1.1 } } texture { Green } } texture { Red } rotate <20, 30, 0> }",
    ),
    (
        "Julia set of quaternions",
        "julia_fractal { <-0.083, 0, -0.83, -0.025> quaternion sqr max_iteration 6 precision 200 texture { Red } no_shadow }",
    ),
    (
        "Julia set of cubes",
        "julia_fractal { <-0.2, 0.3, -0.53, -0.025> cube max_iteration 5 precision 200 slice <0.1, 0.2, 0, 1>, 0.1 texture { Red } no_shadow rotate 30 }",
    ),
    (
        "Julia set of hypercomplex numbers",
        "julia_fractal { <-0.1, 0.2, -0.5, 0.1> hypercomplex sqr max_iteration 6 precision 200 texture { Red } no_shadow }",
    ),
    (
        "Julia set cut off",
        "difference { julia_fractal { <-0.083, 0, -0.83, -0.025> max_iteration 6 precision 200 texture { Green } } box { <-2, -2, -2>, <2, 2, 0> } texture { Red } no_shadow rotate y * 30 }",
    ),
    (
        "parametric",
        "parametric { function { (1 + 0.4 * cos(v)) * cos(u) } function { 0.4 * sin(v) } function { (1 + 0.4 * cos(v)) * sin(u) } <0, 0>, <2 * pi, 2 * pi> contained_by { box { -1.5, 1.5 } } max_gradient 3 accuracy 0.0001 precompute 8 x, y, z texture { Red } no_shadow rotate <-40, 0, 10> }",
    ),
    (
        "bicubic patch",
        "bicubic_patch { type 1 u_steps 5 v_steps 5 <-1, -1, 0>, <-0.4, -1.3, 1>, <0.4, -0.8, -1>, <1, -1, 0>, <-1.2, -0.3, 0.8>, <-0.4, -0.3, -1>, <0.4, -0.4, 1>, <1.1, -0.3, 0>, <-0.8, 0.3, 0>, <-0.4, 0.4, 1>, <0.4, 0.3, -1>, <1.2, 0.3, 0.6>, <-1, 1, 0>, <-0.4, 1.3, -1>, <0.4, 0.8, 1>, <1, 1, 0> texture { Red } no_shadow rotate <30, 40, 0> }",
    ),
    (
        "bicubic patches cut by a ball",
        "intersection { bicubic_patch { type 0 u_steps 4 v_steps 4 <-1, -1, 0>, <-0.4, -1, 0>, <0.4, -1, 0>, <1, -1, 0>, <-1, -0.3, 0>, <-0.4, -0.3, -1>, <0.4, -0.3, -1>, <1, -0.3, 0>, <-1, 0.3, 0>, <-0.4, 0.3, -1>, <0.4, 0.3, -1>, <1, 0.3, 0>, <0, 1, 0>, <0, 1, 0>, <0, 1, 0>, <0, 1, 0> texture { Red } } sphere { <0.2, 0, 0>, 0.9 texture { Green } } no_shadow }",
    ),
    (
        "ovus",
        "ovus { 1, 0.55 texture { Red } no_shadow translate -0.3 * y rotate 20 * z }",
    ),
    (
        "ovus with the larger ball on top, cut",
        "difference { ovus { 0.6, 0.8 texture { Green } } box { <0, -2, -2>, <2, 2, 0> } texture { Red } no_shadow translate -0.4 * y rotate <-20, 30, 0> }",
    ),
    (
        "object around an object",
        "object { object { Ball scale 0.5 } texture { Red } translate y * 0.5 }",
    ),
    (
        "linear prism",
        "prism { linear_sweep linear_spline -0.3, 0.6, 10, <-1, -1>, <1.2, -1>, <0.9, 1>, <-1, 0.8>, <-1, -1>, <-0.5, -0.5>, <0.5, -0.5>, <0.5, 0.5>, <-0.5, 0.3>, <-0.5, -0.5> texture { Red } rotate <-35, 20, 0> }",
    ),
    (
        "prism that is not closed",
        "prism { 0, 0.5, 4, <-1, -1>, <1.2, -1>, <0.9, 1>, <-1, 0.8> texture { Red } rotate x * -50 }",
    ),
    (
        "quadratic prism",
        "prism { quadratic_spline 0.5, 0, 7, <-1, 0.5>, <0, -1>, <1.2, 0.1>, <0.1, 0.3>, <0.3, 1.1>, <-1, 0.5>, <0, -1> texture { Red } rotate x * -60 }",
    ),
    (
        "cubic prism",
        "prism { cubic_spline linear_sweep 0, 0.5, 8, <-1, 0.5>, <0, -1>, <1.2, 0.1>, <0.1, 0.3>, <0.3, 1.1>, <-1, 0.5>, <0, -1>, <1.2, 0.1> sturm texture { Red } rotate x * -60 }",
    ),
    (
        "two cubic curves",
        "prism { cubic_spline 0, 0.5, 14, <1, -1>, <-1, -1>, <1.2, -1>, <1.2, 1>, <-1, 1>, <-1, -1>, <1, -1>, <0.5, -0.5>, <-0.5, -0.5>, <0.5, -0.5>, <0.5, 0.5>, <-0.5, 0.5>, <-0.5, -0.5>, <0.5, -0.5> texture { Red } rotate x * -60 }",
    ),
    (
        "bezier prism",
        "prism { bezier_spline linear_sweep 0, 0.5, 8, <0, -1>, <1.5, -0.9>, <1.1, 0.8>, <0, 1>, <0, 1>, <-0.2, 0.2>, <-1.5, -0.2>, <0, -1> texture { Red } rotate <-60, 10, 0> }",
    ),
    (
        "conic prism",
        "prism { conic_sweep linear_spline 0.2, 1, 5, <-1, -1>, <1.2, -1>, <0.9, 1>, <-1, 0.8>, <-1, -1> texture { Red } rotate <150, 20, 0> translate y * 0.6 }",
    ),
    (
        "conic prism through its apex",
        "prism { conic_sweep cubic_spline -0.7, 1, 8, <-1, 0.5>, <0, -1>, <1.2, 0.1>, <0.1, 0.3>, <0.3, 1.1>, <-1, 0.5>, <0, -1>, <1.2, 0.1> texture { Red } rotate <-20, 20, 0> }",
    ),
    (
        "open prism",
        "prism { bezier_spline 0, 0.8, 8, <0, -1>, <1.5, -0.9>, <1.1, 0.8>, <0, 1>, <0, 1>, <-0.2, 0.2>, <-1.5, -0.2>, <0, -1> open texture { Red } rotate <-40, 10, 0> }",
    ),
    (
        "prism in CSG",
        "difference { prism { cubic_spline 0, 0.8, 8, <-1, 0.5>, <0, -1>, <1.2, 0.1>, <0.1, 0.3>, <0.3, 1.1>, <-1, 0.5>, <0, -1>, <1.2, 0.1> } sphere { <0.3, 0.8, -0.2>, 0.5 texture { Green } } prism { -1, 1, 4, <-0.6, 0.2>, <-0.3, 0.2>, <-0.4, 0.5>, <-0.6, 0.2> texture { Green } } texture { Red } rotate x * -50 }",
    ),
    (
        "linear lathe",
        "lathe { linear_spline 5, <0.5, 0>, <1.2, 0.1>, <1.1, 0.7>, <0.6, 0.5>, <0.5, 0> texture { Red } rotate <-30, 0, 10> }",
    ),
    (
        "open lathe",
        "lathe { 4, <0.3, -1>, <1.2, -0.6>, <0.8, 0.2>, <1, 0.9> texture { Red } rotate <-30, 0, 10> }",
    ),
    (
        "quadratic lathe",
        "lathe { quadratic_spline 7, <0.2, -1>, <0, -1>, <0.9, -0.6>, <0.3, 0.2>, <1, 0.9>, <0.3, 1>, <0, 0.9> texture { Red } rotate <-20, 0, 10> }",
    ),
    (
        "cubic lathe",
        "lathe { cubic_spline 8, <0, -0.8>, <0, -1>, <0.9, -0.6>, <0.3, 0.2>, <1, 0.9>, <0.3, 1>, <0, 0.9>, <0, 0.7> sturm texture { Red } rotate <-20, 0, 10> }",
    ),
    (
        "bezier lathe",
        "lathe { bezier_spline 8, <0.4, 0>, <1.3, 0.3>, <1.4, 0.7>, <0.5, 1>, <0.5, 1>, <0.2, 0.7>, <0.1, 0.4>, <0.4, 0> texture { Red } rotate <-30, 0, 10> translate -y * 0.4 }",
    ),
    (
        "level view of a lathe",
        "lathe { cubic_spline 8, <0, -0.8>, <0, -1>, <0.9, -0.6>, <0.3, 0.2>, <1, 0.9>, <0.3, 1>, <0, 0.9>, <0, 0.7> sturm texture { Red } translate <0.3, 1.2, 0> rotate x * 11 }",
    ),
    (
        "lathe in CSG",
        "difference { lathe { cubic_spline 8, <0, -0.8>, <0, -1>, <0.9, -0.6>, <0.3, 0.2>, <1, 0.9>, <0.3, 1>, <0, 0.9>, <0, 0.7> sturm } box { <0, -2, -2>, <2, 2, 0> texture { Green } } texture { Red } rotate <-20, 0, 10> }",
    ),
    (
        "open lathe in CSG",
        "difference { box { <-1.2, -0.8, -1.2>, <1.2, 0.8, 1.2> } lathe { cubic_spline 6, <0.5, -1.4>, <0.7, -1>, <1, -0.3>, <0.6, 0.4>, <0.8, 1>, <1, 1.5> sturm texture { Green } } texture { Red } rotate <-40, 20, 0> scale 0.8 }",
    ),
    (
        "sor",
        "sor { 7, <0, -1>, <0.5, -1>, <1.1, -0.3>, <0.4, 0.2>, <0.35, 0.6>, <0.6, 0.9>, <0.8, 1.2> texture { Red } rotate <-30, 0, 10> }",
    ),
    (
        "open sor",
        "sor { 7, <0, -1>, <0.5, -1>, <1.1, -0.3>, <0.4, 0.2>, <0.35, 0.6>, <0.6, 0.9>, <0.8, 1.2> open texture { Red } rotate <-30, 0, 10> }",
    ),
    (
        "sor in CSG",
        "difference { sor { 7, <0, -1>, <0.5, -1>, <1.1, -0.3>, <0.4, 0.2>, <0.35, 0.6>, <0.6, 0.9>, <0.8, 1.2> } cylinder { <0.3, -0.3, -2>, <0.3, -0.3, 2>, 0.4 texture { Green } } texture { Red } rotate <-20, 0, 10> }",
    ),
    (
        "linear sphere sweep",
        "sphere_sweep { linear_spline 4, <-1.3, -0.5, 0>, 0.3, <-0.5, 0.8, 0.5>, 0.5, <0.4, -0.6, 0>, 0.2, <1.2, 0.5, -0.5>, 0.4 texture { Red } }",
    ),
    (
        "cubic sphere sweep",
        "sphere_sweep { cubic_spline 6, <-1.5, 0, 0>, 0.2, <-1.3, -0.5, 0>, 0.3, <-0.5, 0.8, 0.5>, 0.5, <0.4, -0.6, 0>, 0.2, <1.2, 0.5, -0.5>, 0.4, <1, 1, 0>, 0.3 tolerance 1e-7 texture { Red } }",
    ),
    (
        "smooth sphere sweep",
        "sphere_sweep { b_spline 6, <-1.9, 0, 0>, 0.3, <-1.3, -0.9, 0>, 0.3, <-0.5, 1.2, 0.5>, 0.6, <0.4, -1, 0>, 0.2, <1.4, 0.8, -0.5>, 0.5, <1.5, 1, 0>, 0.3 texture { Red } }",
    ),
    (
        "sphere sweep in CSG",
        "difference { sphere_sweep { cubic_spline 6, <-1.5, 0, 0>, 0.2, <-1.3, -0.5, 0>, 0.3, <-0.5, 0.8, 0.5>, 0.5, <0.4, -0.6, 0>, 0.3, <1.2, 0.5, -0.5>, 0.4, <1, 1, 0>, 0.3 } plane { z, 0 texture { Green } } texture { Red } }",
    ),
];
