// A solid within NURBS surfaces that close a volume together, as programs for computer-aided design write it: a block whose upright edges are
// round, with a bore. Its lids are planes that curves of their own trim, and still no ray gets through where faces meet; a ball is cut from it.
//
// Each border of a face is that of another one, too, or of the same face elsewhere, as the seam of the bore; the faces come in any order and
// turned either way. Beside edges crossings are settled so that each ray leaves as often as it enters: R. Bellman, Dynamic Programming, chapter 1,
// finds the sequence that contradicts the faces least.
//
// Limits: borders are at most a ten-thousandth of the diagonal of the whole apart; faces do not cross each other. If the faces leave a gap,
// a warning says where, and they are surfaces without an inside.
//
// M. Mantyla, An Introduction to Solid Modeling, chapters 6 to 8; W. Martin, E. Cohen, R. Fish, P. Shirley, Practical ray tracing of trimmed
// NURBS surfaces, Journal of Graphics Tools 5(1).
#include "../gallery.inc"

#declare Height = 1.4;
#declare Side = <0.74, 0.5>;  // half of the straight sides
#declare Round = 0.26;
#declare Bore = 0.36;
#declare Around = array[9] { <1, 0>, <1, 1>, <0, 1>, <-1, 1>, <-1, 0>, <-1, -1>, <0, -1>, <1, -1>, <1, 0> }
#macro Weight(I) (mod(I, 2) = 1 ? sqrt(0.5) : 1) #end
#declare Quarters = array[12] { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }

// A quarter of a circle about a corner, as a curve of the lids and as a side of the block.
#macro Corner(K, I) (<select(mod(K + 1, 4) - 1.5, 1, -1), select(K - 1.5, 1, -1)> * Side + Round * Around[2 * K + I]) #end
#declare Lid = nurbs {
  degree 1
  u_knots { -2, -2, 2, 2 } v_knots { -2, -2, 2, 2 }
  row { <-2, 0, -2>, <2, 0, -2> }
  row { <-2, 0, 2>, <2, 0, 2> }
  trim {
    #for (K, 0, 3)
      curve { degree 2 #for (I, 0, 2) #local P = Corner(K, I); <P.u, P.v, Weight(I)> #end }
      curve { Corner(K, 2), Corner(mod(K + 1, 4), 0) }
    #end
  }
  hole { curve { degree 2 knots { #for (I, 0, 11) Quarters[I] #end } #for (I, 0, 8) <Bore * Around[I].u, Bore * Around[I].v, Weight(I)> #end } }
}

#declare Block = brep {
  Lid
  object { Lid translate Height * y }
  #for (K, 0, 3)
    nurbs {
      degree <2, 1>
      #for (J, 0, 1)
        row { #for (I, 0, 2) #local P = Corner(K, I); <P.u, J * Height, P.v, Weight(I)> #end }
      #end
    }
    nurbs {
      degree 1
      #for (J, 0, 1)
        row { #for (I, 0, 1) #local P = Corner(mod(K + I, 4), 2 * (1 - I)); <P.u, J * Height, P.v> #end }
      #end
    }
  #end
  nurbs {
    degree <2, 1>
    u_knots { #for (I, 0, 11) Quarters[I] #end }
    #for (J, 0, 1)
      row { #for (I, 0, 8) <Bore * Around[I].u, J * Height, Bore * Around[I].v, Weight(I)> #end }
    #end
  }
}

difference {
  object { Block texture { Glaze } }
  sphere { <0.85, 1.4, -0.6>, 0.62 texture { Ivory } }
  rotate 30 * y
  translate 0.06 * x
}
