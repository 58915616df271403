// A mesh given as lists: points, normals, and triangles by the numbers of their points. Most programs export this form.
#include "../gallery.inc"

// A sheet with waves, 20 by 20 fields, smooth by its normals.
#declare N = 20;
#declare F = function(x, z) { 0.7 + 0.28 * sin(3.2 * x) * cos(3.2 * z) }
mesh2 {
  vertex_vectors {
    (N + 1) * (N + 1)
    #for (I, 0, N) #for (J, 0, N)
      #local X = 2.6 * I / N - 1.3;
      #local Z = 2.6 * J / N - 1.3;
      , <X, F(X, Z), Z>
    #end #end
  }
  normal_vectors {
    (N + 1) * (N + 1)
    #for (I, 0, N) #for (J, 0, N)
      #local X = 2.6 * I / N - 1.3;
      #local Z = 2.6 * J / N - 1.3;
      , <-0.896 * cos(3.2 * X) * cos(3.2 * Z), 1, 0.896 * sin(3.2 * X) * sin(3.2 * Z)>
    #end #end
  }
  face_indices {
    2 * N * N
    #for (I, 0, N - 1) #for (J, 0, N - 1)
      #local A = I * (N + 1) + J;
      , <A, A + 1, A + N + 1>, <A + 1, A + N + 2, A + N + 1>
    #end #end
  }
  rotate 20 * y
  texture { Glaze }
}
