// Two ends and one radius; `open` leaves out the caps.
#include "../gallery.inc"

cylinder { <-0.9, 0, 0.3>, <-0.9, 1.7, 0.3>, 0.6 texture { Clay } }
cylinder { <0.15, 0.5, -0.5>, <1.7, 0.5, 0.5>, 0.5 open texture { Glaze } }
