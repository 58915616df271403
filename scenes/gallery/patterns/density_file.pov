// Values measured at the points of a grid, here of 20 by 20 by 20 in the file `gyroid.df3`. Between them they are interpolated.
#include "../gallery.inc"

#declare Look = texture {
  pigment {
    density_file df3 "gyroid.df3" interpolate 2
    color_map { [0.0 srgb <0.20, 0.10, 0.08>] [0.5 srgb <0.80, 0.42, 0.20>] [1.0 srgb <0.98, 0.90, 0.72>] }
    translate -0.5
    scale 4.5
    translate 0.8 * y
  }
  finish { Matt }
}
Bodies(Look)
