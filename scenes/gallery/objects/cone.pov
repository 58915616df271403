// Two ends with a radius each; one of them may be 0. `open` leaves out the caps.
#include "../gallery.inc"

cone { <-0.8, 0, 0>, 0.8, <-0.8, 1.8, 0>, 0 texture { Clay } }
cone { <0.95, 0, 0.2>, 0.85, <0.95, 1.1, 0.2>, 0.5 open texture { Glaze } }
