// All rays are parallel: objects have the same size at any distance, as in a technical drawing.
#declare Gallery_Camera = 0;
#include "../gallery.inc"

camera { orthographic location <-8, 7, -9> right 9 * x * image_width / image_height up 9 * y look_at <0, 0.4, 2> }

#for (I, -3, 3)
  #for (J, -1, 6)
    box { <-0.3, 0, -0.3>, <0.3, 0.6 + 0.5 * mod(I * I + J + 3, 3), 0.3> translate <1.4 * I, 0, 1.4 * J> #if (mod(I + J + 8, 2)) texture { Clay } #else texture { Ivory } #end }
  #end
#end
