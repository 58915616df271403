// A wall of two colours: mortar first, then bricks; `brick_size` and `mortar` have the measures.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    brick srgb <0.82, 0.78, 0.72>, srgb <0.62, 0.22, 0.14>
    brick_size <0.62, 0.24, 0.31>
    mortar 0.035
  }
  finish { Matt }
}
Bodies(Look)
