// Highlights in the colour of the surface: without, half, and with `metallic`.
#include "../gallery.inc"

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.90, 0.66, 0.25> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.5 specular 0.9 roughness 0.03 })
Ball(0, finish { ambient 0.05 diffuse 0.5 specular 0.9 roughness 0.03 metallic 0.5 })
Ball(1.35, finish { ambient 0.05 diffuse 0.5 specular 0.9 roughness 0.03 metallic })
