// Phong's highlight, with `phong_size` 5, 40 and 250.
#include "../gallery.inc"

#macro Ball(X, Look)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.84, 0.42, 0.25> } finish { Look } }
#end
Ball(-1.35, finish { ambient 0.05 diffuse 0.6 phong 0.8 phong_size 5 })
Ball(0, finish { ambient 0.05 diffuse 0.6 phong 0.8 phong_size 40 })
Ball(1.35, finish { ambient 0.05 diffuse 0.6 phong 0.8 phong_size 250 })
