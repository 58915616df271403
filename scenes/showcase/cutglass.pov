// Cut glass on a chequered board: a brilliant, a ball of many facets and a step cut, each the intersection of planes. What sparkles is
// total reflection: up to eight generations of rays.
//
//     strahl render scenes/showcase/cutglass.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 adc_bailout 0.03 }

camera {
  location <0.4, 3.4, -8.4>
  right x * image_width / image_height
  angle 46
  look_at <0, 0.85, 0>
}

light_source { <-5, 8, 3>, rgb <1.3, 1.18, 1.0> }
light_source { <6, 6, -6>, rgb <0.3, 0.35, 0.45> shadowless }

// A dark room with windows: the facets need something to show.
sky_sphere {
  pigment {
    gradient y
    color_map { [0.0 srgb <0.13, 0.10, 0.10>] [0.25 srgb <0.20, 0.19, 0.24>] [1.0 srgb <0.42, 0.48, 0.62>] }
  }
}
#macro Window(Where, Wide, High, Light)
  union {
    #for (I, 0, 1)
      #for (J, 0, 1)
        box { <(I - 1) * Wide + 0.1, (J - 1) * High + 0.1, 0>, <I * Wide - 0.1, J * High - 0.1, 0.1> }
      #end
    #end
    pigment { color Light }
    finish { ambient 0 diffuse 0 emission 1 }
    no_shadow
    #local Turn = degrees(atan2(Where.x, Where.z));
    rotate <-degrees(atan2(Where.y, vlength(<Where.x, 0, Where.z>))), Turn, 0>
    translate Where
  }
#end
Window(<-11, 8, -3>, 2.6, 3.2, rgb <2.2, 2.0, 1.7>)
Window(<10, 9, -5>, 2.4, 3, rgb <1.3, 1.55, 2.0>)
Window(<3, 11, 10>, 3.2, 2.2, rgb <1.6, 1.5, 1.4>)

// The board: marble fields in a wooden frame.
#declare Light_Marble = texture {
  pigment {
    marble turbulence 0.9 octaves 5
    color_map { [0 srgb <0.92, 0.89, 0.83>] [0.75 srgb <0.88, 0.83, 0.75>] [1 srgb <0.62, 0.56, 0.50>] }
    scale 0.9 rotate <20, 35, 0>
  }
  finish { ambient 0.04 diffuse 0.75 specular 0.25 roughness 0.008 reflection 0.1 }
}
#declare Dark_Marble = texture {
  pigment {
    marble turbulence 1.1 octaves 6
    color_map { [0 srgb <0.05, 0.06, 0.07>] [0.85 srgb <0.10, 0.11, 0.12>] [1 srgb <0.48, 0.46, 0.42>] }
    scale 1.1 rotate <10, -50, 20>
  }
  finish { ambient 0.04 diffuse 0.75 specular 0.3 roughness 0.006 reflection 0.12 }
}
box { <-4, -0.2, -4>, <4, 0, 4> texture { checker texture { Dark_Marble } texture { Light_Marble } } rotate 24 * y }
difference {
  box { <-4.35, -0.3, -4.35>, <4.35, 0.05, 4.35> }
  box { <-4, -1, -4>, <4, 1, 4> }
  pigment { wood turbulence 0.06 color_map { [0 srgb <0.32, 0.17, 0.09>] [1 srgb <0.20, 0.10, 0.05>] } rotate 88 * x scale 0.25 }
  finish { ambient 0.03 diffuse 0.7 specular 0.3 roughness 0.02 reflection 0.05 }
  rotate 24 * y
}
plane { y, -0.3 pigment { srgb <0.16, 0.10, 0.08> } finish { ambient 0.04 diffuse 0.7 reflection 0.04 } }

#macro Glass(Tint, Depth)
  pigment { rgbf <1, 1, 1, 0.99> }
  finish { ambient 0 diffuse 0.005 specular 0.9 roughness 0.0006 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.62 fade_distance Depth fade_power 1001 fade_color Tint }
#end

// A plane at a distance from the origin, leaning Up degrees out of the horizontal and turned around y.
#macro Facet(Up, Turn, Distance)
  plane { x, Distance rotate Up * z rotate Turn * y }
#end

// The round brilliant: table, 8 stars, 8 mains and 16 halves above the girdle; 8 mains and 16 halves below. Radius 1 at y = 0.
#declare Brilliant = intersection {
  plane { y, 0.36 }
  #for (I, 0, 7)
    Facet(90 - 34.5, 45 * I, 0.565 * sin(radians(90)) + 0.02)
    Facet(90 - 22, 45 * I + 22.5, 0.535)
    Facet(-90 + 40.8, 45 * I, 0.655)
  #end
  #for (I, 0, 15)
    Facet(90 - 41.5, 22.5 * I + 11.25, 0.668)
    Facet(-90 + 42.4, 22.5 * I + 11.25, 0.676)
  #end
  cylinder { -y, y, 1 }
  bounded_by { cylinder { -y, 0.37 * y, 1.001 } }
}

// A ball of facets in rings, as cut for chandeliers.
#declare Ball = intersection {
  #for (Ring, -4, 4)
    #local Lean = 20 * Ring;
    #local Count = max(1, ceil(15 * cos(radians(Lean))));
    #for (I, 0, Count - 1)
      Facet(Lean, 360 / Count * (I + Ring / 2), 1)
    #end
  #end
  bounded_by { sphere { 0, 1.1 } }
}

// A step cut, eight-sided.
#declare Step = intersection {
  plane { y, 0.42 }
  plane { -y, 0.80 }
  #for (I, 0, 7)
    #local Corner = mod(I, 2);
    #local R = (Corner ? 1.02 : 0.82);
    Facet(0, 45 * I, R)
    Facet(32, 45 * I, R * cos(radians(32)) + 0.15 * sin(radians(32)))
    Facet(52, 45 * I, R * cos(radians(52)) + 0.21 * sin(radians(52)))
    Facet(-28, 45 * I, R * cos(radians(28)) + 0.08 * sin(radians(28)))
    Facet(-46, 45 * I, R * cos(radians(46)) + 0.24 * sin(radians(46)))
  #end
  bounded_by { box { <-1.05, -0.81, -1.05>, <1.05, 0.43, 1.05> } }
}

// The brilliant lies on its girdle and its point.
object { Brilliant scale 1.35 rotate 12 * y rotate -41.5 * x rotate -24 * y translate <-0.15, 0.93, -0.9> Glass(rgb <0.93, 0.98, 1.0>, 3) }
object { Ball scale 0.98 translate <-2.5, 0.98, 0.75> Glass(rgb <0.95, 0.62, 0.22>, 1.6) }
object { Step scale <1.1, 1.1, 0.85> rotate 32 * y translate <2.2, 0.88, 0.9> Glass(rgb <0.20, 0.75, 0.55>, 1.3) }
