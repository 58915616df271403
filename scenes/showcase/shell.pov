// Sea shells: subdivision surfaces of small cages. Each cage is a string of rings of eight points, led along a spiral that grows by the same
// factor with every turn; single points are pulled out as thorns. At the mouth the rings turn inwards and lead back into the dark. The
// surface is met at its limit, so the thorns are round at any size of the picture. The stripes follow the cage: texture coordinates
// are given for each corner.
//
//     strahl render scenes/showcase/shell.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 4 }

camera {
  location <0.4, 3.1, -7.2>
  right x * image_width / image_height
  angle 40
  look_at <0.1, 0.85, 0>
}
light_source { <-7, 9, -6>, rgb <1.25, 1.15, 1.0> area_light 2 * x, 2 * z, 5, 5 adaptive 1 circular orient }
light_source { <6, 5, -8>, rgb <0.12, 0.15, 0.2> shadowless }
background { srgb <0.72, 0.83, 0.90> }

// The middle of the tube at an angle, as seen from the tip, and its size there. `Growth` is per turn.
#macro Size(A) pow(Growth, A / 360 - Turns) #end
#macro Middle(A) Size(A) * <Wide * cos(radians(A)), -High, Wide * sin(radians(A))> #end
// Point K of 8 of the ring at angle A, blown up by a factor.
#macro Ring_Point(A, K, Factor)
  Middle(A) + Size(A) * Tube * Factor
    * (cos(radians(45 * K)) * <cos(radians(A)), 0, sin(radians(A))> + 1.12 * sin(radians(45 * K)) * y)
#end

// A shell with thorns on every `Every`-th ring.
#macro Shell(Turns, Growth, Wide, High, Tube, Every, Thorn)
  #local Step = 24;
  #local Outer = int(Turns * 360 / Step);
  #local Inner = 14;
  #local Rings = Outer + Inner;
  subdivision {
    points {
      #for (R, 0, Rings)
        #local Way = (R > Outer ? Outer - 0.62 * (R - Outer - 1) : R);
        #for (K, 0, 7)
          #local Factor = (R > Outer ? 0.86 : 1);
          #if (R <= Outer & R >= Outer - 1) #local Factor = 1.1; #end
          #if (R < Outer & R > 12 & mod(R, Every) = 0 & K = 1) #local Factor = Thorn; #end
          Ring_Point(Way * Step, K, Factor)
        #end
      #end
    }
    face { 7, 6, 5, 4, 3, 2, 1, 0 uv { #for (K, 0, 7) <0, 0>, #end } }
    #for (R, 0, Rings - 1)
      #for (K, 0, 7)
        #local L = mod(K + 1, 8);
        face {
          8 * R + K, 8 * R + L, 8 * R + 8 + L, 8 * R + 8 + K
          uv { <R, K> / 8, <R, K + 1> / 8, <R + 1, K + 1> / 8, <R + 1, K> / 8 }
        }
      #end
    #end
    // The rim of the mouth.
    crease { sharpness 1.5 #for (K, 0, 8) 8 * Outer + mod(K, 8), #end }
  }
#end

// Flames across the stripes: u counts the rings, v runs once around each.
#declare Cream = pigment { srgb <0.97, 0.91, 0.82> }
#declare Flames = pigment {
  gradient u
  color_map { [0.0 srgb <0.80, 0.50, 0.30>] [0.3 srgb <0.50, 0.22, 0.12>] [0.5 srgb <0.50, 0.22, 0.12>] [0.8 srgb <0.95, 0.80, 0.64>] [1.0 srgb <0.80, 0.50, 0.30>] }
  scale 0.375
  warp { turbulence 0.12 }
}
#declare Shine = finish { ambient 0.1 diffuse 0.75 specular 0.5 roughness 0.01 reflection { 0.01, 0.12 fresnel on } }
#declare Banded = texture {
  uv_mapping
  pigment {
    gradient v
    pigment_map {
      [0.00 Cream] [0.06 Flames] [0.13 Cream] [0.20 srgb <0.96, 0.82, 0.68>] [0.60 srgb <0.96, 0.80, 0.70>]
      [0.72 Cream] [0.78 Flames] [0.86 Flames] [0.92 Cream] [1.00 Cream]
    }
  }
  finish { Shine }
}
#declare Rosy = texture {
  uv_mapping
  pigment {
    gradient v
    color_map { [0.0 srgb <0.80, 0.45, 0.45>] [0.2 srgb <0.97, 0.88, 0.84>] [0.7 srgb <0.97, 0.88, 0.84>] [0.9 srgb <0.70, 0.36, 0.40>] [1.0 srgb <0.80, 0.45, 0.45>] }
  }
  finish { Shine }
}

// A whelk with thorns, lying on its side, its mouth towards the eye.
object {
  Shell(5.4, 1.72, 0.62, 2.35, 0.74, 3, 2.3)
  texture { Banded }
  translate 1.6 * y
  rotate 250 * y
  rotate <0, 0, 68>
  rotate 18 * y
  translate <0.35, 1.27, 0.3>
}

// A tower without thorns.
object {
  Shell(8.3, 1.28, 0.20, 1.9, 0.26, 3, 1)
  texture { Rosy }
  scale 1.05
  rotate 60 * y
  rotate <0, 0, 80>
  rotate -28 * y
  translate <-2.2, 0.36, -1.2>
}

// Sand with the ripples of the last wave.
plane {
  y, 0
  pigment {
    granite
    color_map { [0 srgb <0.86, 0.76, 0.60>] [0.6 srgb <0.92, 0.84, 0.70>] [1 srgb <0.80, 0.68, 0.52>] }
    scale 0.5
  }
  normal { average normal_map { [1 bumps 0.25 scale 0.03] [1 ripples 0.35 turbulence 0.4 scale 0.9 frequency 1] } }
  finish { ambient 0.1 diffuse 0.85 }
}
fog { distance 60 color srgb <0.80, 0.86, 0.90> }
