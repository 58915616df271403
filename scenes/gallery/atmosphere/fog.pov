// Fog of constant density: the farther an object, the more it takes the colour of the fog.
#declare Gallery_Floor = 0;
#include "../gallery.inc"

fog { distance 9 color srgb <0.80, 0.84, 0.90> }
plane { y, 0 pigment { checker srgb <0.45, 0.42, 0.36>, srgb <0.62, 0.58, 0.50> } finish { Matt } }
#for (I, 0, 9)
  cylinder { <-1.6, 0, 0>, <-1.6, 1.6, 0>, 0.3 translate 2.2 * I * z texture { Clay } }
  cylinder { <1.6, 0, 0>, <1.6, 1.6, 0>, 0.3 translate 2.2 * I * z texture { Ivory } }
#end
