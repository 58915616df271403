// An outline rotated about the y axis; its points are joined by lines or splines.
#include "../gallery.inc"

lathe {
  cubic_spline
  8,
  <0.0, -0.2>, <0.55, 0.0>, <0.75, 0.45>, <0.48, 1.0>, <0.24, 1.35>, <0.32, 1.65>, <0.52, 1.85>, <0.6, 2.0>
  texture { Clay }
}
