// The same, but each arm rises and falls.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    spiral2 3
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    scale 0.5
    translate <-0.8, 1, 0>
  }
  finish { Matt }
}
Bodies(Look)
