// A picture as a relief: bright means high. A function can make the picture, as here.
#include "../gallery.inc"

height_field {
  function 120, 120 { 0.5 + 0.28 * sin(14 * x) * cos(14 * y) + 0.2 * exp(-40 * (pow(x - 0.5, 2) + pow(y - 0.5, 2))) }
  smooth
  translate <-0.5, 0, -0.5>
  scale <2.5, 1.1, 2.5>
  rotate 25 * y
  texture { Clay }
}
