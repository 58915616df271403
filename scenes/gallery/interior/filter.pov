// Coloured glass: `filter` tints the light that passes, `transmit` lets it pass unchanged, and the rest shows the surface
// itself.
#include "../gallery.inc"

plane { y, 0 pigment { checker srgb <0.35, 0.38, 0.42>, srgb <0.95, 0.92, 0.85> scale 0.5 } finish { Matt } }
#macro Ball(X, C)
  sphere { <X, 0.62, 0>, 0.62 pigment { color C } finish { ambient 0.05 diffuse 0.6 specular 0.7 roughness 0.004 } }
#end
Ball(-1.35, rgbf <0.95, 0.40, 0.15, 0.9>) Ball(0, rgbt <0.95, 0.40, 0.15, 0.7>) Ball(1.35, rgbft <0.95, 0.40, 0.15, 0.4, 0.3>)
