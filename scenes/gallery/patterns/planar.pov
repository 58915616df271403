// The distance from the plane y = 0: 1 on the plane, falling to 0 at distance 1.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    planar
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
    scale 0.8
    rotate 30 * z
    translate 0.95 * y
  }
  finish { Matt }
}
Bodies(Look)
