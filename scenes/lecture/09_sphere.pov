// Ray and sphere: t = d.D +- sqrt((d.D)^2 - |D|^2 + R^2) with D = c - e loses its digits where R is small against |D|.
//
// Nine balls of radius 1 at distances of 10, 100, ... 1,000,000,000 from the eye. Parallel rays show all of them at the same size. Only
// the form sqrt(R^2 - |D - (d.D) d|^2), with care for its rounding, keeps them round; programs that use the textbook's form lose the
// last ones, or all but their outline.
//
//     povray +Iscenes/lecture/09_sphere.pov +W320 +H180
//
// is worth a comparison.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { orthographic location <0, 0, -1e9> direction z right 7.2 * x * image_width / image_height up 7.2 * y }
light_source { <-4e9, 5e9, -6e9>, rgb 1 parallel point_at 0 }
background { srgb <0.93, 0.93, 0.90> }

#for (I, 0, 8)
  #local Hue = I / 9;
  sphere {
    <2.3 * (mod(I, 3) - 1), 2.3 * (1 - int(I / 3)), -1e9 + pow(10, I + 1)>, 1
    pigment { srgb <0.55 + 0.4 * cos(2 * pi * Hue), 0.5 + 0.35 * cos(2 * pi * (Hue - 0.33)), 0.5 + 0.4 * cos(2 * pi * (Hue - 0.67))> }
    finish { ambient 0.12 diffuse 0.75 phong 0.4 phong_size 30 }
  }
#end
