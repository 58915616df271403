// The picture that `strahl render` makes when it is given no scene.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 8 }

camera {
  location <0, 3.4, -10>
  right x * 4 / 3
  angle 42
  look_at <0, 0.75, 0>
}

background { rgb <0.35, 0.55, 0.85> }
light_source { <-6, 9, -8>, rgb 0.9 }
light_source { <8, 5, -6>, rgb 0.25 }

// The floor shows a little of what stands on it.
plane {
  y, 0
  pigment { rgb <0.62, 0.58, 0.52> }
  finish { diffuse 0.8 ambient 0.08 reflection 0.15 }
}

// A die: a cube without its corners, with a hole through every face.
difference {
  intersection {
    box { -1, 1 }
    sphere { 0, 1.4 }
  }
  cylinder { -2 * x, 2 * x, 0.55 }
  cylinder { -2 * y, 2 * y, 0.55 }
  cylinder { -2 * z, 2 * z, 0.55 }
  pigment { rgb <0.85, 0.2, 0.12> }
  finish { ambient 0.1 diffuse 0.7 phong 0.8 phong_size 60 }
  rotate 35 * y
  translate <0, 1, 0>
}

// A ball of gold in it; a mirror and blue enamel beside it.
sphere {
  <0, 1, 0>, 0.45
  pigment { rgb <0.95, 0.7, 0.25> }
  finish { ambient 0.1 diffuse 0.4 phong 1 phong_size 90 reflection 0.35 }
}
sphere {
  <-2.4, 1, 0.8>, 1
  pigment { rgb 0.15 }
  finish { ambient 0 diffuse 0.3 phong 1 phong_size 200 reflection 0.8 }
}

// A ring of small balls, all colours of the rainbow.
#declare Balls = 14;
#for (I, 0, Balls - 1)
  #local Turn = 2 * pi * I / Balls;
  sphere {
    <3 * cos(Turn), 0.25, 3 * sin(Turn) - 0.4>, 0.25
    pigment { rgb <0.5 + 0.5 * cos(Turn), 0.5 + 0.5 * cos(Turn - 2.1), 0.5 + 0.5 * cos(Turn + 2.1)> }
    finish { ambient 0.1 diffuse 0.8 phong 0.6 phong_size 40 }
  }
#end

sphere {
  <2.2, 0.9, -0.6>, 0.9
  pigment { rgb <0.1, 0.25, 0.5> }
  finish { ambient 0.05 diffuse 0.6 phong 1 phong_size 120 reflection 0.25 }
}
