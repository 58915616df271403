// Soft bumps: the surface stays as it is, but is lit as if it were bumpy.
#include "../gallery.inc"

#declare Look = texture {
  pigment { srgb <0.80, 0.62, 0.45> }
  normal { bumps 0.8 scale 0.12 }
  finish { ambient 0.08 diffuse 0.7 specular 0.5 roughness 0.02 }
}
Bodies(Look)
