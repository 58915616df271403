// The brightness of another pigment.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    pigment_pattern {
      checker rgb 0, rgb 1
      scale 0.4
      warp { turbulence 0.35 }
    }
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
  }
  finish { Matt }
}
Bodies(Look)
