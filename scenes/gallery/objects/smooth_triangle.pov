// A triangle with a normal for each corner: it is shaded as if it were curved.
#include "../gallery.inc"

smooth_triangle {
  <-1.1, 0.02, 0.1>, <-0.8, -0.1, -0.6>,
  <1.1, 0.02, -0.1>, <0.8, -0.1, -0.6>,
  <0.1, 1.9, 0.2>, <0, 0.8, -0.6>
  texture { Clay }
}
