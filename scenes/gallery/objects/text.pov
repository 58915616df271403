// Letters of a font as solids: the font, the text, the thickness, and an additional offset per letter.
#include "../gallery.inc"

text {
  ttf "timrom.ttf" "Ray" 0.3, 0
  scale 1.55
  rotate 12 * y
  translate <-1.25, 0.35, -0.1>
  texture { Clay }
}
