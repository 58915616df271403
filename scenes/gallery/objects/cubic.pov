// A surface of the third degree by its 20 coefficients: here y = x^3 - 3 x z^2, the monkey saddle.
#include "../gallery.inc"

cubic {
  < 1, 0, 0, 0, 0, 0, 0, -3, 0, 0,
    0, 0, 0, 0, 0, -1, 0, 0, 0, 0 >
  clipped_by { cylinder { -y, y, 1 } }
  translate y
  texture { Glaze }
}
