// Light that fades: at `fade_distance` it has its own colour, beyond that it falls off with `fade_power`.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source { <-1.7, 1.6, -1.2>, rgb 2.2 fade_distance 1 fade_power 2 }

union {
  sphere { <-1, 0.55, 0.3>, 0.55 }
  box { <-0.4, 0, -0.4>, <0.4, 1.3, 0.4> rotate 30 * y translate <0.25, 0, 0.9> }
  cone { <1.25, 0, 0>, 0.5, <1.25, 1.1, 0>, 0 }
  texture { Ivory }
}
