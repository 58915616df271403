// Rings from ten points; as a normal, water after rain.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    ripples
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
    scale 0.22
    frequency 0.6
  }
  finish { Matt }
}
Bodies(Look)
