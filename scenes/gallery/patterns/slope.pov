// The slope of the surface relative to a direction: snow lies where the surface is level.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    slope y
    color_map { [0.5 srgb <0.35, 0.30, 0.28>] [0.68 srgb <0.42, 0.36, 0.30>] [0.74 srgb <0.97, 0.98, 1.0>] }
  }
  finish { Matt }
}
Bodies(Look)
