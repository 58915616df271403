// A subdivision surface: what a mesh of few points becomes when it is divided and smoothed without end. The mesh is a cube with an arm on each
// side, drawn as wires. The edges of the arms' ends are creases: three are sharp for ever, three smooth after one level.
//
// Each step of Catmull and Clark's scheme puts a point into each face, at the mean of its corners, and one on each edge, at the mean of its ends
// and of the two points in the faces beside it; a point `P` with `n` edges moves to `(F + 2 E + (n - 3) P) / n`, where `F` is the mean of the
// points in the faces around, and `E` that of the middles of the edges. On a crease the points are those of a cubic B-spline curve: the middle of
// the edge, and `(A + 6 P + B) / 8` between the neighbours `A` and `B`.
//
// Faces that touch in a point and have no edge there in common stay together: the point is a corner of them all, as in OpenSubdiv.
//
// Limits: two faces meet at an edge at most; a face has 10,000 corners at most, a point 10,000 faces. The limit is exact where four faces meet at each
// point; around other points the last patch, 2^-30 of a face wide, is closer to it than 2^-28 of a face. A ray nearer to the silhouette than
// 10^-7 of the size may miss both hits there. Meshes with a border have no inside.
//
// E. Catmull, J. Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes", Computer-Aided Design 10(6), 1978; for triangles
// C. Loop, "Smooth subdivision surfaces based on triangles", 1987; for creases T. DeRose, M. Kass, T. Truong, "Subdivision surfaces in character
// animation", SIGGRAPH 1998.
#include "../gallery.inc"

// Corner I of a cube of side 2, and the arm along an axis: where its corner lies.
#declare Corner = function(i, bit) { 2 * mod(floor(i / pow(2, bit)), 2) - 1 }
#macro At(I) <Corner(I, 0), Corner(I, 1), Corner(I, 2)> #end

// The four corners on each side, counter-clockwise from outside.
#declare Sides = array[6][4] {
  { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 }
}
#declare Axes = array[6] { -x, x, -y, y, -z, z }
#declare Long = 2.2;
#declare Points = array[32];
#for (I, 0, 7) #declare Points[I] = At(I); #end
#for (S, 0, 5)
  #for (K, 0, 3) #declare Points[8 + 4 * S + K] = At(Sides[S][K]) + Long * Axes[S]; #end
#end

#declare Cross = subdivision {
  catmull_clark
  points { #for (I, 0, 31) Points[I] #end }
  #for (S, 0, 5)
    #declare E = 8 + 4 * S;
    face { E, E + 1, E + 2, E + 3 }
    #for (K, 0, 3)
      #declare L = mod(K + 1, 4);
      face { Sides[S][K], Sides[S][L], E + L, E + K }
    #end
    crease { sharpness (mod(S, 2) = 1 ? 10 : 1) E, E + 1, E + 2, E + 3, E }
  #end
}
#declare Wires = union {
  #for (S, 0, 5)
    #for (K, 0, 3)
      #declare E = 8 + 4 * S;
      #declare L = mod(K + 1, 4);
      cylinder { Points[E + K], Points[E + L], 0.04 }
      cylinder { Points[E + K], Points[Sides[S][K]], 0.04 }
      sphere { Points[E + K], 0.08 }
    #end
  #end
}

union {
  object { Cross texture { Clay } }
  object { Wires texture { Ivory } no_shadow }
  rotate <0, 28, 0>
  rotate <-24, 0, 0>
  scale 0.3
  translate 0.98 * y
}
