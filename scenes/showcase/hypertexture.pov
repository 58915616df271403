// Hypertexture: a solid whose skin is a zone. Within the zone the density of the ball falls from 1 to 0, and noise is added to it before
// the threshold is taken: so the noise does not bend the surface, it makes it: fur, flames, eroded stone. Three
// balls with the same zone and other noise; the isosurface is met exactly, however thin the parts.
// K. Perlin and E. M. Hoffert, "Hypertexture", SIGGRAPH 1989.
//
//     strahl render scenes/showcase/hypertexture.pov +W1280 +H720 +A0.3
#version 3.7;
#include "functions.inc"
global_settings { assumed_gamma 1 max_trace_level 5 }

// How many of the three balls there are.
#ifndef (Balls) #declare Balls = 3; #end

// The density of a ball: 1 within the inner radius, 0 beyond the outer one, a straight line of the squared distance between.
#declare Inner = 0.55;
#declare Outer = 1.25;
#declare Density = function(x, y, z) {
  min(1, max(0, (Outer * Outer - (x * x + y * y + z * z)) / (Outer * Outer - Inner * Inner)))
}
#declare Signed = function(x, y, z) { 2 * f_noise3d(x, y, z) - 1 }

// Erosion: noise of five octaves.
#declare Eroded = function(x, y, z) {
  Density(x, y, z)
  + 0.55 * Signed(2.1 * x, 2.1 * y, 2.1 * z) + 0.27 * Signed(4.3 * x, 4.3 * y, 4.3 * z) + 0.13 * Signed(8.5 * x, 8.5 * y, 8.5 * z)
  + 0.06 * Signed(17 * x, 17 * y, 17 * z) + 0.03 * Signed(35 * x, 35 * y, 35 * z)
}
// Fur: noise of the direction only, so that it is the same all along a hair.
#declare Away = function(x, y, z) { 1 / max(0.2, sqrt(x * x + y * y + z * z)) }
#declare Fur = function(x, y, z) {
  Density(x, y, z)
  + 1.5 * (f_noise3d(15 * x * Away(x, y, z), 15 * y * Away(x, y, z) + 0.6 * (x * x + z * z), 15 * z * Away(x, y, z)) - 0.62)
}
// Fire: the absolute value of the noise makes creases, which rise.
#declare Flame = function(x, y, z) {
  Density(x, 0.72 * y - 0.1, z)
  - 0.62 * abs(Signed(2 * x, 1.5 * y, 2 * z)) - 0.33 * abs(Signed(4 * x, 3 * y, 4 * z)) - 0.17 * abs(Signed(8 * x, 6 * y, 8 * z))
  - 0.08 * abs(Signed(16 * x, 12 * y, 16 * z))
}
#macro Hyper(Function, Threshold)
  isosurface {
    function { Threshold - Function(x, y, z) }
    contained_by { sphere { 0, 1.75 } }
    max_gradient 30
    accuracy 0.001
  }
#end

object {
  Hyper(Eroded, 0.5)
  texture {
    pigment { granite color_map { [0 srgb <0.48, 0.40, 0.33>] [0.5 srgb <0.66, 0.58, 0.49>] [1 srgb <0.80, 0.74, 0.66>] } scale 2 }
    finish { ambient 0.02 diffuse 0.8 specular 0.12 roughness 0.03 }
  }
  rotate 40 * y
  translate <-2.75, 1.2, 0.2>
}
#if (Balls > 1)
object {
  Hyper(Fur, 0.32)
  texture {
    pigment { onion color_map { [0 srgb <0.22, 0.10, 0.05>] [0.55 srgb <0.42, 0.20, 0.08>] [1 srgb <0.90, 0.64, 0.30>] } scale 1.3 }
    finish { ambient 0.02 diffuse 0.75 specular 0.25 roughness 0.03 }
  }
  translate <0, 1.2, 0>
}
object {
  Hyper(Flame, 0.2)
  texture {
    pigment { spherical color_map { [0 srgb <0.10, 0.22, 0.32>] [0.35 srgb <0.20, 0.52, 0.60>] [1 srgb <0.86, 0.96, 0.94>] } scale 1.5 }
    finish { ambient 0.02 diffuse 0.6 specular 0.5 roughness 0.01 reflection { 0.05, 0.5 fresnel on } conserve_energy }
  }
  interior { ior 1.4 }
  translate <2.75, 1.25, 0.2>
}
#end

plane {
  y, -0.05
  texture {
    pigment { srgb <0.30, 0.31, 0.34> }
    finish { ambient 0.02 diffuse 0.6 specular 0.2 roughness 0.01 reflection { 0.04, 0.5 fresnel on } conserve_energy }
  }
  interior { ior 1.5 }
}
sky_sphere { pigment { gradient y color_map { [0 srgb <0.52, 0.52, 0.56>] [0.5 srgb <0.20, 0.24, 0.34>] [1 srgb <0.09, 0.11, 0.18>] } } }
light_source { <-6, 9, -7>, rgb <1.45, 1.32, 1.15> }
light_source { <8, 4, -3>, rgb <0.22, 0.28, 0.40> shadowless }

camera {
  location <0, 2.5, -8.6>
  right x * image_width / image_height
  angle 47
  look_at <0, 1.05, 0>
}
