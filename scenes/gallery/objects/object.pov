// Another copy of a declared object, with its own position and texture. The geometry is stored once, however often it is used.
#include "../gallery.inc"

#declare Pawn = union {
  cylinder { 0, 0.1 * y, 0.36 }
  cone { 0.1 * y, 0.28, 0.75 * y, 0.12 }
  cylinder { 0.68 * y, 0.74 * y, 0.22 }
  sphere { 0.92 * y, 0.22 }
}
object { Pawn scale 1.4 translate <-1.0, 0, -0.3> texture { Ivory } }
object { Pawn scale 1.4 translate <0.0, 0, 0.6> texture { Clay } }
object { Pawn scale 1.3 rotate <0, 0, -73> rotate 35 * y translate <0.35, 0.46, -0.7> texture { Glaze } }
