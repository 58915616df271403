// An egg by the radii of its bottom and its top: two balls, and between them an arc that touches both.
#include "../gallery.inc"

ovus { 0.75, 0.42 translate <-0.7, 0.75, 0> texture { Ivory } }
ovus { 0.4, 0.62 rotate -100 * z translate <0.75, 0.56, -0.7> texture { Clay } }
