// A slice through a Julia set of quaternions.
#include "../gallery.inc"

julia_fractal {
  <-0.2, 0.8, 0, 0>
  quaternion
  sqr
  max_iteration 8
  precision 60
  rotate <0, 35, 0>
  translate 1.0 * y
  texture { Ivory }
}
