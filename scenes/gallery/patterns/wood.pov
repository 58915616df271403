// Rings around the z axis; a little turbulence makes them look grown.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    wood
    turbulence 0.07
    octaves 3
    color_map { [0.0 srgb <0.78, 0.56, 0.34>] [0.7 srgb <0.62, 0.38, 0.20>] [1.0 srgb <0.42, 0.23, 0.12>] }
    scale 0.16
    rotate <6, 12, 0>
    translate <-0.6, 1.5, 0>
  }
  finish { Matt }
}
Bodies(Look)
