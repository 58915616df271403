// An arc turned about an axis: two ends with a radius each, and the radius of the arc. It was added in version 3.8 of the language.
//
// `(d + e)^2 + (t - h)^2 = r^2` between the ends, where `d` is the distance from the axis, `t` the way along it and `r` the radius of the arc; `h`
// and `e`, which is not negative, are such that the arc goes through both rims. So it is the inner part of a torus that meets itself, a spindle
// torus.
//
// Limits: the least radius of the arc is that of the ball through both rims, `r^2 = a^2 + ((L^2 + b^2 - a^2) / (2 L))^2` with the radii `a` and `b`
// of the ends at the distance `L`; a smaller one is replaced by it, with a warning. An `open` lemon is still a solid, whose caps are invisible.
//
// The reference manual of POV-Ray 3.8, section Lemon.
#include "../gallery.inc"

lemon { <-1.25, 0.62, 0.2>, 0, <0.55, 0.62, -0.1>, 0, 0.98 texture { Clay } }
lemon { <1.0, 0, 0.3>, 0.3, <1.0, 1.7, 0.3>, 0.12, 1.4 texture { Glaze } }
lemon { <0.5, 0.02, -1.1>, 0.34, <0.5, 0.46, -1.1>, 0.3, 0.5 open texture { Ivory } }
