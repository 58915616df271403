// Layers along x, which turbulence turns into marble.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    marble
    turbulence 0.8
    octaves 5
    color_map { [0.0 srgb <0.30, 0.30, 0.34>] [0.25 srgb <0.78, 0.77, 0.76>] [1.0 srgb <0.96, 0.95, 0.93>] }
    scale 0.7
    rotate 40 * z
  }
  finish { Matt }
}
Bodies(Look)
