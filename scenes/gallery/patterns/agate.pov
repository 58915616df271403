// Bands of noise with a separate turbulence, `agate_turb`.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    agate
    agate_turb 0.8
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    scale 0.6
  }
  finish { Matt }
}
Bodies(Look)
