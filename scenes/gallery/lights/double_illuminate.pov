// A lamp behind sheets of paper: with `double_illuminate` (on the right) its light shines through to the front.
#declare Gallery_Light = 0;
#include "../gallery.inc"

light_source { <-2, 4, 5>, rgb 1 }
light_source { <2, 4, -6>, rgb 0.12 shadowless }

#declare Paper = polygon {
  5, <-0.75, 0>, <0.75, 0>, <0.75, 1.9>, <-0.75, 1.9>, <-0.75, 0>
  pigment { rgb <0.95, 0.88, 0.7> }
  finish { ambient 0.05 diffuse 0.7 }
}
object { Paper rotate 15 * y translate -0.9 * x }
object { Paper rotate -15 * y translate 0.9 * x double_illuminate }
