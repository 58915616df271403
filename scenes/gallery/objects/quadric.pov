// All surfaces of the second degree by their ten coefficients: here a hyperboloid, clipped to a vase.
#include "../gallery.inc"

quadric {
  <1, -0.55, 1>, <0, 0, 0>, <0, 0, 0>, -0.16
  translate 1.05 * y
  clipped_by { box { <-2, 0, -2>, <2, 1.9, 2> } }
  texture { Clay }
}
