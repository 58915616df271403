// Several objects as one, to be moved and textured together.
#include "../gallery.inc"

union {
  cylinder { 0, 0.16 * y, 0.95 }
  cylinder { 0.16 * y, 1.2 * y, 0.14 }
  sphere { 1.5 * y, 0.4 }
  torus { 0.62, 0.09 translate 0.2 * y }
  texture { Clay }
}
