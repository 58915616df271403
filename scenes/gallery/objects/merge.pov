// Several objects as one, without their surfaces inside; the difference is visible only in transparent objects. The left pair
// is a union, the right one a merge.
#include "../gallery.inc"

#declare Clear = texture {
  pigment { rgbf <0.75, 0.9, 0.95, 0.85> }
  finish { ambient 0.02 diffuse 0.1 specular 0.8 roughness 0.002 reflection 0.06 }
}
union {
  sphere { <-0.95, 0.65, 0>, 0.65 }
  sphere { <-0.95, 1.35, 0>, 0.5 }
  texture { Clear }
}
merge {
  sphere { <0.95, 0.65, 0>, 0.65 }
  sphere { <0.95, 1.35, 0>, 0.5 }
  texture { Clear }
}
