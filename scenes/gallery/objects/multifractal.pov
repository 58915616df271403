// Isosurfaces of sums over octaves of noise, the functions of fractal terrains: `f_ridged_mf`, `f_hetero_mf` and `f_ridge` on three balls.
#declare Gallery_Points = 2;
#include "../gallery.inc"
#include "functions.inc"

#macro Ball(Relief, Place)
  isosurface {
    function { sqrt(x * x + y * y + z * z) - 0.6 - 0.14 * Relief(x, y, z) }
    contained_by { sphere { 0, 1 } }
    max_gradient 4
    accuracy 0.0005
    scale 0.95
    translate Place
    texture { Clay }
  }
#end
#declare Ridged = function { f_ridged_mf(2 * x, 2 * y, 2 * z, 1, 2.1, 3, 1, 1.5, 2) };
#declare Hetero = function { f_hetero_mf(2 * x, 2 * y, 2 * z, 1, 2.2, 2.5, 0.6, 1, 2) };
#declare Ridge = function { f_ridge(2 * x, 2 * y, 2 * z, 2.1, 3, 0.5, 0.4, 0.8, 2) };
Ball(Ridged, <-1.35, 0.85, 0.4>)
Ball(Hetero, <0, 0.85, -0.3>)
Ball(Ridge, <1.35, 0.85, 0.4>)
