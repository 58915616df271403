// After Turner Whitted's picture of 1980, the first by recursive ray tracing: a sphere of glass and one of metal above a
// chequered floor. The composition is our own: a bubble, a mirror ball and a handful of glass marbles in the evening.
//
//     strahl render scenes/showcase/whitted.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 }

camera {
  location <0.2, 1.9, -10.4>
  right x * image_width / image_height
  angle 50
  look_at <0.15, 1.55, 0>
}

// A low sun from the left, soft because it is an area; the sky's blue from the right.
light_source {
  <-9, 8.5, -6.5>, rgb <1.25, 1.12, 0.92>
  area_light 1.4 * x, 1.4 * z, 3, 3 adaptive 1 circular orient
}
light_source { <8, 10, -9>, rgb <0.12, 0.17, 0.28> shadowless }

sky_sphere {
  pigment {
    gradient y
    color_map {
      [0.00 srgb <0.98, 0.80, 0.60>]
      [0.06 srgb <0.94, 0.74, 0.66>]
      [0.16 srgb <0.66, 0.66, 0.80>]
      [0.34 srgb <0.28, 0.42, 0.72>]
      [1.00 srgb <0.05, 0.10, 0.34>]
    }
  }
}

// Far away everything takes the colour of the horizon.
fog { fog_type 2 distance 60 fog_offset 0 fog_alt 0.9 color srgb <0.97, 0.80, 0.62> }

// The floor of the original, red and yellow, as enamelled tiles.
plane {
  y, 0
  pigment {
    checker srgb <0.72, 0.10, 0.07>, srgb <0.96, 0.80, 0.36>
    scale 1.25
    rotate 32 * y
    translate 0.35 * x
  }
  finish { ambient 0.06 diffuse 0.75 specular 0.25 roughness 0.01 reflection { 0.02, 0.25 fresnel on } conserve_energy }
  interior { ior 1.5 }
}

// Glass as thin as a soap bubble: a ball with a ball of air in it.
difference {
  sphere { 0, 1.55 }
  sphere { 0, 1.49 }
  pigment { rgbf <0.97, 0.99, 1, 0.96> }
  finish { ambient 0 diffuse 0.02 specular 0.9 roughness 0.0008 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.45 }
  translate <-1.25, 2.1, 0.2>
}

// The mirror ball.
sphere {
  <1.75, 1.25, 1.6>, 1.25
  pigment { rgb <0.62, 0.66, 0.7> }
  finish { ambient 0 diffuse 0.12 specular 0.8 roughness 0.002 reflection { 0.78 metallic } metallic }
}

// Marbles of coloured glass: what is deep in them swallows more light.
#macro Marble(Where, Radius, Tint)
  sphere {
    Where + Radius * y, Radius
    pigment { rgbf <1, 1, 1, 0.98> }
    finish { ambient 0 diffuse 0.02 specular 0.9 roughness 0.0008 reflection { 0.01, 1 fresnel on } conserve_energy }
    interior { ior 1.52 fade_distance 0.35 fade_power 1001 fade_color Tint }
  }
#end
Marble(<0.35, 0, -2.3>, 0.52, rgb <0.10, 0.55, 0.85>)
Marble(<-2.2, 0, -2.05>, 0.34, rgb <0.25, 0.75, 0.30>)
Marble(<1.75, 0, -1.55>, 0.34, rgb <0.90, 0.35, 0.08>)
Marble(<-0.75, 0, -3.1>, 0.24, rgb <0.85, 0.12, 0.30>)
Marble(<2.95, 0, -0.7>, 0.44, rgb <0.55, 0.25, 0.85>)
