// What is in all of the objects: here a ball and a box become a die. Each face has the texture of the object it comes from.
#include "../gallery.inc"

intersection {
  box { <-0.8, -0.8, -0.8>, <0.8, 0.8, 0.8> texture { Clay } }
  sphere { 0, 1.08 texture { Ivory } }
  rotate 30 * y
  translate 0.8 * y
}
