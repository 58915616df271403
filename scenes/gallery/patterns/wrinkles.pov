// Noise of ten scales, folded.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    wrinkles
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    scale 0.4
  }
  finish { Matt }
}
Bodies(Look)
