// The Mandelbulb: points whose orbit under z^8 + c stays near the origin, where the power multiplies the two angles of a point and raises its length.
// Its surface is where the last point of the orbit is at the bail-out radius; the march towards it is proven by balls.
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
