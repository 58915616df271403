// Parts of a gearbox on their blueprint: cylinders, boxes, cones, tori and spheres, added, cut and drilled.
//
//     strahl render scenes/showcase/gearbox.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 6 }

camera {
  location <-1.5, 6.1, -8.9>
  right x * image_width / image_height
  angle 46
  look_at <0.15, 0.3, -0.1>
}

light_source {
  <-7, 11, -3>, rgb <1.05, 0.98, 0.88>
  area_light 1.6 * x, 1.6 * z, 4, 4 adaptive 1 circular orient
}
light_source { <8, 6, -8>, rgb <0.16, 0.2, 0.28> shadowless }

// A studio: what metal looks like is what it mirrors. Dark walls, two bright panels overhead.
sky_sphere {
  pigment {
    gradient y
    color_map { [0 srgb <0.16, 0.17, 0.20>] [0.4 srgb <0.30, 0.32, 0.36>] [1 srgb <0.50, 0.52, 0.56>] }
  }
}
#macro Panel(Where, Turn)
  box { <-2.6, 0, -1.1>, <2.6, 0.05, 1.1> pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 2.2 } no_shadow rotate Turn translate Where }
#end
Panel(<-3, 8, 5>, <-25, 0, 15>)
Panel(<5.5, 7, 2>, <0, 40, -30>)
Panel(<-8, 5, -1>, <0, 80, 50>)

// The blueprint: its grid is in the pigment.
#declare Paper = srgb <0.10, 0.25, 0.50>;
#declare Ink = srgb <0.80, 0.90, 1.00>;
#macro Grid(Axis, Step, Width, Strength)
  texture {
    pigment {
      gradient Axis
      color_map {
        [Width / Step srgbt <0.65, 0.80, 1.00, 1 - Strength>]
        [Width / Step rgbt 1]
      }
      scale Step
    }
    finish { ambient 0.12 diffuse 0.7 }
  }
#end
plane {
  y, 0
  texture {
    pigment { bozo color_map { [0 Paper] [1 Paper * 1.25] } scale 2.5 }
    finish { ambient 0.12 diffuse 0.7 }
  }
  Grid(x, 0.25, 0.008, 0.16)
  Grid(z, 0.25, 0.008, 0.16)
  Grid(x, 1.25, 0.014, 0.3)
  Grid(z, 1.25, 0.014, 0.3)
}

#declare Drawn = texture { pigment { Ink } finish { ambient 0.25 diffuse 0.65 } }
#macro Circle(C, R)
  disc { C + 0.002 * y, y, R + 0.011, R - 0.011 texture { Drawn } no_shadow }
#end
#macro Dashes(A, B, Count)
  #for (I, 0, Count - 1)
    #local P = A + (B - A) * (I / Count);
    #local Q = A + (B - A) * ((I + 0.62) / Count);
    cylinder { P, Q, 0.011 scale <1, 0.1, 1> translate 0.002 * y texture { Drawn } no_shadow }
  #end
#end
#macro LineOf(A, B)
  cylinder { A, B, 0.011 scale <1, 0.1, 1> translate 0.002 * y texture { Drawn } no_shadow }
#end

#declare Steel = texture {
  pigment { srgb <0.80, 0.82, 0.86> }
  finish { ambient 0.02 diffuse 0.34 brilliance 2 specular 0.8 roughness 0.01 metallic reflection { 0.55 metallic } }
}
#declare Dark_Steel = texture {
  pigment { srgb <0.34, 0.36, 0.40> }
  finish { ambient 0.02 diffuse 0.4 specular 0.5 roughness 0.03 metallic reflection { 0.2 metallic } }
}
#declare Brass = texture {
  pigment { srgb <0.96, 0.76, 0.36> }
  finish { ambient 0.03 diffuse 0.42 brilliance 2 specular 0.7 roughness 0.015 metallic reflection { 0.45 metallic } }
}

// A spur gear around y: the teeth are wedges of two boxes, chamfered together with the rim by two cones.
#macro Gear(Teeth, R, Thick)
  #local Pitch = 2 * pi * R / Teeth;
  #local Tooth = intersection {
    box { <-Pitch, 0, -Pitch>, <R * 0.27, Thick, Pitch * 0.27> rotate 11 * y translate (R * 0.9) * x }
    box { <-Pitch, 0, -Pitch * 0.27>, <R * 0.27, Thick, Pitch> rotate -11 * y translate (R * 0.9) * x }
    cylinder { 0, Thick * y, R * 1.09 }
    bounded_by { box { <R * 0.7, 0, -Pitch>, <R * 1.1, Thick, Pitch> } }
  }
  intersection {
    union {
      cylinder { 0, Thick * y, R * 0.93 }
      #for (I, 0, Teeth - 1)
        object { Tooth rotate (360 / Teeth * I) * y }
      #end
    }
    cone { -R * y, 2.04 * R + Thick, (1.04 * R + Thick) * y, 0 }
  }
#end

#declare Wheel = difference {
  union {
    Gear(26, 1.7, 0.42)
    cylinder { 0, 0.72 * y, 0.62 }
  }
  // The web is turned down on both sides,
  difference {
    cylinder { 0.3 * y, 0.5 * y, 1.36 }
    cylinder { 0.2 * y, 0.6 * y, 0.62 }
  }
  // drilled,
  #for (I, 0, 5)
    cylinder { -y, 2 * y, 0.24 translate 1 * x rotate (60 * I + 14) * y }
  #end
  // bored for its shaft, with a keyway and a chamfer.
  cylinder { -y, 2 * y, 0.34 }
  box { <-0.1, -1, 0>, <0.1, 2, 0.46> }
  cone { 0.64 * y, 0.34, 0.74 * y, 0.44 }
  texture { Steel }
}

#declare Pinion = difference {
  union {
    Gear(13, 0.85, 0.5)
    cylinder { 0, 0.78 * y, 0.42 }
  }
  cylinder { -y, 2 * y, 0.2 }
  box { <-0.06, -1, 0>, <0.06, 2, 0.28> }
  cone { 0.72 * y, 0.2, 0.8 * y, 0.27 }
  texture { Brass }
}

// A ball bearing: two rings with grooves, nine balls and the riveted cage.
#declare Bearing = union {
  difference {
    cylinder { 0, 0.44 * y, 1 }
    cylinder { -y, y, 0.78 }
    torus { 0.66, 0.2 translate 0.22 * y }
    texture { Steel }
  }
  difference {
    cylinder { 0, 0.44 * y, 0.54 }
    cylinder { -y, y, 0.38 }
    torus { 0.66, 0.2 translate 0.22 * y }
    texture { Steel }
  }
  #for (I, 0, 8)
    sphere { <0.66, 0.22, 0>, 0.18 rotate (40 * I) * y texture { Steel } }
  #end
  difference {
    cylinder { 0.17 * y, 0.27 * y, 0.7 }
    cylinder { 0, y, 0.62 }
    #for (I, 0, 8)
      sphere { <0.66, 0.22, 0>, 0.19 rotate (40 * I) * y }
    #end
    texture { Brass }
  }
}

// A hexagon screw; the thread is a stack of double cones.
#declare Screw = union {
  difference {
    intersection {
      box { <-0.3, 0, -1>, <0.3, 0.26, 1> }
      box { <-0.3, 0, -1>, <0.3, 0.26, 1> rotate 60 * y }
      box { <-0.3, 0, -1>, <0.3, 0.26, 1> rotate 120 * y }
      sphere { -0.22 * y, 0.56 }
    }
    cylinder { 0.2 * y, y, 0.12 }
  }
  cylinder { -0.06 * y, 0, 0.3 }
  cylinder { -0.5 * y, 0, 0.155 }
  #for (I, 0, 8)
    cone { (-0.5 - 0.07 * I) * y, 0.125, (-0.535 - 0.07 * I) * y, 0.16 }
    cone { (-0.535 - 0.07 * I) * y, 0.16, (-0.57 - 0.07 * I) * y, 0.125 }
  #end
  cone { -1.13 * y, 0.125, -1.18 * y, 0.09 }
  texture { Dark_Steel }
}

// The wheel and its pinion in mesh: pitch radii 1.7 and 0.85.
object { Wheel rotate 4 * y translate <-1.3, 0, 0.35> }
object { Pinion rotate 16 * y translate <1.27, 0, 0.35> }
object { Bearing rotate <-57, 0, 0> rotate -28 * y translate <2.75, 0.83, 1.55> }
object { Bearing scale 0.72 translate <2.65, 0, -1.25> }
object { Screw rotate <90, 0, 0> rotate 52 * y translate <0.35, 0.3, -2.25> }
object { Screw rotate <90, 0, 0> rotate 118 * y translate <-2.45, 0.3, -2.3> }
object { Screw rotate 180 * x rotate 20 * y translate <1.55, 0.26, 2.6> }
object { Screw rotate 180 * x rotate 47 * y translate <2.75, 0.26, -1.25> }

// What the drawing shows of them.
Circle(<-1.3, 0, 0.35>, 1.7)
Circle(<-1.3, 0, 0.35>, 2.05)
Circle(<1.27, 0, 0.35>, 0.85)
Circle(<1.27, 0, 0.35>, 1.18)
Dashes(<-4.4, 0, 0.35>, <4.4, 0, 0.35>, 44)
Dashes(<-1.3, 0, -3.2>, <-1.3, 0, 3.4>, 34)
Dashes(<1.27, 0, -3.2>, <1.27, 0, 3.4>, 34)
LineOf(<-3.0, 0, -2.75>, <-1.3, 0, -2.75>)
LineOf(<-1.3, 0, -2.75>, <1.27, 0, -2.75>)
Circle(<2.65, 0, -1.25>, 0.86)
