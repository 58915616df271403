// The brightness of a picture; here a picture that the scene makes of a function.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    image_pattern {
      function 64, 64 { pigment { onion frequency 4 scale 0.5 translate <0.5, 0.5, 0> color_map { [0 rgb 0] [1 rgb 1] } } }
      interpolate 2
    }
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    scale 0.6
  }
  finish { Matt }
}
Bodies(Look)
