// A streamlined car in a hall of light tubes. Its body is one NURBS surface of degree 3, from which the arches of the wheels and the mouth are
// cut; its cockpit is another.
//
// Makers of cars judge a surface by such stripes. A mirror shows stripes in the direction of its normal: where two pieces of a surface meet
// at an edge, the stripes break off. Where they have the same tangent planes (G1), the normals are the same, and stripes meet, but with a kink.
// Where they bend alike, too (G2, the same curvature), stripes meet without a kink. The body has 108 pieces, and no stripe shows where they meet:
// in `S(u, v) = sum P_ij N_i(u) N_j(v)` the B-splines `N` of degree p have p - 1 continuous derivatives at a knot that is not
// repeated (L. Piegl, W. Tiller, The NURBS Book, 2nd ed., chapters 2 and 3), so here the second ones are continuous. With degree 2 only the first
// ones are, and there are kinks: `Declare=Degree=2` shows them.
//
// The surface is met itself, not triangles instead of it, so the stripes are as smooth close up. All tubes run to one point at the end of the hall;
// where the body mirrors it, the stripes meet in a star.
//
//     strahl render scenes/showcase/streamliner.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 6 }

#ifndef (Degree) #declare Degree = 3; #end

camera {
  location <-5.2, 1.45, -4.6>
  right x * image_width / image_height
  angle 40
  look_at <-0.3, 0.62, 0>
}

// The hall: long tubes of light around its vault, warm above the floor and cool at the top.
#declare Dark = pigment { srgb <0.02, 0.022, 0.03> }
#declare Glow = pigment {
  gradient y
  color_map { [0.0 srgb <0.80, 0.25, 0.06>] [0.25 srgb <1.0, 0.55, 0.24>] [0.6 srgb <1.0, 0.93, 0.84>] [1.0 srgb <0.75, 0.90, 1.0>] }
  scale 5.6
  rotate -90 * z
}
cylinder {
  -40 * x, 40 * x, 5.5 open
  pigment {
    radial
    pigment_map { [0.34 Dark] [0.34 Glow] [0.66 Glow] [0.66 Dark] }
    frequency 28
    rotate 90 * z
  }
  finish { ambient 0 diffuse 0 emission 1 }
  no_shadow
}
light_source { <-2, 5, -2>, rgb 0.9 area_light 6 * x, 2 * z, 5, 2 adaptive 1 }

// A closed section of the body: one half from the middle of the floor to the middle of the back, and its mirror image. As many points as
// the degree says come twice, so that the surface closes as smoothly as it is elsewhere.
#macro Section(X, Wide, Floor, Waist, Fender, Inner, Top)
  #local Half = array[7] {
    <X, Floor, 0>, <X, Floor, 0.7 * Wide>, <X, Floor + 0.03, Wide>, <X, Waist, 1.06 * Wide>,
    <X, Fender, 0.86 * Wide>, <X, Inner, 0.42 * Wide>, <X, Top, 0>
  }
  row {
    #for (I, 0, 11 + Degree)
      #local J = mod(I, 12);
      #if (J > 6) Half[12 - J] * <1, 1, -1> #else Half[J] #end
    #end
  }
#end
// From the nose to the tail; the first section and the last are points. How far, how wide, and the heights of floor, waist, fender, bonnet
// beside the middle, and middle.
#declare Body = nurbs {
  degree Degree
  u_knots { #for (I, 0, 12 + 2 * Degree) I, #end }
  Section(-2.45, 0,    0.40, 0.40, 0.40, 0.40, 0.40)
  Section(-2.45, 0.50, 0.24, 0.34, 0.54, 0.52, 0.50)
  Section(-2.15, 0.88, 0.20, 0.42, 0.74, 0.66, 0.62)
  Section(-1.50, 0.96, 0.20, 0.50, 1.06, 0.72, 0.72)
  Section(-0.85, 0.92, 0.20, 0.50, 0.86, 0.84, 0.88)
  Section(-0.20, 0.86, 0.20, 0.48, 0.74, 0.90, 0.98)
  Section( 0.50, 0.86, 0.20, 0.50, 0.76, 0.90, 1.02)
  Section( 1.10, 0.96, 0.20, 0.52, 1.06, 0.84, 1.06)
  Section( 1.70, 0.94, 0.22, 0.54, 1.08, 0.80, 1.02)
  Section( 2.30, 0.70, 0.30, 0.54, 0.84, 0.72, 0.88)
  Section( 2.75, 0.34, 0.42, 0.54, 0.64, 0.62, 0.68)
  Section( 2.75, 0,    0.54, 0.54, 0.54, 0.54, 0.54)
}

#declare Wheel = union {
  torus { 0.27, 0.09 rotate 90 * x pigment { srgb 0.04 } finish { diffuse 0.6 specular 0.2 roughness 0.05 } }
  union {
    difference { cylinder { -0.06 * z, 0.06 * z, 0.25 } sphere { 0, 1 scale <0.21, 0.21, 0.09> translate -0.08 * z } sphere { 0, 1 scale <0.21, 0.21, 0.09> translate 0.08 * z } }
    sphere { 0, 1 scale <0.09, 0.09, 0.10> }
    pigment { srgb 0.5 }
    finish { ambient 0 diffuse 0.3 reflection 0.6 metallic }
  }
}
#declare Axles = array[2] { -1.45, 1.42 };
difference {
  object { Body }
  #for (I, 0, 1)
    cylinder { <Axles[I], 0.36, -2>, <Axles[I], 0.36, -0.6>, 0.42 }
    cylinder { <Axles[I], 0.36, 2>, <Axles[I], 0.36, 0.6>, 0.42 }
  #end
  // The mouth.
  sphere { 0, 1 scale <0.5, 0.075, 0.26> translate <-2.5, 0.40, 0> pigment { srgb 0.02 } finish { diffuse 0.3 } }
  pigment { srgb <0.02, 0.10, 0.26> }
  finish { ambient 0.02 diffuse 0.5 reflection { 0.4, 0.9 } specular 0.3 roughness 0.003 }
}

// The cockpit, of the same kind of surface: a drop of glass.
#macro Ring(X, Wide, Bottom, Top)
  row {
    #for (I, 0, 7 + Degree)
      #local A = radians(45 * I - 90);
      <X, (Bottom + Top) / 2 + (Top - Bottom) / 2 * sin(A), Wide * cos(A)>
    #end
  }
#end
nurbs {
  degree Degree
  u_knots { #for (I, 0, 8 + 2 * Degree) I, #end }
  Ring(-0.80, 0, 0.80, 0.80) Ring(-0.80, 0.25, 0.55, 0.95) Ring(-0.35, 0.50, 0.45, 1.24) Ring(0.25, 0.52, 0.45, 1.36)
  Ring(0.95, 0.38, 0.50, 1.32) Ring(1.80, 0.16, 0.60, 1.14) Ring(2.35, 0, 0.90, 0.90)
  pigment { srgb <0.02, 0.03, 0.04> }
  finish { ambient 0 diffuse 0.2 reflection { 0.3, 0.9 } specular 0.4 roughness 0.002 }
}
#for (I, 0, 1)
  object { Wheel translate <Axles[I], 0.36, -0.74> }
  object { Wheel translate <Axles[I], 0.36, 0.74> }
#end

plane {
  y, 0
  pigment { srgb <0.16, 0.17, 0.19> }
  finish { ambient 0.05 diffuse 0.6 reflection { 0.05, 0.4 } }
}
