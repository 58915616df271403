// The Mandelbrot set: the number of iterations until a point escapes. `julia` and `magnet` are related.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    mandel 60
    color_map { [0.0 srgb <0.05, 0.10, 0.30>] [0.15 srgb <0.30, 0.60, 0.80>] [0.4 srgb <0.98, 0.90, 0.60>] [0.999 srgb <0.85, 0.30, 0.10>] [1.0 srgb <0.05, 0.05, 0.08>] }
    scale 0.55
    translate <-0.55, 1.0, 0>
  }
  finish { Matt }
}
Bodies(Look)
