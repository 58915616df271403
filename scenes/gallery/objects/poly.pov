// A surface of any degree up to 35 by its coefficients: here the heart of Taubin, of the sixth degree.
#include "../gallery.inc"

#declare Factorial = array[4] { 1, 1, 2, 6 };
#declare Term = array[84];
#for (I, 0, 83) #declare Term[I] = 0; #end
// (x^2 + y^2 + 9/4 z^2 - 1)^3 - x^2 y^3 - 9/80 z^2 y^3 = 0, coefficients in the order of the manual: x before y before z.
#declare At = 0;
#for (A, 6, 0, -1)
  #for (B, 6 - A, 0, -1)
    #for (C, 6 - A - B, 0, -1)
      #local Even = ((mod(A, 2) = 0) & (mod(B, 2) = 0) & (mod(C, 2) = 0));
      #if (Even)
        #local P = A / 2;
        #local Q = B / 2;
        #local R = C / 2;
        #local S = 3 - P - Q - R;
        #if (S >= 0) #declare Term[At] = 6 / (Factorial[P] * Factorial[Q] * Factorial[R] * Factorial[max(S, 0)]) * pow(2.25, R) * pow(-1, S); #end
      #end
      #if (A = 2 & B = 3 & C = 0) #declare Term[At] = -1; #end
      #if (A = 0 & B = 3 & C = 2) #declare Term[At] = -9 / 80; #end
      #declare At = At + 1;
    #end
  #end
#end
poly {
  6, < Term[0] #for (I, 1, 83) , Term[I] #end >
  sturm
  scale 0.85
  rotate 25 * y
  translate 0.95 * y
  texture { Clay }
}
