// A list of points in a plane; each ring ends with the point it began with, and rings within rings are holes.
#include "../gallery.inc"

polygon {
  16,
  <-0.9, 0>, <0.9, 0>, <1.1, 1>, <0.0, 1.85>, <-1.1, 1>, <-0.9, 0>,
  <-0.55, 0.3>, <-0.65, 0.9>, <-0.1, 0.9>, <-0.1, 0.3>, <-0.55, 0.3>,
  <0.2, 0.3>, <0.6, 0.3>, <0.65, 0.85>, <0.2, 1.1>, <0.2, 0.3>
  rotate 18 * y
  texture { Clay }
}
