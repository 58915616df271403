// A normal and a distance: an infinite plane, solid below. The floor of all these pictures is one; two more cut a corner here.
#include "../gallery.inc"

intersection {
  plane { -x, 0.9 }
  plane { -z, 0.2 }
  plane { <0.6, 0.62, -0.1>, 0.72 }
  plane { -y, 0 }
  plane { z, 1.2 }
  texture { Clay }
}
