// The sphereflake: every ball carries nine balls of a third of its size, six around its equator and three above. The macro calls
// itself; four generations are 7,381 balls. Beside it lie the steps of its growth, from the bare ball to the third generation.
//
//     strahl render scenes/showcase/sphereflake.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }

#ifndef (Generations) #declare Generations = 4; #end

camera {
  location <0.2, 4.1, -9.6>
  right x * image_width / image_height
  angle 41
  look_at <0.0, 0.92, 0>
}

light_source {
  <-6, 9, -5>, rgb <1.5, 1.36, 1.16>
  area_light 1.6 * x, 1.6 * z, 5, 5 adaptive 1 circular orient
}
light_source { <8, 5, -4>, rgb <0.16, 0.22, 0.34> shadowless }

// A dark studio with bright panels: what metal looks like is what it mirrors.
sky_sphere {
  pigment {
    gradient y
    color_map {
      [0.00 srgb <0.33, 0.25, 0.27>]
      [0.20 srgb <0.24, 0.23, 0.32>]
      [0.60 srgb <0.16, 0.20, 0.34>]
      [1.00 srgb <0.08, 0.11, 0.22>]
    }
  }
}
#macro Panel(Where, Wide, High, Light)
  box {
    <-Wide, -High, 0>, <Wide, High, 0.05>
    pigment { color Light }
    finish { ambient 0 diffuse 0 emission 1 }
    no_shadow
    rotate -degrees(atan2(Where.y, vlength(<Where.x, 0, Where.z>))) * x
    rotate degrees(atan2(Where.x, Where.z)) * y
    translate Where
  }
#end
Panel(<-9, 7, -5>, 2.2, 3, rgb <2.6, 2.2, 1.7>)
Panel(<10, 6, -3>, 1.2, 4, rgb <0.8, 1.2, 2.2>)
Panel(<-2, 12, 3>, 5, 1.2, rgb <1.5, 1.45, 1.4>)
Panel(<7, 7, 11>, 2.5, 1.5, rgb <1.9, 1.0, 0.6>)

// Polished slabs of grey granite; the joints are narrow and matt.
#declare Slab = texture {
  pigment {
    granite turbulence 0.3
    color_map { [0.0 srgb <0.26, 0.29, 0.32>] [0.45 srgb <0.34, 0.37, 0.40>] [1.0 srgb <0.44, 0.46, 0.47>] }
    scale 1.2
  }
  finish { ambient 0.02 diffuse 0.6 specular 0.3 roughness 0.005 reflection { 0.10, 0.6 fresnel on } conserve_energy }
}
#declare Joint = texture { pigment { srgb <0.10, 0.10, 0.10> } finish { ambient 0.02 diffuse 0.5 } }
plane {
  y, 0
  texture {
    gradient x
    texture_map { [0.012 Joint] [0.012 gradient z texture_map { [0.012 Joint] [0.012 Slab scale 1 / 2.2] }] }
    scale 2.2
    rotate 38 * y
  }
  interior { ior 1.6 }
}

// From the trunk to the twigs: gold, rose, copper, silver, ice.
#declare Metals = array[5] {
  srgb <1.00, 0.78, 0.36>, srgb <0.97, 0.62, 0.44>, srgb <0.86, 0.42, 0.36>, srgb <0.80, 0.74, 0.86>, srgb <0.84, 0.94, 1.00>
}
#macro Metal(Generation)
  texture {
    pigment { color Metals[Generation] }
    finish { ambient 0.02 diffuse 0.32 brilliance 1.5 specular 0.8 roughness 0.006 metallic reflection { 0.6 metallic } }
  }
#end

// One ball of radius 1 at the origin with all that grows on it up to generation Last, its own parent below it. Children touch their
// parent: they sit at distance 4/3.
#macro Flake(Generation, Last)
  union {
    sphere { 0, 1 Metal(Generation) }
    #if (Generation < Last)
      #local Child = Flake(Generation + 1, Last)
      #for (I, 0, 5)
        object { Child scale 1 / 3 translate 4 / 3 * y rotate 90 * x rotate (60 * I + 30) * y }
      #end
      #for (I, 0, 2)
        object { Child scale 1 / 3 translate 4 / 3 * y rotate 35.26 * x rotate (120 * I) * y }
      #end
    #end
  }
#end

object { Flake(0, Generations) rotate 11 * y translate <0, 1, 0.3> }

// The steps of the growth.
object { Flake(0, 0) scale 0.32 translate <-3.05, 0.32, -0.9> }
object { Flake(0, 1) rotate 20 * y scale 0.32 translate <-1.95, 0.32, -2.0> }
object { Flake(0, 2) rotate -8 * y scale 0.32 translate <1.85, 0.32, -2.05> }
object { Flake(0, 3) rotate 30 * y scale 0.32 translate <3.0, 0.32, -1.0> }
