// `turbulence` lets noise thin the fog in clouds, whose size is about the reciprocal of its value; `turb_depth` says how much.
#declare Gallery_Floor = 0;
#include "../gallery.inc"

fog { fog_type 2 distance 5 fog_offset 0.6 fog_alt 0.3 color srgb <0.93, 0.95, 0.97> turbulence <2, 3, 2> turb_depth 2 octaves 3 }
plane { y, 0 pigment { checker srgb <0.25, 0.22, 0.16>, srgb <0.42, 0.38, 0.30> } finish { Matt } }
#for (I, 0, 9)
  cylinder { <-1.6, 0, 0>, <-1.6, 1.6, 0>, 0.3 translate 2.2 * I * z texture { Clay } }
  cylinder { <1.6, 0, 0>, <1.6, 1.6, 0>, 0.3 translate 2.2 * I * z texture { Ivory } }
#end
