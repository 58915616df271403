// A free-form surface by 16 control points in four rows: it touches the corners, the others pull it. Patches with a common border
// join without a gap.
//
// `S(u, v) = sum w_ij P_ij B_i(u) B_j(v) / sum w_ij B_i(u) B_j(v)` for u and v from 0 to 1, with the points `P`, their weights `w` (1 if none is
// written) and the Bernstein polynomials of degree 3, `B_i(t) = binomial(3, i) t^i (1 - t)^(3 - i)`.
//
// Limits: it has no inside, so it cuts nothing. Weights are greater than 0, and none is more than 10^9 times another. Where all of the surface is
// seen as a line, no ray hits it.
//
// G. Farin, Curves and Surfaces for CAGD, chapters 14 and 17.
#include "../gallery.inc"

bicubic_patch {
  type 1 u_steps 4 v_steps 4
  <-1.3, 0.6, 0>, <-0.6, 1.3, 0.9>, <0.1, 0.1, -0.9>, <0.7, 0.8, 0>,
  <-1.2, 1.0, 0>, <-0.5, 1.6, 0.9>, <0.3, 0.6, -0.9>, <0.9, 1.1, 0.1>,
  <-1.0, 1.4, 0>, <-0.4, 2.1, 0.6>, <0.5, 1.0, -0.8>, <1.1, 1.5, 0.2>,
  <-0.9, 1.9, -0.5>, <-0.3, 2.3, 0.5>, <0.6, 1.4, -0.5>, <1.2, 2.0, 0>
  texture {
    uv_mapping
    pigment {
      checker srgb <0.84, 0.42, 0.25>, srgb <0.93, 0.88, 0.76>
      scale 1/8
    }
    finish { ambient 0.08 diffuse 0.75 specular 0.35 roughness 0.02 }
  }
}
