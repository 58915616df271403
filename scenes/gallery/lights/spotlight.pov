// A cone of light: full within `radius`, none beyond `falloff`, both in degrees; `tightness` softens it further.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source { <-3, 5, -3.5>, rgb 1.8 spotlight point_at <0, 0.4, 0.3> radius 11 falloff 17 }
light_source { <6, 4, -6>, rgb 0.12 shadowless }

union {
  sphere { <-1, 0.55, 0.3>, 0.55 }
  box { <-0.4, 0, -0.4>, <0.4, 1.3, 0.4> rotate 30 * y translate <0.25, 0, 0.9> }
  cone { <1.25, 0, 0>, 0.5, <1.25, 1.1, 0>, 0 }
  texture { Ivory }
}
