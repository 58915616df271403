// Two colours: outside and inside of an object.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    object {
      union {
        torus { 0.55, 0.14 rotate 90 * x translate <-0.85, 1, -0.8> }
        sphere { <-0.85, 1, -0.9>, 0.25 }
        cylinder { <1, 0.62, -3>, <1, 0.62, 3>, 0.33 }
      }
      srgb <0.93, 0.86, 0.70>
      srgb <0.75, 0.22, 0.18>
    }
  }
  finish { Matt }
}
Bodies(Look)
