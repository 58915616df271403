// An outline in the xz plane, extruded along y; rings within rings are holes. With `conic_sweep` it tapers to a point.
#include "../gallery.inc"

// A star with a hole.
prism {
  linear_sweep
  linear_spline
  0, 0.5, 16,
  #for (I, 0, 10)
    #local R = (mod(I, 2) ? 0.62 : 1.25);
    <R * sin(2 * pi * mod(I, 10) / 10), R * cos(2 * pi * mod(I, 10) / 10)>,
  #end
  <-0.25, -0.25>, <0.25, -0.25>, <0.25, 0.25>, <-0.25, 0.25>, <-0.25, -0.25>
  scale 0.88
  rotate <-62, 0, 0>
  rotate 18 * y
  translate <0.1, 0.95, 0.2>
  texture { Clay }
}
