// Lights that shine on the objects of their group only: the red lamp lights the left ball, the right one does not know of it.
#include "../gallery.inc"

light_group {
  light_source { <-4, 2, -3>, rgb <0.9, 0.15, 0.05> }
  sphere { <-0.95, 0.8, 0>, 0.8 texture { Ivory } }
  global_lights on
}
sphere { <0.95, 0.8, 0>, 0.8 texture { Ivory } }
