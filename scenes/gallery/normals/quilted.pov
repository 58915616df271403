// Upholstery.
#include "../gallery.inc"

#declare Look = texture {
  pigment { srgb <0.80, 0.62, 0.45> }
  normal { quilted 0.7 control0 1 control1 1 scale 0.25 }
  finish { ambient 0.08 diffuse 0.7 specular 0.5 roughness 0.02 }
}
Bodies(Look)
