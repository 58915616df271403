// The angle around the y axis, from 0 to 1 in a turn.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    radial
    frequency 9
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
    rotate 70 * x
    translate <-0.5, 1.05, 0>
  }
  finish { Matt }
}
Bodies(Look)
