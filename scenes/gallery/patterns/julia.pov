// The Julia set of a point.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    julia <-0.75, 0.13>, 80
    color_map { [0.0 srgb <0.06, 0.12, 0.25>] [0.2 srgb <0.35, 0.55, 0.55>] [0.6 srgb <0.98, 0.88, 0.60>] [1.0 srgb <0.60, 0.15, 0.10>] }
    scale 0.55
    translate <-0.8, 0.95, 0>
  }
  finish { Matt }
}
Bodies(Look)
