// Squares, triangles and hexagons with bevelled edges in the xz plane.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    tiling 16
    color_map {
      [0.000 srgb <0.80, 0.42, 0.25>] [0.250 srgb <0.70, 0.32, 0.18>] [0.333 srgb <0.90, 0.88, 0.82>]
      [0.334 srgb <0.30, 0.50, 0.55>] [0.550 srgb <0.20, 0.40, 0.45>] [0.666 srgb <0.90, 0.88, 0.82>]
      [0.667 srgb <0.92, 0.78, 0.45>] [0.950 srgb <0.85, 0.68, 0.35>] [1.000 srgb <0.90, 0.88, 0.82>]
    }
    scale 0.3
    rotate 90 * x
  }
  finish { Matt }
}
Bodies(Look)
