// Menger's sponge: of 27 cells the seven in the middle are taken away, and so on in each of the 20 others, here six times: 64 million cells, none
// of which is stored. The corner cut off by a plane shows stars.
#declare Gallery_Points = 5;
#include "../gallery.inc"

intersection {
  menger { -1, 1, 6 }
  plane { <1, 1, -1>, 0.25 }
  rotate -35 * y
  translate y
  texture { Ivory }
}
