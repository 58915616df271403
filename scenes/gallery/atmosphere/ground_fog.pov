// Fog on the ground (`fog_type 2`): full below `fog_offset`, thinner above, by half at `fog_alt`.
#declare Gallery_Floor = 0;
#include "../gallery.inc"

fog { fog_type 2 distance 3 fog_offset 0.15 fog_alt 0.25 color srgb <0.93, 0.95, 0.97> }
plane { y, 0 pigment { checker srgb <0.45, 0.42, 0.36>, srgb <0.62, 0.58, 0.50> } finish { Matt } }
#for (I, 0, 9)
  cylinder { <-1.6, 0, 0>, <-1.6, 1.6, 0>, 0.3 translate 2.2 * I * z texture { Clay } }
  cylinder { <1.6, 0, 0>, <1.6, 1.6, 0>, 0.3 translate 2.2 * I * z texture { Ivory } }
#end
