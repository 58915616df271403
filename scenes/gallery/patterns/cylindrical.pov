// The distance from the y axis: 1 on the axis, falling to 0 at distance 1.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    cylindrical
    frequency 3
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
    scale 1.6
    rotate 90 * x
    translate <-0.3, 1.1, 0>
  }
  finish { Matt }
}
Bodies(Look)
