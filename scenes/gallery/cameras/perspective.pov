// All rays start at the eye: the farther an object, the smaller it is. `angle` is the width of the view.
#declare Gallery_Camera = 0;
#include "../gallery.inc"

camera { perspective location <0, 3, -7> right x * image_width / image_height angle 55 look_at <0, 0.5, 1.5> }

#for (I, -3, 3)
  #for (J, -1, 6)
    box { <-0.3, 0, -0.3>, <0.3, 0.6 + 0.5 * mod(I * I + J + 3, 3), 0.3> translate <1.4 * I, 0, 1.4 * J> #if (mod(I + J + 8, 2)) texture { Clay } #else texture { Ivory } #end }
  #end
#end
