// Perlin's noise, smooth; here cut into spots by a step in the map.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    spotted
    color_map { [0.4 srgb <0.45, 0.25, 0.12>] [0.4 srgb <0.95, 0.82, 0.55>] }
    scale 0.3
  }
  finish { Matt }
}
Bodies(Look)
