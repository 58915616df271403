// The largest coordinate: 1 at the origin, falling to 0 at the faces of a cube with half-width 1.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    boxed
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
    scale 1.1
    translate <-0.5, 1.1, -0.4>
  }
  finish { Matt }
}
Bodies(Look)
