// Reflection by Fresnel's equations from the index of refraction: 1.2, 1.5 and 2.4.
#include "../gallery.inc"

plane { y, 0 pigment { checker srgb <0.75, 0.25, 0.18>, srgb <0.95, 0.88, 0.72> scale 0.6 } finish { Matt } }
#macro Ball(X, Index)
  sphere {
    <X, 0.62, 0>, 0.62
    pigment { srgb <0.16, 0.24, 0.34> }
    finish { ambient 0.05 diffuse 0.6 reflection { 0, 1 fresnel on } conserve_energy }
    interior { ior Index }
  }
#end
Ball(-1.35, 1.2) Ball(0, 1.5) Ball(1.35, 2.4)
