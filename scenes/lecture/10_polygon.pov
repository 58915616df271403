// Ray and polygon: the plane first, t = -(D + n.p0) / (n.d), then an inside-outside test in two dimensions, on the plane that the
// largest component of n leaves.
//
// An icosahedron of triangles, a wall with a window as one polygon with a hole, and a star whose outline is not convex.
//
//     strahl render scenes/lecture/10_polygon.pov --size 320x180 --shading normals -o normals.png
//
// shows the normals as colours, n/2 + 1/2 with x, y and z as red, green and blue (linear values: 0.5 is 188 in a PNG; an EXR has the numbers themselves): each face has one normal, and so one colour.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 2.2, -7> right x * image_width / image_height angle 56 look_at <0, 1.0, 0> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.72, 0.82, 0.93> }
// The floor: fields that fade into their mean colour far away, where they are smaller than pixels.
plane {
  y, 0
  pigment {
    cylindrical
    pigment_map { [0 rgb <0.555, 0.563, 0.552>] [0.6 checker srgb <0.55, 0.60, 0.66>, srgb <0.93, 0.91, 0.86> scale 1 / 18] }
    scale 18
  }
  finish { ambient 0.1 diffuse 0.75 }
}

#declare G = (1 + sqrt(5)) / 2;
#declare P = array[12] {
  <-1, G, 0>, <1, G, 0>, <-1, -G, 0>, <1, -G, 0>, <0, -1, G>, <0, 1, G>,
  <0, -1, -G>, <0, 1, -G>, <G, 0, -1>, <G, 0, 1>, <-G, 0, -1>, <-G, 0, 1>
}
#declare F = array[20] {
  <0, 11, 5>, <0, 5, 1>, <0, 1, 7>, <0, 7, 10>, <0, 10, 11>, <1, 5, 9>, <5, 11, 4>, <11, 10, 2>, <10, 7, 6>, <7, 1, 8>,
  <3, 9, 4>, <3, 4, 2>, <3, 2, 6>, <3, 6, 8>, <3, 8, 9>, <4, 9, 5>, <2, 4, 11>, <6, 2, 10>, <8, 6, 7>, <9, 8, 1>
}
union {
  #for (I, 0, 19)
    triangle { P[F[I].x], P[F[I].y], P[F[I].z] }
  #end
  pigment { srgb <0.85, 0.55, 0.25> }
  finish { ambient 0.1 diffuse 0.75 phong 0.4 phong_size 30 }
  scale 0.55
  rotate <15, 25, 0>
  translate <0, 1, -0.8>
}
polygon {
  10, <-1, 0>, <1, 0>, <1, 2>, <-1, 2>, <-1, 0>, <-0.5, 0.7>, <0.5, 0.7>, <0.5, 1.5>, <-0.5, 1.5>, <-0.5, 0.7>
  rotate -25 * y
  translate <-2.2, 0, 0.6>
  pigment { srgb <0.70, 0.32, 0.25> }
  finish { ambient 0.1 diffuse 0.75 }
}
polygon {
  11
  #for (I, 0, 10)
    #local R = (mod(I, 2) ? 0.45 : 1.1);
    , <R * sin(2 * pi * mod(I, 10) / 10), R * cos(2 * pi * mod(I, 10) / 10)>
  #end
  translate 1.1 * y
  rotate 25 * y
  translate <2.2, 0, 0.4>
  pigment { srgb <0.25, 0.45, 0.62> }
  finish { ambient 0.1 diffuse 0.75 }
}
