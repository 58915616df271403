// The local part of shading: I = ka Ia + kd (n.l) + ks (h.n)^p for a light that is visible.
//
// From the left: the ambient term alone, the diffuse term alone, the highlight alone, and their sum.
//
//     strahl explain scenes/lecture/04_shading.pov --size 320x180 --sampling center --pixel 262,80
//     strahl explain scenes/lecture/04_shading.pov --size 320x180 --sampling center --pixel 262,80 --shading phong
//     strahl render scenes/lecture/04_shading.pov --size 320x180 --shading lambert -o lambert.png
//
// print every term of a point on the last ball with its numbers, where all three count; the same with Phong's highlight, (r.v)^p in place
// of (h.n)^p; and the picture without highlights.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 1.6, -7> right x * image_width / image_height angle 54 look_at <0, 0.75, 0> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.16, 0.18, 0.21> }

plane { y, 0 pigment { srgb <0.35, 0.36, 0.38> } finish { ambient 0.1 diffuse 0.5 } }
#macro Ball(X, Ka, Kd, Ks)
  sphere {
    <X, 0.7, 0>, 0.7
    pigment { srgb <0.90, 0.45, 0.20> }
    finish { ambient Ka diffuse Kd specular Ks roughness 0.02 }
  }
#end
Ball(-2.4, 0.25, 0, 0)
Ball(-0.8, 0, 0.7, 0)
Ball(0.8, 0, 0, 0.8)
Ball(2.4, 0.25, 0.7, 0.8)
