// Parallel primary rays: orthographic projection.
//
// All rays are normal to the plane of the picture. The same columns as before are all of one height, and parallel lines stay parallel.
//
//     strahl explain scenes/lecture/03_orthographic.pov --size 320x180 --sampling center --pixel 40,120
//     strahl explain scenes/lecture/03_orthographic.pov --size 320x180 --sampling center --pixel 280,120
//
// show two primary rays, from different places in the same direction.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { orthographic location <-6, 7, -8> right 11 * x * image_width / image_height up 11 * y look_at <0, 0.3, 4> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.72, 0.82, 0.93> }
plane { y, 0 pigment { checker srgb <0.55, 0.60, 0.66>, srgb <0.93, 0.91, 0.86> } finish { ambient 0.1 diffuse 0.75 } }

#for (I, 0, 5)
  cylinder { <-1.6, 0, 0>, <-1.6, 1.5, 0>, 0.28 translate 1.8 * I * z pigment { srgb <0.80, 0.42, 0.25> } finish { ambient 0.1 diffuse 0.75 } }
  cylinder { <1.6, 0, 0>, <1.6, 1.5, 0>, 0.28 translate 1.8 * I * z pigment { srgb <0.25, 0.48, 0.62> } finish { ambient 0.1 diffuse 0.75 } }
#end
