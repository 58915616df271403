// Three lights, red, green and blue: where all of them shine the floor is white; each shadow has the mixed colour of the other
// two.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source { <-2.5, 6, -4>, rgb <0.9, 0, 0> }
light_source { <0, 6, -4.5>, rgb <0, 0.9, 0> }
light_source { <2.5, 6, -4>, rgb <0, 0, 0.9> }

union {
  sphere { <-1, 0.55, 0.3>, 0.55 }
  box { <-0.4, 0, -0.4>, <0.4, 1.3, 0.4> rotate 30 * y translate <0.25, 0, 0.9> }
  cone { <1.25, 0, 0>, 0.5, <1.25, 1.1, 0>, 0 }
  texture { Ivory }
}
