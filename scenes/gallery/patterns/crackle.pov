// Distances to random points in space: cells with walls (Worley). `form` weights the distances.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    crackle
    form <-1, 1, 0>
    color_map { [0.00 srgb <0.15, 0.10, 0.08>] [0.06 srgb <0.15, 0.10, 0.08>] [0.10 srgb <0.62, 0.50, 0.36>] [0.5 srgb <0.85, 0.76, 0.60>] }
    scale 0.42
  }
  finish { Matt }
}
Bodies(Look)
