// Balls and cylinders whose fields add up: the surface is where the sum equals the `threshold`. Components of negative strength
// make dents.
#include "../gallery.inc"

blob {
  threshold 0.55
  sphere { <-0.55, 0.75, 0>, 1.05, 1 }
  sphere { <0.55, 0.85, 0>, 1.05, 1 }
  sphere { <0, 1.5, 0.1>, 0.75, 0.9 }
  cylinder { <-1.3, 0.5, -0.2>, <1.3, 0.5, -0.2>, 0.45, 0.8 }
  sphere { <0.05, 0.9, -0.95>, 0.7, -1 }
  texture { Clay }
}
