// An egg by the radii of its bottom and its top: two balls, and between them an arc that touches both.
//
// With the distance `d` from the y axis, the radii `b` and `t`, and `r = 2 max(b, t)`: the balls are `d^2 + y^2 = b^2` and `d^2 + (y - b)^2 = t^2`,
// and the part between them is `(d + e)^2 + (y - h)^2 = r^2` with `h = ((r - b)^2 - (r - t)^2 + b^2) / (2 b)` and `e^2 = (r - b)^2 - h^2`, so that
// it touches both.
//
// Limits: a radius may be 0, but not both. If `t` is at least `2 b`, only the top ball is left.
//
// The reference manual of POV-Ray 3.7, section Ovus.
#include "../gallery.inc"

ovus { 0.75, 0.42 translate <-0.7, 0.75, 0> texture { Ivory } }
ovus { 0.4, 0.62 rotate -100 * z translate <0.75, 0.56, -0.7> texture { Clay } }
