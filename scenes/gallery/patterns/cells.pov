// Cubes, each with a random number between 0 and 1.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    cells
    color_map { [0.0 srgb <0.08, 0.16, 0.32>] [0.5 srgb <0.30, 0.58, 0.70>] [1.0 srgb <0.95, 0.97, 0.92>] }
    scale 0.33
  }
  finish { Matt }
}
Bodies(Look)
