// Shadows through coloured glass are filtered: `filter` tints them, `transmit` only weakens them.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source { <-4, 6, -4>, rgb 1.1 }
polygon { 5, <-1.9, 0>, <-0.9, 0>, <-0.9, 1.4>, <-1.9, 1.4>, <-1.9, 0> rotate 20 * y translate <0.25, 0, -1.4> pigment { rgbf <0.95, 0.35, 0.15, 0.85> } finish { diffuse 0.2 } }
polygon { 5, <-0.5, 0>, <0.5, 0>, <0.5, 1.4>, <-0.5, 1.4>, <-0.5, 0> rotate 20 * y translate <0.2, 0, -1.5> pigment { rgbt <0.15, 0.5, 0.85, 0.7> } finish { diffuse 0.3 } }

union {
  sphere { <-1, 0.55, 0.3>, 0.55 }
  box { <-0.4, 0, -0.4>, <0.4, 1.3, 0.4> rotate 30 * y translate <0.25, 0, 0.9> }
  cone { <1.25, 0, 0>, 0.5, <1.25, 1.1, 0>, 0 }
  texture { Ivory }
}
