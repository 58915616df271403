// Reflection rays: r = 2 (n.v) n - v. The shading found in that direction is added with the weight kr.
//
// Two mirrors face each other, so the tree of rays is deep: images of images, each darker by kr. Curved mirrors need no code of their
// own, as reflection looks at the normal of one point only.
//
//     strahl render scenes/lecture/06_reflection.pov --size 320x180 --max-depth 2 -o two.png
//     strahl explain scenes/lecture/06_reflection.pov --size 320x180 --sampling center --pixel 80,60
//
// end the tree after one mirror image, and print the whole tree of a pixel that looks from mirror to mirror.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0.7, 2.3, -4.6> right x * image_width / image_height angle 70 look_at <0, 0.9, 0.4> }
light_source { <-2, 7, -4>, rgb 1 }
background { srgb <0.72, 0.82, 0.93> }

// The floor: fields that fade into their mean colour far away, where they are smaller than pixels.
plane {
  y, 0
  pigment {
    cylindrical
    pigment_map { [0 rgb <0.555, 0.563, 0.552>] [0.5 checker srgb <0.55, 0.60, 0.66>, srgb <0.93, 0.91, 0.86> scale 0.8 / 13] }
    scale 13
  }
  finish { ambient 0.1 diffuse 0.75 }
}
#macro Mirror(Where, Turn)
  union {
    box { <-1.7, 0.05, 0>, <1.7, 2.3, 0.05> pigment { srgb 0.05 } finish { ambient 0 diffuse 0.1 reflection 0.85 } }
    box { <-1.8, 0, 0.01>, <1.8, 2.4, 0.12> pigment { srgb <0.45, 0.26, 0.14> } finish { ambient 0.1 diffuse 0.7 } }
    rotate Turn * y
    translate Where
  }
#end
Mirror(<-2.2, 0, 1.2>, -68)
Mirror(<2.2, 0, 1.2>, 68)
sphere { <0, 0.7, 0.9>, 0.7 pigment { srgb 0.1 } finish { ambient 0 diffuse 0.1 phong 0.8 phong_size 200 reflection 0.85 } }
cone { <-0.75, 0, -0.7>, 0.32, <-0.75, 0.9, -0.7>, 0 pigment { srgb <0.85, 0.35, 0.18> } finish { ambient 0.1 diffuse 0.75 } }
box { <-0.3, 0, -0.3>, <0.3, 0.6, 0.3> rotate 25 * y translate <0.95, 0, -0.6> pigment { srgb <0.25, 0.50, 0.35> } finish { ambient 0.1 diffuse 0.75 } }
