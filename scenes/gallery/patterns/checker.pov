// Cubes of two alternating colours.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    checker srgb <0.20, 0.24, 0.30>, srgb <0.93, 0.88, 0.78>
    scale 0.33
  }
  finish { Matt }
}
Bodies(Look)
