// A ball that moves along lines or a spline, and may change its size on the way.
//
// The solid is the union of the balls `length(p - c(s)) <= abs(r(s))` for all `s`. Centre `c` and radius `r` run along the same spline: along
// lines, along a uniform cubic B-spline, or (`cubic_spline`) along cubics whose slope at each ball is that of the line between its neighbours. For
// a cubic, a ray meets the balls between roots of a polynomial of degree 6; where it enters and leaves them is greatest or least at roots of one of
// degree 10.
//
// Limits: `linear_spline` needs two balls, the others four; a cubic spline does not reach the first and the last one. `tolerance` is read, and
// changes nothing. There are no texture coordinates.
//
// J. J. van Wijk, "Ray tracing objects defined by sweeping a sphere", Computers & Graphics 9(3), 1985; for the cubics E. Catmull, R. Rom, "A class
// of local interpolating splines", 1974.
#include "../gallery.inc"

sphere_sweep {
  b_spline
  16,
  #for (I, -1, 14)
    <0.85 * cos(0.9 * I) * (1 - 0.03 * I), 0.25 + 0.125 * I, 0.85 * sin(0.9 * I) * (1 - 0.03 * I)>, 0.24 - 0.012 * I
  #end
  tolerance 0.000001
  texture { Clay }
}
