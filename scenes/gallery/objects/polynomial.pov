// Like `poly`, by its terms: the powers of x, y and z, and the coefficient. Terms not written are 0. New in version 3.8 of the language.
#include "../gallery.inc"

// x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.45 = 0
polynomial {
  4,
  xyz(4, 0, 0): 1, xyz(0, 4, 0): 1, xyz(0, 0, 4): 1,
  xyz(2, 0, 0): -1, xyz(0, 2, 0): -1, xyz(0, 0, 2): -1,
  xyz(0, 0, 0): 0.45
  scale 0.95
  rotate <-12, 28, 0>
  translate y
  texture { Glaze }
}
