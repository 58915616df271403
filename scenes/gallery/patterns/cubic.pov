// Six values for the six sides of a cube around the origin.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    cubic
    color_map {
      [0 / 6 srgb <0.85, 0.30, 0.22>] [1 / 6 srgb <0.85, 0.30, 0.22>]
      [1 / 6 srgb <0.95, 0.75, 0.30>] [2 / 6 srgb <0.95, 0.75, 0.30>]
      [2 / 6 srgb <0.45, 0.65, 0.30>] [3 / 6 srgb <0.45, 0.65, 0.30>]
      [3 / 6 srgb <0.25, 0.55, 0.65>] [4 / 6 srgb <0.25, 0.55, 0.65>]
      [4 / 6 srgb <0.30, 0.30, 0.60>] [5 / 6 srgb <0.30, 0.30, 0.60>]
      [5 / 6 srgb <0.92, 0.88, 0.80>] [1 srgb <0.92, 0.88, 0.80>]
    }
    rotate <35, 40, 0>
    translate <-0.78, 0.95, 0.1>
  }
  finish { Matt }
}
Bodies(Look)
