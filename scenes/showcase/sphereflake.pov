// The sphereflake: every ball carries nine balls of a third of its size, six around its equator and three above. The macro calls
// itself; four generations are 7,381 balls. Each generation has its own metal.
//
//     strahl render scenes/showcase/sphereflake.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 7 }

#ifndef (Generations) #declare Generations = 4; #end

camera {
  location <0, 2.3, -8.2>
  right x * image_width / image_height
  angle 40
  look_at <0, 1.28, 0>
}

light_source {
  <-6, 9, -6>, rgb <1.15, 1.05, 0.92>
  area_light 1.2 * x, 1.2 * z, 4, 4 adaptive 1 circular orient
}
light_source { <7, 3, -4>, rgb <0.18, 0.26, 0.45> }
light_source { <0, 4, 9>, rgb <0.5, 0.30, 0.22> }

sky_sphere {
  pigment {
    gradient y
    color_map {
      [0.00 srgb <0.60, 0.36, 0.34>]
      [0.12 srgb <0.38, 0.30, 0.42>]
      [0.45 srgb <0.12, 0.16, 0.32>]
      [1.00 srgb <0.03, 0.05, 0.14>]
    }
  }
}

// A wet, dark floor.
plane {
  y, 0
  pigment { srgb <0.13, 0.14, 0.18> }
  finish { ambient 0.02 diffuse 0.6 specular 0.3 roughness 0.01 reflection 0.28 }
}

// From the trunk to the twigs: gold, rose, copper, silver, ice.
#declare Metals = array[5] {
  srgb <0.95, 0.70, 0.28>, srgb <0.93, 0.52, 0.34>, srgb <0.78, 0.36, 0.42>, srgb <0.70, 0.62, 0.80>, srgb <0.80, 0.92, 1.00>
}
#macro Metal(Generation)
  texture {
    pigment { color Metals[Generation] }
    finish { ambient 0.03 diffuse 0.35 specular 0.75 roughness 0.008 metallic reflection { 0.45 metallic } }
  }
#end

// One ball of radius 1 at the origin with all that grows on it, its own parent below it. Children touch their parent: they sit at
// distance 4/3.
#macro Flake(Generation)
  union {
    sphere { 0, 1 Metal(Generation) }
    #if (Generation < Generations)
      #local Child = Flake(Generation + 1)
      #for (I, 0, 5)
        object { Child scale 1 / 3 translate 4 / 3 * y rotate 90 * x rotate (60 * I + 30) * y }
      #end
      #for (I, 0, 2)
        object { Child scale 1 / 3 translate 4 / 3 * y rotate 35.26 * x rotate (120 * I) * y }
      #end
    #end
  }
#end

object { Flake(0) rotate <0, 11, 0> translate 1 * y }
