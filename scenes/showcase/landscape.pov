// A fractal landscape at the end of the day: ridges of noise at eight scales, each half as wide as the one before, sampled into a mesh
// that is finer towards the eye. Snow lies where the ground is high and flat, grass where it is low; the lake lies at height 0.
//
//     strahl render scenes/showcase/landscape.pov +W1280 +H720 +A0.3
#version 3.7;
#include "functions.inc"
global_settings { assumed_gamma 1 max_trace_level 4 }

// How many points the mesh has, across and deep.
#ifndef (Across) #declare Across = 480; #end
#ifndef (Deep) #declare Deep = 480; #end

// Ridged noise: 1 on the lines where the noise is 0, falling off to both sides.
#declare Ridge = function(x, y, s) { pow(1 - abs(2 * f_noise3d(x, s, y) - 1), 2) }
// Every scale is stronger where the one above it is high: crests are jagged and valleys are smooth.
#declare First = function(x, y) { Ridge(x, y, 0.3) }
#declare Second = function(x, y) { Ridge(2.03 * x, 2.03 * y, 5.1) * (0.15 + First(x, y)) }
#declare Third = function(x, y) { Ridge(4.1 * x, 4.1 * y, 9.7) * (0.10 + Second(x, y)) }
#declare Fourth = function(x, y) { Ridge(8.3 * x, 8.3 * y, 14.2) * (0.10 + Third(x, y)) }
#declare Fine = function(x, y) {
    0.36 * Ridge(16.7 * x, 16.7 * y, 20.4) + 0.20 * Ridge(33.1 * x, 33.1 * y, 31.8)
  + 0.11 * Ridge(66.0 * x, 66.0 * y, 41.2) + 0.06 * Ridge(131.0 * x, 131.0 * y, 47.9)
}
#declare Rough = function(x, y) {
  0.36 * First(x, y) + 0.27 * Second(x, y) + 0.21 * Third(x, y) + 0.15 * Fourth(x, y) + Fine(x, y) * (0.03 + 0.16 * Third(x, y))
}
// Noise bends the ridges, so that they are not straight for long.
#declare Bent = function(x, y) {
  Rough(x + 0.16 * (f_noise3d(1.7 * x, 60.3, 1.7 * y) - 0.5), y + 0.16 * (f_noise3d(1.7 * x, 71.9, 1.7 * y) - 0.5))
}
// The lie of the land: a valley with the lake in the middle, mountains behind and beside it.
#declare Lie = function(x, y) { 0.62 * exp(-pow((y - 17) / 7.5, 2)) + 0.34 * exp(-pow((x + 7) / 3.6, 2)) * exp(-pow((y - 8) / 6, 2)) + 0.26 * exp(-pow((x - 8.5) / 3.8, 2)) * exp(-pow((y - 7) / 6, 2)) }
#declare Height = function(x, y) {
  -0.42 + Bent(0.155 * x + 3.7, 0.155 * y + 1.3) * (0.46 + 8 * Lie(x, y)) + 0.9 * Lie(x, y)
  - 0.5 * exp(-pow((y - 4.5) / 3.4, 2)) * exp(-pow((x - 0.6) / (0.6 + 0.6 * y), 2))
}

// Where the point (I, J) of the mesh lies: rows are closer to each other towards the eye, and as wide as the view.
#declare Near = 1.2;
#declare Far = 27;
#declare RowZ = function(j) { Near * pow(Far / Near, j / (Deep - 1)) }
#declare Point = array[Across * Deep];
#for (J, 0, Deep - 1)
  #local Z = RowZ(J);
  #for (I, 0, Across - 1)
    #local X = (2 * I / (Across - 1) - 1) * (1.0 + 0.82 * Z);
    #local H = Height(X, Z);
    #declare Point[J * Across + I] = <X, H, Z>;
  #end
#end

#declare Land = mesh2 {
  vertex_vectors { Across * Deep #for (I, 0, Across * Deep - 1) Point[I] #end }
  face_indices {
    2 * (Across - 1) * (Deep - 1)
    #for (J, 0, Deep - 2)
      #for (I, 0, Across - 2)
        #local A = J * Across + I;
        <A, A + Across, A + 1> <A + 1, A + Across, A + Across + 1>
      #end
    #end
  }
}

// Rock in layers, light and dark, bent and cracked.
#declare Rock = texture {
  pigment {
    gradient y
    turbulence 0.35 octaves 7 omega 0.6
    color_map {
      [0.00 srgb <0.30, 0.28, 0.28>]
      [0.25 srgb <0.46, 0.42, 0.39>]
      [0.40 srgb <0.36, 0.33, 0.32>]
      [0.65 srgb <0.54, 0.49, 0.44>]
      [0.80 srgb <0.40, 0.35, 0.32>]
      [1.00 srgb <0.30, 0.28, 0.28>]
    }
    scale 0.45
    rotate 9 * z
  }
  normal { granite 0.7 scale 0.35 }
  finish { ambient 0.0 diffuse 0.85 }
}
// Meadows with dark trees.
#declare Grass = texture {
  pigment {
    bozo turbulence 0.5 octaves 6 omega 0.7
    color_map {
      [0.00 srgb <0.30, 0.33, 0.13>]
      [0.40 srgb <0.36, 0.36, 0.16>]
      [0.52 srgb <0.15, 0.20, 0.10>]
      [1.00 srgb <0.09, 0.14, 0.08>]
    }
    scale 0.13
  }
  normal { granite 0.5 scale 0.05 }
  finish { ambient 0.0 diffuse 0.85 }
}
#declare Snow = texture {
  pigment { srgb <0.93, 0.94, 0.98> }
  normal { granite 0.15 scale 0.12 }
  finish { ambient 0.0 diffuse 0.9 specular 0.1 roughness 0.1 }
}
// By slope (0 is upright, 1 is level): rock, and what lies on it.
#declare Lowland = texture { slope y texture_map { [0.68 Rock] [0.74 Grass] } }
#declare Highland = texture { slope y texture_map { [0.61 Rock] [0.66 Snow] } }

object {
  Land
  texture {
    gradient y
    turbulence 0.1 octaves 4
    texture_map { [0.00 Lowland] [0.26 Lowland] [0.36 Highland] [1.00 Highland] }
    scale 8
    translate -y
  }
}

// The lake.
plane {
  y, 0
  pigment { srgb <0.03, 0.06, 0.08> }
  normal { bumps 0.035 scale <0.30, 0.2, 0.09> }
  finish { ambient 0 diffuse 0.5 specular 0.4 roughness 0.004 reflection { 0.08, 0.95 fresnel on } conserve_energy }
  interior { ior 1.33 }
}

// A low sun from the left, the sky from above.
#declare Sun = vnormalize(<-1, 0.42, -0.35>);
light_source { 1000 * Sun, rgb <2.6, 1.8, 1.15> parallel point_at 0 }
light_source { <300, 900, -400>, rgb <0.16, 0.22, 0.36> parallel point_at 0 shadowless }

sky_sphere {
  pigment {
    gradient y
    color_map {
      [0.00 srgb <0.98, 0.74, 0.52>]
      [0.08 srgb <0.90, 0.68, 0.62>]
      [0.22 srgb <0.52, 0.58, 0.76>]
      [0.55 srgb <0.20, 0.32, 0.60>]
      [1.00 srgb <0.10, 0.18, 0.42>]
    }
  }
  pigment {
    bozo
    turbulence 0.75 octaves 6 omega 0.6 lambda 2.2
    color_map {
      [0.00 srgbt <1.0, 0.86, 0.74, 0.15>]
      [0.32 srgbt <1.0, 0.80, 0.70, 0.55>]
      [0.55 srgbt <1, 0.9, 0.85, 1>]
    }
    scale <0.55, 0.09, 0.55>
    rotate 8 * z
  }
}
fog { fog_type 2 distance 34 fog_offset 0 fog_alt 1.2 color srgb <0.76, 0.74, 0.82> }

camera {
  location <0, 0.55, -1.2>
  right x * image_width / image_height
  angle 62
  look_at <0.2, 1.15, 6>
}
