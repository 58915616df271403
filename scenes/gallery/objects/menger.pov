// Menger's sponge: of 27 cells the seven in the middle are taken away, and so on in each of the 20 others, here six times: 64 million cells, none
// of which is stored. The corner cut off by a plane shows stars.
//
// A point is inside if at each level `k` at most one of the digits `floor(3^k x) mod 3`, `floor(3^k y) mod 3` and `floor(3^k z) mod 3` is 1, where
// the box has x, y and z from 0 to 1. The sponge of level `n` has `20^n` cells and `(20 / 27)^n` of the box's volume; without end its dimension is
// `ln 20 / ln 3`, 2.727.
//
// Limits: the level is from 0 to 20. In CSG all crossings of a ray are listed, about 2.2^level: levels above 12 are slow there.
//
// K. Menger, "Allgemeine Räume und Cartesische Räume", Proc. Academy of Amsterdam 29, 1926.
#declare Gallery_Points = 5;
#include "../gallery.inc"

intersection {
  menger { -1, 1, 6 }
  plane { <1, 1, -1>, 0.25 }
  rotate -35 * y
  translate y
  texture { Ivory }
}
