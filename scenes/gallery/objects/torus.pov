// A ring around the y axis: the radius of the ring and that of its tube. The quartic is solved exactly to the last digits.
#include "../gallery.inc"

torus { 0.8, 0.3 rotate <-62, 0, 0> rotate 22 * y translate 0.98 * y texture { Clay } }
torus { 1.1, 0.12 translate 0.12 * y texture { Glaze } }
