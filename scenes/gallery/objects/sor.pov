// A surface of revolution: like a lathe, but the heights of the points must increase. That makes it faster, and it is closed at
// its ends.
#include "../gallery.inc"

sor {
  7,
  <0.00, -0.3>, <0.55, 0.0>, <0.80, 0.5>, <0.50, 1.05>, <0.20, 1.4>, <0.30, 1.75>, <0.40, 2.0>
  texture { Glaze }
}
