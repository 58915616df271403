// A subdivision surface: what a mesh of few points becomes when it is divided and smoothed without end. The mesh is a cube with an arm on each
// side, drawn as wires. The edges of the arms' ends are creases: three are sharp for ever, three smooth after one level.
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
