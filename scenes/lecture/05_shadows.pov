// Shadow rays: p + t (s - p) with the light's position s. The light counts only if there is no intersection with 0 < t < 1.
//
// The ball hides the lamp from a part of the floor. The pane of red glass is hit as well, but lets a part of the light through: its
// shadow is red. The lamp itself is visible (`looks_like`), and does not block its own light.
//
//     strahl explain scenes/lecture/05_shadows.pov --size 320x180 --sampling center --pixel 225,123
//     strahl explain scenes/lecture/05_shadows.pov --size 320x180 --sampling center --pixel 80,130
//
// show a shadow ray that meets the pane, with the part of the light it lets through, and one that the ball blocks.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 2.6, -6.5> right x * image_width / image_height angle 56 look_at <0, 0.8, 0> }
background { srgb <0.10, 0.11, 0.14> }

light_source {
  <-0.6, 2, 0.4>, rgb 1.6 fade_distance 2.2 fade_power 2
  looks_like { sphere { 0, 0.14 pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 1.5 } } }
}
plane { y, 0 pigment { srgb <0.85, 0.84, 0.80> } finish { ambient 0.05 diffuse 0.8 } }
sphere { <-1.7, 0.9, 0.2>, 0.55 pigment { srgb <0.25, 0.45, 0.62> } finish { ambient 0.05 diffuse 0.7 phong 0.5 phong_size 40 } }
polygon { 5, <-0.6, 0>, <0.6, 0>, <0.6, 1.5>, <-0.6, 1.5>, <-0.6, 0> rotate -60 * y translate <1, 0, 0.2> pigment { rgbf <0.95, 0.2, 0.1, 0.8> } finish { ambient 0.05 diffuse 0.4 } }
