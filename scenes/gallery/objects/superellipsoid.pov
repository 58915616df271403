// A box whose edges and corners are rounded by two exponents: from a cube through a ball to an octahedron and to stars.
#include "../gallery.inc"

superellipsoid { <0.25, 0.25> scale 0.6 rotate 25 * y translate <-1.3, 0.6, 0.2> texture { Clay } }
superellipsoid { <1, 0.2> scale 0.62 rotate <90, 0, 0> translate <0, 0.62, 0.2> texture { Ivory } }
superellipsoid { <2.2, 2.2> scale 0.75 rotate 25 * y translate <1.2, 0.75, 0.2> texture { Glaze } }
