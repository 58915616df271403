// Lights that shine on the things of their group only, with `global_lights on` beside all others: the red lamp knows one ball, the other
// ball and the floor know nothing of it.
#include "../gallery.inc"

light_group {
  light_source { <-4, 2, -3>, rgb <0.9, 0.15, 0.05> }
  sphere { <-0.95, 0.8, 0>, 0.8 texture { Ivory } }
  global_lights on
}
sphere { <0.95, 0.8, 0>, 0.8 texture { Ivory } }
