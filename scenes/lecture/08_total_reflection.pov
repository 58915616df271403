// Total reflection: where sin a2 would exceed 1 there is no transparency ray, and all light is reflected.
//
// A look into a pool from below: the world above is seen within a circle, the cone of 48.6 degrees that Snell's law leaves; outside it
// the surface of the water is a mirror, and shows the tiles of the floor.
//
//     strahl explain scenes/lecture/08_total_reflection.pov --size 320x180 --sampling center --pixel 20,60
//
// reports total reflection at the surface of the water, with the value of sin a2 that Snell's law would need.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 0.6, -3.4> right x * image_width / image_height angle 95 look_at <0, 2.2, 0> }
light_source { <-6, 14, -4>, rgb 1.1 }
background { srgb <0.62, 0.78, 0.95> }
// The pool is full up to y = 3.
box {
  <-9, -0.01, -9>, <9, 3, 9>
  pigment { rgbf <0.90, 0.97, 1, 0.98> }
  finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.333 }
}
// The floor: fields that fade into their mean colour far away, where they are smaller than pixels.
plane {
  y, 0
  pigment {
    cylindrical
    pigment_map { [0 rgb <0.318, 0.479, 0.525>] [0.65 checker srgb <0.20, 0.45, 0.55>, srgb <0.80, 0.90, 0.90> scale 0.7 / 14] }
    scale 14
  }
  finish { ambient 0.25 diffuse 0.6 }
}
sphere { <-0.9, 1.1, -0.4>, 0.5 pigment { srgb <0.95, 0.65, 0.15> } finish { ambient 0.2 diffuse 0.7 } }
sphere { <1.3, 0.85, 0.8>, 0.6 pigment { srgb <0.85, 0.25, 0.18> } finish { ambient 0.2 diffuse 0.7 } }
#for (I, 0, 5)
  cylinder { <2.6, 3.2, 0>, <2.6, 6, 0>, 0.25 rotate 60 * I * y pigment { srgb <0.55, 0.40, 0.25> } finish { ambient 0.2 diffuse 0.7 } }
#end
