// The index of refraction: 1 (no refraction), 1.33 as of water, 1.5 as of glass.
#include "../gallery.inc"

plane { y, 0 pigment { checker srgb <0.20, 0.30, 0.42>, srgb <0.95, 0.92, 0.85> scale 0.5 } finish { Matt } }
#macro Ball(X, Index)
  sphere {
    <X, 0.62, 0>, 0.62
    pigment { rgbf <0.97, 0.98, 0.98, 0.95> }
    finish { ambient 0 diffuse 0.05 specular 0.7 roughness 0.001 reflection 0.04 }
    interior { ior Index }
  }
#end
Ball(-1.35, 1) Ball(0, 1.33) Ball(1.35, 1.5)
