// Any formula of x, y and z.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    function { 0.5 + 0.5 * sin(9 * x + 2 * sin(5 * y)) * cos(9 * z) }
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
  }
  finish { Matt }
}
Bodies(Look)
