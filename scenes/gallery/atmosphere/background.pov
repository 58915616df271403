// One colour wherever a ray hits no object.
#declare Gallery_Floor = 0;
#include "../gallery.inc"

background { srgb <0.96, 0.78, 0.50> }
sphere { <0, 1, 0>, 1 texture { Glaze } }
