// Letters of a font as solids: the font, the text, how deep it is, and what is added from letter to letter.
#include "../gallery.inc"

text {
  ttf "timrom.ttf" "Ray" 0.3, 0
  scale 1.55
  rotate 12 * y
  translate <-1.25, 0.35, -0.1>
  texture { Clay }
}
