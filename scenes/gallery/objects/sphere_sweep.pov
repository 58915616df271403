// A ball that moves along lines or a spline, and may change its size on the way.
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
