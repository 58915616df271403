// The highlight by the half-way vector, with `roughness` 0.1, 0.02 and 0.002.
#include "../gallery.inc"

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.84, 0.42, 0.25> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.6 specular 0.8 roughness 0.1 })
Ball(0, finish { ambient 0.05 diffuse 0.6 specular 0.8 roughness 0.02 })
Ball(1.35, finish { ambient 0.05 diffuse 0.6 specular 0.8 roughness 0.002 })
