// Pigments on a sphere at infinite distance: visible wherever a ray hits no object, also in mirrors.
#declare Gallery_Floor = 0;
#include "../gallery.inc"

sky_sphere {
  pigment { gradient y color_map { [0.0 srgb <0.98, 0.80, 0.62>] [0.3 srgb <0.55, 0.68, 0.88>] [1.0 srgb <0.10, 0.22, 0.55>] } }
  pigment {
    bozo turbulence 0.7 octaves 6
    color_map { [0.0 rgbt <1, 1, 1, 0.1>] [0.5 rgbt <1, 1, 1, 1>] }
    scale <0.35, 0.12, 0.35>
  }
}
plane { y, 0 pigment { srgb <0.45, 0.47, 0.42> } finish { Matt } }
sphere { <0, 1, 0>, 1 pigment { srgb 0.1 } finish { ambient 0 diffuse 0.2 reflection 0.8 } }
