// Grain: every point is darkened at random. It is no pattern, so its size does not scale with the object.
#include "../gallery.inc"

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.84, 0.42, 0.25> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.7 crand 0 })
Ball(0, finish { ambient 0.05 diffuse 0.7 crand 0.1 })
Ball(1.35, finish { ambient 0.05 diffuse 0.7 crand 0.3 })
