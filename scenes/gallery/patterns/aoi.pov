// The angle of incidence of the view: the rim has another colour.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    aoi
    color_map { [0.5 srgb <0.95, 0.75, 0.35>] [0.75 srgb <0.75, 0.25, 0.25>] [1.0 srgb <0.25, 0.12, 0.35>] }
  }
  finish { Matt }
}
Bodies(Look)
