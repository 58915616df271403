// Cubes like upholstery; two numbers control the slopes.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    quilted
    control0 0.3
    control1 1
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    scale 0.33
  }
  finish { Matt }
}
Bodies(Look)
