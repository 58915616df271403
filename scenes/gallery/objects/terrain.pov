// A fractal terrain: octaves of noise as heights, met as the smooth surface that they are. Ridges make the next octave rough, valleys
// stay calm. Here a piece of one is a solid: cut by a box, so that one sees the ground below.
#include "../gallery.inc"

intersection {
  terrain {
    ridged
    octaves 6
    h 1.2
    extent <-2, -2>, <2, 2>
  }
  box { <-1.45, 0.2, -1.45>, <1.45, 3, 1.45> pigment { srgb <0.45, 0.36, 0.29> } }
  texture {
    slope y
    texture_map {
      [0.62 pigment { srgb <0.42, 0.38, 0.36> }]
      [0.72 pigment { srgb <0.45, 0.50, 0.28> }]
    }
  }
  translate -0.2 * y
  scale <1, 0.7, 1>
  rotate 28 * y
}
