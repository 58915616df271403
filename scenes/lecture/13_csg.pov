// Constructive solid geometry: a tree of solids. Along a ray each leaf is a list of spans; the operations combine spans.
//
// Below, the leaves: a cube, a ball, and three cylinders as one. In the middle, cube and ball intersected. Above, the cylinders taken
// away from it.
//
//     strahl explain scenes/lecture/13_csg.pov --size 320x180 --sampling center --pixel 163,35
//
// names the leaf that a ray hit, with its line in the scene.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 4.2, -13> right x * image_width / image_height angle 54 look_at <0, 3.05, 0> }
light_source { <-6, 10, -10>, rgb 1 }
light_source { <7, 4, -8>, rgb 0.25 shadowless }
background { srgb <0.93, 0.94, 0.96> }

#declare Leaf = finish { ambient 0.12 diffuse 0.75 phong 0.4 phong_size 40 }
#declare Cube = box { -1, 1 pigment { srgb <0.85, 0.35, 0.22> } finish { Leaf } }
#declare Ball = sphere { 0, 1.35 pigment { srgb <0.25, 0.45, 0.70> } finish { Leaf } }
#declare Drills = union {
  cylinder { -2 * x, 2 * x, 0.6 }
  cylinder { -2 * y, 2 * y, 0.6 }
  cylinder { -2 * z, 2 * z, 0.6 }
  pigment { srgb <0.35, 0.62, 0.30> }
  finish { Leaf }
}
#declare Rounded = intersection { object { Cube } object { Ball } }
#declare Part = difference { object { Rounded } object { Drills } }

#macro Show(Thing, Where) object { Thing rotate <-18, 32, 0> scale 0.72 translate Where } #end
Show(Cube, <-3.6, 1, 0>)
Show(Ball, <-1.2, 1, 0>)
Show(Drills, <2.7, 1, 0>)
Show(Rounded, <-2.4, 3.2, 0>)
Show(Part, <0.2, 5.3, 0>)

#macro Edge(A, B)
  cylinder { A + 2 * z, B + 2 * z, 0.035 pigment { srgb 0.45 } finish { ambient 0.3 diffuse 0.4 } no_shadow }
#end
Edge(<-3.6, 1, 0>, <-2.4, 3.2, 0>)
Edge(<-1.2, 1, 0>, <-2.4, 3.2, 0>)
Edge(<-2.4, 3.2, 0>, <0.2, 5.3, 0>)
Edge(<2.7, 1, 0>, <0.2, 5.3, 0>)
