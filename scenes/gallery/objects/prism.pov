// An outline in the xz plane, extruded along y; rings within rings are holes. With `conic_sweep` it tapers to a point.
//
// A point is inside if y is between the two heights and `(x, z)` is within an odd number of the curves; with `conic_sweep` it is `(x / y, z / y)`,
// so the outline has its own size at y = 1 and is a point at y = 0. The curves are lines, parabolas, cubics whose slope at each point is that of
// the line between its neighbours, or Bezier curves of four points each.
//
// Limits: the heights differ. A curve ends where its first point comes again; one that does not come back is closed by a line, with a warning.
// There are at least 3 points (`linear_spline`), 5 (`quadratic_spline`), 6 (`cubic_spline`) or 4 (`bezier_spline`). An `open` prism is still a
// solid, whose caps are invisible. There are no texture coordinates.
//
// J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", SIGGRAPH 1983.
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
