// Hammered copper: each piece is flat.
#include "../gallery.inc"

#declare Look = texture {
  pigment { srgb <0.85, 0.52, 0.38> }
  normal { facets size 0.3 }
  finish { ambient 0.08 diffuse 0.6 specular 0.7 roughness 0.03 metallic reflection { 0.15 metallic } }
}
Bodies(Look)
