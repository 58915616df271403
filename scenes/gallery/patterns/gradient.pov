// Rises from 0 to 1 along a direction and repeats.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    gradient y
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    scale 0.5
  }
  finish { Matt }
}
Bodies(Look)
