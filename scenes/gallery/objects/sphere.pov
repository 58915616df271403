// Centre and radius. A ball keeps its shape at any size: one of radius 0.000001 at a distance of a million kilometres is as round.
#include "../gallery.inc"

sphere { <0, 1, 0>, 1 texture { Clay } }
