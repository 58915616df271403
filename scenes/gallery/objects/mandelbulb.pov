// The Mandelbulb: points whose orbit under z^8 + c stays near the origin, where the power multiplies the two angles of a point and raises its length.
// Its surface is where the last point of the orbit is at the bail-out radius; the march towards it is proven by balls.
//
// In spherical coordinates about the z axis `(r, theta, phi)^n = (r^n, n theta, n phi)`. The orbit is `p_1 = c`, `p_(k+1) = p_k^n + c`; the solid
// has the points `c` for which it stays within the radius `2^(1 / (n - 1))` for `max_iteration` steps. With `julia`, `c` is constant, the orbit
// begins at the point, and the radius is `(1 + length(c))^(1 / (n - 1))`.
//
// Limits: the power is a whole number from 2 to 16. Marches are proven down to steps of a fiftieth of the radius over `precision`: parts that are
// thinner along a ray may be missed.
//
// D. White and P. Nylander, 2009; the march as in J. C. Hart, D. J. Sandin, L. H. Kauffman, "Ray tracing deterministic 3-D fractals", SIGGRAPH
// 1989.
#declare Gallery_Points = 3;
#include "../gallery.inc"

mandelbulb {
  8
  max_iteration 3
  precision 60
  rotate <-90, 20, 0>
  translate 1.05 * y
  texture { Clay }
}
