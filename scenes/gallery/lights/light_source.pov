// A point light: a position and a colour. Its shadows are sharp.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source { <-4, 6, -4>, rgb 1.1 }

union {
  sphere { <-1, 0.55, 0.3>, 0.55 }
  box { <-0.4, 0, -0.4>, <0.4, 1.3, 0.4> rotate 30 * y translate <0.25, 0, 0.9> }
  cone { <1.25, 0, 0>, 0.5, <1.25, 1.1, 0>, 0 }
  texture { Ivory }
}
