// The part that all objects have in common: here a ball and a box make a die. Each face has the texture of its object.
#include "../gallery.inc"

intersection {
  box { <-0.8, -0.8, -0.8>, <0.8, 0.8, 0.8> texture { Clay } }
  sphere { 0, 1.08 texture { Ivory } }
  rotate 30 * y
  translate 0.8 * y
}
