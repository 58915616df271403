// A pattern chooses between whole textures: dull and polished fields.
#include "../gallery.inc"

#declare Dull = texture { pigment { srgb <0.45, 0.20, 0.14> } finish { ambient 0.08 diffuse 0.8 } }
#declare Polished = texture { pigment { srgb <0.90, 0.78, 0.50> } finish { ambient 0.05 diffuse 0.4 specular 0.8 roughness 0.01 metallic reflection 0.25 } }
#declare Look = texture {
  onion
  texture_map { [0.5 Dull] [0.5 Polished] }
  scale 0.3
  translate <-0.3, 1, 0>
}
Bodies(Look)
