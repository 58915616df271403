// Reflection that increases from the middle to the rim, with `falloff` 1, 3 and 6, as on car paint.
#include "../gallery.inc"

plane { y, 0 pigment { checker srgb <0.75, 0.25, 0.18>, srgb <0.95, 0.88, 0.72> scale 0.6 } finish { Matt } }

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.30, 0.42, 0.55> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.5 reflection { 0, 1 falloff 1 } })
Ball(0, finish { ambient 0.05 diffuse 0.5 reflection { 0, 1 falloff 3 } })
Ball(1.35, finish { ambient 0.05 diffuse 0.5 reflection { 0, 1 falloff 6 } })
