// Hexagonal columns of three colours along y.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    hexagon srgb <0.80, 0.32, 0.22>, srgb <0.95, 0.82, 0.50>, srgb <0.28, 0.45, 0.50>
    scale 0.22
    rotate 90 * x
  }
  finish { Matt }
}
Bodies(Look)
