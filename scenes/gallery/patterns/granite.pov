// Noise of six scales, added up.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    granite
    color_map { [0.0 srgb <0.20, 0.18, 0.18>] [0.3 srgb <0.62, 0.45, 0.40>] [0.6 srgb <0.85, 0.80, 0.76>] [1.0 srgb <0.95, 0.93, 0.90>] }
    scale 0.7
  }
  finish { Matt }
}
Bodies(Look)
