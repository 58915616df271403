// Light that the surface emits, independent of all lights: 0, 0.4 and 0.8. It does not illuminate other objects.
#include "../gallery.inc"

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.98, 0.75, 0.25> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0 diffuse 0.4 emission 0 })
Ball(0, finish { ambient 0 diffuse 0.4 emission 0.4 })
Ball(1.35, finish { ambient 0 diffuse 0.4 emission 0.8 })
