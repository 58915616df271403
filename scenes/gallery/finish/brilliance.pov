// How the diffuse reflection falls off with the angle: 0.5, 1 and 4. High values look metallic.
#include "../gallery.inc"

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.84, 0.42, 0.25> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.8 brilliance 0.5 })
Ball(0, finish { ambient 0.05 diffuse 0.8 brilliance 1 })
Ball(1.35, finish { ambient 0.05 diffuse 0.8 brilliance 4 })
