// Layers: a partly transparent texture over another one, which shows through.
#include "../gallery.inc"

#declare Worn = texture {
  pigment { srgb <0.85, 0.62, 0.28> }
  finish { ambient 0.05 diffuse 0.5 specular 0.7 roughness 0.02 metallic }
}
texture {
  pigment {
    bozo turbulence 0.6 octaves 4
    color_map { [0.5 srgb <0.12, 0.34, 0.30>] [0.56 rgbt 1] }
    scale 0.4
  }
  finish { ambient 0.05 diffuse 0.8 }
}
Bodies(Worn)
