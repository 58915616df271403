// An arc turned about an axis: two ends with a radius each, and the radius of the arc. It was added in version 3.8 of the language.
#include "../gallery.inc"

lemon { <-1.25, 0.62, 0.2>, 0, <0.55, 0.62, -0.1>, 0, 0.98 texture { Clay } }
lemon { <1.0, 0, 0.3>, 0.3, <1.0, 1.7, 0.3>, 0.12, 1.4 texture { Glaze } }
lemon { <0.5, 0.02, -1.1>, 0.34, <0.5, 0.46, -1.1>, 0.3, 0.5 open texture { Ivory } }
