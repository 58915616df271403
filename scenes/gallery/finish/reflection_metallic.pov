// Mirror images in the colour of the surface, as metals have them: without, half, and with `metallic`.
#include "../gallery.inc"

plane { y, 0 pigment { checker srgb <0.75, 0.25, 0.18>, srgb <0.95, 0.88, 0.72> scale 0.6 } finish { Matt } }

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.95, 0.70, 0.28> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.2 reflection { 0.7 metallic 0 } })
Ball(0, finish { ambient 0.05 diffuse 0.2 reflection { 0.7 metallic 0.5 } })
Ball(1.35, finish { ambient 0.05 diffuse 0.2 reflection { 0.7 metallic 1 } })
