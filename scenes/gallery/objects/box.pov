// Two opposite corners. Its faces are parallel to the axes until it is rotated.
#include "../gallery.inc"

box { <-0.8, 0, -0.8>, <0.8, 1.5, 0.8> rotate 28 * y texture { Clay } }
