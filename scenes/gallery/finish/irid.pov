// A thin film on dull balls: thin, thick, and with turbulence in its thickness.
#include "../gallery.inc"

#macro Ball(X, T, V)
  sphere {
    <X, 0.62, 0>, 0.62
    pigment { srgb <0.70, 0.70, 0.75> }
    finish {
      ambient 0.05 diffuse 0.45 specular 0.6 roughness 0.02
      irid { 0.6 thickness T turbulence V }
    }
  }
#end
Ball(-1.35, 0.6, 0)
Ball(0, 2, 0)
Ball(1.35, 0.9, 0.5)
