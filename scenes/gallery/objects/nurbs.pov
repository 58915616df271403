// A NURBS surface: control points with weights on two lists of knots. Its weighted circle is exact, and loops of curves cut it:
// here a wavy border and round holes, at any size without facets.
//
// `S(u, v) = sum w_ij P_ij N_i(u) N_j(v) / sum w_ij N_i(u) N_j(v)` with the points `P`, their weights `w` and the B-splines `N` on the knots `t`:
// `N_i,0` is 1 from `t_i` to `t_(i+1)` and 0 elsewhere, and `N_i,p(u) = (u - t_i) / (t_(i+p) - t_i) N_i,p-1(u) + (t_(i+p+1) - u) / (t_(i+p+1) -
// t_(i+1)) N_(i+1),p-1(u)`.
//
// Limits: degrees are from 1 to 9; there are 8388608 control points after knots are inserted, at most; no weight is more than 10^9 times another.
// Only surfaces that are closed and not trimmed have an inside, or several together as a `brep`. Two surfaces that are trimmed along different
// curves are as close there as the curves are.
//
// L. Piegl, W. Tiller, The NURBS Book, 2nd ed., chapters 2 to 4.
#include "../gallery.inc"

// A full circle of four quarters: nine points, their weights, their knots.
#declare Circle = array[9] { <1, 0>, <1, 1>, <0, 1>, <-1, 1>, <-1, 0>, <-1, -1>, <0, -1>, <1, -1>, <1, 0> }
#declare Weight = function(i) { select(mod(i, 2), 1, 1, sqrt(0.5)) }
#macro Ring(Radius, Height)
  row {
    #for (I, 0, 8)
      <Radius * Circle[I].x, Height, Radius * Circle[I].y, Weight(I)>
    #end
  }
#end
#macro Round(Middle, Size)
  curve {
    degree 2
    knots { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }
    #for (I, 0, 8)
      <Middle.u + Size.u * Circle[I].x, Middle.v + Size.v * Circle[I].y, Weight(I)>
    #end
  }
#end

nurbs {
  degree <2, 3>
  u_knots { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }
  Ring(0.05, 0.02) Ring(0.75, 0.00) Ring(1.35, 0.75) Ring(0.75, 1.35) Ring(0.55, 1.75) Ring(0.95, 2.05)
  // The border: down to the foot, up to a wave.
  trim {
    curve { <0, 3>, <0, 0>, <4, 0>, <4, 3> }
    curve { degree 3 <4, 3>, #for (I, 0, 15) <4 - 0.25 * I - 0.125, 3 - 0.5 * mod(I, 2)> #end <0, 3> }
  }
  #for (I, 0, 11)
    hole { Round(<(I + 0.5) / 3, 1.15 + 0.5 * mod(I, 2)>, <0.11, 0.13>) }
  #end
  texture { Glaze }
  interior_texture { Ivory }
}
