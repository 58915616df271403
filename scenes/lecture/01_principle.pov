// The principle: light is followed backwards, from the eye to the light source.
//
// One picture with every kind of ray: primary rays see the floor, the mirror and the glass ball; shadow rays find the light or
// something in its way; the mirror sends reflection rays, the glass transparency rays. What happens at a hit does not depend on how
// the ray came there, so the mirror shows the glass and the glass the mirror.
//
//     strahl explain scenes/lecture/01_principle.pov --size 320x180 --sampling center --pixel 205,100
//
// prints the tree of rays of a pixel on the glass ball: first in outline, with what each ray adds, then ray by ray with every number.
// `--format dot` makes it a graph.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 2, -6> right x * image_width / image_height angle 58 look_at <0, 0.75, 0> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.72, 0.82, 0.93> }
// The floor: fields that fade into their mean colour far away, where they are smaller than pixels.
plane {
  y, 0
  pigment {
    cylindrical
    pigment_map { [0 rgb <0.555, 0.563, 0.552>] [0.6 checker srgb <0.55, 0.60, 0.66>, srgb <0.93, 0.91, 0.86> scale 1 / 18] }
    scale 18
  }
  finish { ambient 0.1 diffuse 0.75 }
}

sphere {
  <-1.2, 1, 0.6>, 1
  pigment { srgb <0.45, 0.48, 0.52> }
  finish { ambient 0.02 diffuse 0.2 phong 0.8 phong_size 120 reflection 0.7 }
}
sphere {
  <1.0, 0.8, -0.6>, 0.8
  pigment { rgbf <0.95, 0.98, 1, 0.9> }
  finish { ambient 0 diffuse 0.05 phong 0.8 phong_size 200 reflection 0.08 }
  interior { ior 1.5 }
}
sphere {
  <0.1, 0.35, -1.9>, 0.35
  pigment { srgb <0.85, 0.25, 0.15> }
  finish { ambient 0.1 diffuse 0.7 phong 0.5 phong_size 40 }
}
