// The distance from the origin: 1 at the origin, falling to 0 at distance 1.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    spherical
    frequency 2
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    scale 1.6
    translate <-0.3, 1.1, -0.6>
  }
  finish { Matt }
}
Bodies(Look)
