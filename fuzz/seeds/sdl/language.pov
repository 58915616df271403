#version 3.7;
#declare A = array[2][2]{{1, 2}, {3, 4}};
#declare D = dictionary { .K: <1, 2, 3> };
#declare F = function(x, y) { x * y + sum(i, 1, 3, i) };
#declare S = spline { cubic_spline 0, x 1, y 2, z 3, x };
#macro M(P, optional Q) #declare P = P + 1; #ifdef (local.Q) #debug str(Q, 0, 2) #end #end
#for (I, 0, 2) #switch (I) #case (0) #break #range (1, 2) M(A[I - 1][0],) #else #end #end
#while (A[0][0] < 9) #declare A[0][0] = A[0][0] + F(1, 2); #end
#include "a.inc"
sphere { <0, 1e3, -.5>, max(1, 2) pigment { color rgb <1, 0, 0> transmit 0.5 } finish { phong 1 } translate x*S(0.5).x rotate D.K }
#fopen H "out.txt" write
#write (H, "text", 1, <1, 2>)
#fclose H
