// The lights of a group shine only on the objects of the group; with `global_lights on` the other lights do, too. The red lamp
// lights one ball, but neither the other ball nor the floor.
#include "../gallery.inc"

light_group {
  light_source { <-4, 2, -3>, rgb <0.9, 0.15, 0.05> }
  sphere { <-0.95, 0.8, 0>, 0.8 texture { Ivory } }
  global_lights on
}
sphere { <0.95, 0.8, 0>, 0.8 texture { Ivory } }
