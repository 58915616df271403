// A surface of the fourth degree by its 35 coefficients: here the lemniscate of Gerono rotated about its axis.
#include "../gallery.inc"

// x^4 - x^2 + y^2 + z^2 = 0
quartic {
  < 1, 0, 0, 0, 0, 0, 0, 0, 0, -1,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 1, 0, 0, 0, 0,
    0, 0, 1, 0, 0 >
  sturm
  scale <1.25, 1.25, 1.25>
  rotate <0, 20, 58>
  translate <0, 1.05, 0>
  texture { Clay }
}
