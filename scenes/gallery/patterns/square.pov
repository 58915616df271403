// Squares of four colours in the xz plane.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    square
      srgb <0.80, 0.30, 0.20> srgb <0.95, 0.80, 0.45> srgb <0.30, 0.50, 0.55> srgb <0.92, 0.90, 0.84>
    scale 0.3
    rotate 90 * x
  }
  finish { Matt }
}
Bodies(Look)
