// An object at the position of the light that does not block its light: a visible lamp.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source {
  <-0.1, 1.75, -0.5>, rgb 1.6 fade_distance 1.2 fade_power 2
  looks_like { sphere { 0, 0.16 pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 1.2 } } }
}
light_source { <6, 4, -6>, rgb 0.15 shadowless }

union {
  sphere { <-1, 0.55, 0.3>, 0.55 }
  box { <-0.4, 0, -0.4>, <0.4, 1.3, 0.4> rotate 30 * y translate <0.25, 0, 0.9> }
  cone { <1.25, 0, 0>, 0.5, <1.25, 1.1, 0>, 0 }
  texture { Ivory }
}
