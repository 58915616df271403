// `dispersion` refracts violet light more than red: white edges show the colours of the spectrum. More `dispersion_samples`
// make them smoother.
#version 3.7;
#declare Gallery_Camera = 0;
#declare Gallery_Light = 0;
#include "../gallery.inc"

camera {
  location <0, 1.5, -6.2>
  right x * image_width / image_height
  angle 41
  look_at <0, 0.98, 0>
}

light_source { <-5, 8, -6>, rgb 1 }

// White lamps behind the glass.
#for (I, -4, 4)
  cylinder { <0.62 * I, 0, 3>, <0.62 * I, 2.6, 3>, 0.05 pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 1.2 } no_shadow }
#end
plane { -z, -4 pigment { srgb <0.10, 0.11, 0.14> } finish { ambient 0.2 diffuse 0.4 } }

#declare Flint = material {
  texture { pigment { rgbf 0.98 } finish { ambient 0 diffuse 0 specular 0.7 roughness 0.002 } }
  interior { ior 1.6 dispersion 1.08 dispersion_samples 9 }
}
sphere { <1.05, 0.95, 0>, 0.95 material { Flint } }
prism { 0, 1.9, 4, <-1, 0>, <0.75, 0>, <-0.1, 1.3>, <-1, 0> material { Flint } rotate 12 * y translate <-0.95, 0.005, -0.2> }
