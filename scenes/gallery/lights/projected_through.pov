// Light that only shines through an object which is invisible itself, here the panes of a window. Objects between that object
// and the lamp cast no shadow.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source {
  <-4, 6, -5>, rgb 1.2
  projected_through {
    union {
      #for (I, 0, 1)
        #for (J, 0, 2)
          box { <I * 0.5, J * 0.45, 0>, <I * 0.5 + 0.4, J * 0.45 + 0.36, 0.01> }
        #end
      #end
    }
    translate <-2.1, 2.5, -2.4>
  }
}
light_source { <6, 4, -6>, rgb 0.2 shadowless }

sphere { <0.6, 0.6, 0.9>, 0.6 texture { Ivory } }
