// Light from all directions: 0, 0.25 and 0.5. It brightens the shadows and flattens the form.
#include "../gallery.inc"

#macro Ball(X, A)
  sphere { <X, 0.62, 0>, 0.62 pigment { srgb <0.84, 0.42, 0.25> } finish { ambient A diffuse 0.6 } }
#end
Ball(-1.35, 0) Ball(0, 0.25) Ball(1.35, 0.5)
