// Triangles as one object with an acceleration structure of its own, so there may be millions of them.
#include "../gallery.inc"

// A tent of triangles over a circle, whose tip is off the centre.
mesh {
  #for (I, 0, 23)
    #local A = radians(15 * I);
    #local B = radians(15 * (I + 1));
    #local R = 1 + 0.22 * pow(-1, I);
    #local Q = 1 + 0.22 * pow(-1, I + 1);
    triangle { <0.2, 1.7, 0>, <R * cos(A), 0, R * sin(A)>, <Q * cos(B), 0, Q * sin(B)> }
  #end
  texture { Clay }
}
