// Mirrors of 5, 30 and 80 percent.
#include "../gallery.inc"

plane { y, 0 pigment { checker srgb <0.75, 0.25, 0.18>, srgb <0.95, 0.88, 0.72> scale 0.6 } finish { Matt } }

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.30, 0.42, 0.55> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.6 reflection 0.05 })
Ball(0, finish { ambient 0.05 diffuse 0.4 reflection 0.3 })
Ball(1.35, finish { ambient 0 diffuse 0.1 reflection 0.8 })
