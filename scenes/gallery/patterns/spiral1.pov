// Arms that wind around the z axis; the number says how many.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    spiral1 4
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
    scale 0.5
    translate <-0.8, 1, 0>
  }
  finish { Matt }
}
Bodies(Look)
