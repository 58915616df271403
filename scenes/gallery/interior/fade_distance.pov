// Glass that absorbs light on its way: thick parts are dark, and the glass becomes clearer as `fade_distance` grows: 0.3, 1 and
// 3.
#include "../gallery.inc"

#macro Ball(X, Depth)
  sphere {
    <X, 0.62, 0>, 0.62
    pigment { rgbf <1, 1, 1, 1> }
    finish { ambient 0 diffuse 0 specular 0.7 roughness 0.001 reflection { 0, 1 fresnel on } conserve_energy }
    interior { ior 1.3 fade_distance Depth fade_power 1001 fade_color rgb <0.12, 0.55, 0.30> }
  }
#end
Ball(-1.35, 0.3) Ball(0, 1) Ball(1.35, 3)
