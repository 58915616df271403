// A pattern chooses between whole pigments.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    gradient y
    triangle_wave
    pigment_map {
      [0.35 checker srgb <0.15, 0.22, 0.30>, srgb <0.92, 0.88, 0.78> scale 0.16]
      [0.65 bozo color_map { [0.3 srgb <0.75, 0.25, 0.15>] [0.7 srgb <0.98, 0.82, 0.45>] } scale 0.12]
    }
    scale 1.2
  }
  finish { Matt }
}
Bodies(Look)
