// A ring of colours around the direction in which the light travels. The map goes from its inner to its outer edge; `transmit`
// lets the background shine through, and `arc_angle` and `falloff_angle` end the ring softly.
#declare Gallery_Camera = 0;
#declare Gallery_Floor = 0;
#include "../gallery.inc"

camera { location <0, 1.2, -8> right x * image_width / image_height angle 62 look_at <0, 2.6, 0> }
rainbow {
  direction <0.05, -0.1, 1>
  angle 24
  width 5
  arc_angle 170
  falloff_angle 90
  color_map {
    [0.0 rgbt <0.5, 0.1, 0.9, 1.0>]
    [0.2 rgbt <0.3, 0.2, 0.9, 0.7>]
    [0.4 rgbt <0.1, 0.7, 0.6, 0.6>]
    [0.6 rgbt <0.9, 0.9, 0.1, 0.5>]
    [0.8 rgbt <1.0, 0.3, 0.1, 0.6>]
    [1.0 rgbt <1.0, 0.1, 0.1, 1.0>]
  }
}
sky_sphere { pigment { gradient y color_map { [0 srgb <0.75, 0.80, 0.86>] [0.7 srgb <0.35, 0.50, 0.72>] } } }
plane { y, 0 pigment { srgb <0.45, 0.55, 0.35> } finish { Matt } }
#for (I, 0, 6)
  cone { <I * 2.2 - 6.6, 0, 6 - mod(I * 5, 7)>, 0.7, <I * 2.2 - 6.6, 1.9, 6 - mod(I * 5, 7)>, 0 texture { Clay } }
#end
