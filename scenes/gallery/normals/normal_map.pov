// A pattern chooses between normals.
#include "../gallery.inc"

#declare Look = texture {
  pigment { srgb <0.80, 0.62, 0.45> }
  normal { gradient y normal_map { [0.45 bumps 1 scale 0.1] [0.55 ripples 0.8 scale 0.2] } scale 1.1 translate 0.45 * y }
  finish { ambient 0.08 diffuse 0.7 specular 0.5 roughness 0.02 }
}
Bodies(Look)
