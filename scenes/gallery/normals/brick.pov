// Walls with joints. Any pattern can be a normal.
#include "../gallery.inc"

#declare Look = texture {
  pigment { srgb <0.80, 0.62, 0.45> }
  normal { brick 0.6 brick_size <0.5, 0.2, 0.25> mortar 0.03 }
  finish { ambient 0.08 diffuse 0.7 specular 0.5 roughness 0.02 }
}
Bodies(Look)
