// 3,922,632,451 balls: the sphereflake of ten generations. Every generation is declared once, and used nine times in the next: so the scene has
// eleven balls, ten unions and ninety places. The program writes out a twig of 7,381 balls, stores the rest as instances within instances, and takes 27 MB.
// The eye is close to a twig: each of its smallest bumps has thousands of balls.
//
//     strahl render scenes/showcase/billions.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 4 }

#ifndef (Generations) #declare Generations = 10; #end

#declare Flake = sphere { 0, 1 }
#for (G, 1, Generations)
  #declare Flake = union {
    sphere { 0, 1 }
    #for (I, 0, 5)
      object { Flake scale 1 / 3 translate 4 / 3 * y rotate 90 * x rotate (60 * I + 30) * y }
    #end
    #for (I, 0, 2)
      object { Flake scale 1 / 3 translate 4 / 3 * y rotate 35.26 * x rotate (120 * I) * y }
    #end
  }
#end

object {
  Flake
  pigment { srgb <0.97, 0.80, 0.52> }
  finish { ambient 0.02 diffuse 0.45 brilliance 1.3 specular 0.6 roughness 0.01 metallic reflection { 0.35 metallic } }
}

sky_sphere {
  pigment {
    gradient y
    color_map { [0 srgb <0.62, 0.55, 0.58>] [0.3 srgb <0.34, 0.40, 0.56>] [1 srgb <0.10, 0.16, 0.32>] }
    scale 2
    translate -y
  }
}
light_source { <-6, 9, -5>, rgb <1.5, 1.38, 1.2> }
light_source { <8, 3, -6>, rgb <0.18, 0.24, 0.36> shadowless }

camera {
  location <0.55, 1.62, -1.75>
  right x * image_width / image_height
  angle 40
  look_at <0.12, 0.88, -0.35>
}
