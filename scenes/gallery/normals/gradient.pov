// Grooves, shaped by a `slope_map`, which gives height and slope over the value of the pattern.
#include "../gallery.inc"

#declare Look = texture {
  pigment { srgb <0.80, 0.62, 0.45> }
  normal { gradient y 0.6 slope_map { [0 <0, 1>] [0.5 <1, 1>] [0.5 <1, -1>] [1 <0, -1>] } scale 0.2 }
  finish { ambient 0.08 diffuse 0.7 specular 0.5 roughness 0.02 }
}
Bodies(Look)
