// Three corners. Neighbours that share an edge have no crack between them.
#include "../gallery.inc"

triangle { <-1.1, 0, -0.2>, <0.9, 0, -0.6>, <-0.2, 1.8, 0.2> texture { Clay } }
triangle { <1.2, 0, 0.8>, <0.9, 0, -0.6>, <-0.2, 1.8, 0.2> texture { Glaze } }
