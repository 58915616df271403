// A surface whose points are given by three functions of the parameters u and v.
#declare Gallery_Points = 4;
#include "../gallery.inc"

parametric {
  function { (0.35 + 0.35 * v) * cos(u) },
  function { 0.16 * u + 0.25 * v * sin(3 * u) },
  function { (0.35 + 0.35 * v) * sin(u) }
  <0, 0>, <3.4 * pi, 2>
  contained_by { box { <-1.1, -0.6, -1.1>, <1.1, 2.1, 1.1> } }
  precompute 14 x, y, z
  accuracy 0.002
  translate 0.15 * y
  texture { Clay }
}
