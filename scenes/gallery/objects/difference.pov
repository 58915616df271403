// The part of the first object that is in none of the others. The cut surfaces have the textures of the objects that cut.
#include "../gallery.inc"

difference {
  box { <-0.9, 0, -0.9>, <0.9, 1.6, 0.9> texture { Clay } }
  cylinder { <0, -1, 0>, <0, 3, 0>, 0.55 texture { Ivory } }
  sphere { <0.95, 1.65, -0.95>, 0.85 texture { Glaze } }
  rotate 25 * y
}
