// The same marble with `turbulence` 0, 0.3 and 1: the pattern is evaluated at a point that noise has displaced.
#include "../gallery.inc"

#macro Ball(X, T)
  sphere {
    0, 0.62
    pigment { marble turbulence T octaves 5 color_map { [0 srgb <0.16, 0.24, 0.34>] [1 srgb <0.95, 0.93, 0.86>] } scale 0.32 }
    finish { Matt }
    translate <X, 0.62, 0>
  }
#end
Ball(-1.35, 0) Ball(0, 0.3) Ball(1.35, 1)
