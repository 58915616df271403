// A circle without thickness: centre, normal, radius, and the radius of a hole if one is wanted.
#include "../gallery.inc"

disc { <0, 1, 0>, <-0.5, 0.45, -1>, 1, 0.45 texture { Clay } }
disc { <0, 1, 0>, <-0.5, 0.45, -1>, 0.3 texture { Glaze } }
