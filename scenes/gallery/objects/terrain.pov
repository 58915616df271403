// A fractal terrain: octaves of noise as heights, met as the smooth surface that they are. Ridges make the next octave rough, valleys
// stay calm. Here a piece of one is a solid: cut by a box, so that one sees the ground below.
//
// `y = sum a_k s_k` over the octaves `k`, with `a_k = lacunarity^(-h k)` and `s_k = (offset - abs(n_k))^2 min(max(gain s_(k-1), 0), 1)`, where
// `n_k` is the noise at `lacunarity^k (x, 0, z)`, from -1 to 1; `s_0` has no such factor. These are ridges; `fbm` has `y = offset + sum a_k n_k`,
// and `hetero` begins with `y = offset + n_0` and adds `a_k (n_k + offset) y` for each octave after the first.
//
// Limits: `lacunarity` is from 1.1 to 16, `octaves` from 1 to 64. Without `extent` a terrain ends 1048576 units from the origin. An octave is flat
// where its noise has more than 2^31 cells on the way from the origin.
//
// F. K. Musgrave in D. S. Ebert et al., Texturing and Modeling, 3rd ed., chapter 16.
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
