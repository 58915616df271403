// Bounding volumes: a ray that misses the sphere around an object misses the object.
//
// A chain of balls and what a program knows about it: bounding spheres around each four, around each sixteen, and around all. A ray
// that hits the outer sphere tests four inside it, and so on down: about log n tests instead of n.
//
//     strahl compare scenes/lecture/11_bounding_volumes.pov --size 160x90 --sampling center --with list --with spheres --with bvh
//     strahl trace-ray scenes/lecture/11_bounding_volumes.pov --size 320x180 --pixel 200,90 --accelerator spheres
//
// print the numbers of nodes visited and objects tested per ray, without a hierarchy, with one of spheres and with one of boxes, and the
// spheres that a single ray hits. The last column shows that the pictures are equal to the last bit.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 2.4, -8.5> right x * image_width / image_height angle 56 look_at <0, 1.2, 0> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.72, 0.82, 0.93> }

plane { y, -1.2 pigment { srgb <0.80, 0.80, 0.78> } finish { ambient 0.1 diffuse 0.75 } }
// The balls lie on a line that winds up; a hull is a shell of thin glass.
#macro At(I)
  <-3 + 6 * I / 63, 1.2 + 0.75 * sin(0.5 * I), 0.75 * cos(0.5 * I)>
#end

#for (I, 0, 63)
  sphere { At(I), 0.13 pigment { srgb <0.85, 0.40, 0.20> } finish { ambient 0.1 diffuse 0.75 phong 0.4 phong_size 30 } }
#end
#macro Hulls(Count, Tint)
  #for (G, 0, 64 / Count - 1)
    #local C = <0, 0, 0>;
    #for (I, 0, Count - 1)
      #local C = C + At(G * Count + I) / Count;
    #end
    #local R = 0;
    #for (I, 0, Count - 1)
      #local R = max(R, vlength(At(G * Count + I) - C) + 0.13);
    #end
    sphere {
      C, R
      pigment { color Tint }
      finish { ambient 0.1 diffuse 0.3 phong 0.5 phong_size 60 }
      no_shadow
    }
  #end
#end
Hulls(4, rgbt <0.2, 0.5, 0.9, 0.80>)
Hulls(16, rgbt <0.2, 0.8, 0.4, 0.88>)
Hulls(64, rgbt <0.9, 0.8, 0.2, 0.94>)
