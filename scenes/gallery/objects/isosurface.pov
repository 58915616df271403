// The points where a function is 0, within a box or a ball. Any formula makes a shape.
#include "../gallery.inc"

isosurface {
  function { sin(6 * x) * cos(6 * y) + sin(6 * y) * cos(6 * z) + sin(6 * z) * cos(6 * x) }
  contained_by { sphere { 0, 1 } }
  max_gradient 16
  accuracy 0.0005
  translate y
  texture { Clay }
}
