// Products of sines: round spots in space.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    leopard
    color_map { [0.0 srgb <0.95, 0.80, 0.48>] [0.35 srgb <0.85, 0.58, 0.25>] [0.5 srgb <0.22, 0.12, 0.06>] [1.0 srgb <0.15, 0.08, 0.05>] }
    scale 0.085
  }
  finish { Matt }
}
Bodies(Look)
