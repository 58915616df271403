// Fractals of the renormalisation of magnets, of two types; as the Mandelbrot or a Julia set.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    magnet 1 mandel 60
    color_map { [0.0 srgb <0.10, 0.10, 0.20>] [0.1 srgb <0.45, 0.35, 0.60>] [0.4 srgb <0.98, 0.85, 0.60>] [1.0 srgb <0.10, 0.05, 0.08>] }
    scale 0.42
    translate <-1.25, 0.95, 0>
  }
  finish { Matt }
}
Bodies(Look)
