// Scales.
#include "../gallery.inc"

#declare Look = texture {
  pigment { srgb <0.80, 0.62, 0.45> }
  normal { crackle 0.8 scale 0.24 }
  finish { ambient 0.08 diffuse 0.7 specular 0.5 roughness 0.02 }
}
Bodies(Look)
