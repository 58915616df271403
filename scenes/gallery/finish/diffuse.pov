// The part of the light that is scattered evenly: 0.3, 0.6 and 0.9.
#include "../gallery.inc"

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.84, 0.42, 0.25> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.3 })
Ball(0, finish { ambient 0.05 diffuse 0.6 })
Ball(1.35, finish { ambient 0.05 diffuse 0.9 })
