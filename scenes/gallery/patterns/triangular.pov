// Triangles of six colours in the xz plane.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    triangular
      srgb <0.80, 0.30, 0.20> srgb <0.95, 0.62, 0.30> srgb <0.95, 0.85, 0.50>
      srgb <0.45, 0.60, 0.35> srgb <0.25, 0.45, 0.55> srgb <0.35, 0.25, 0.45>
    scale 0.45
    rotate 90 * x
  }
  finish { Matt }
}
Bodies(Look)
