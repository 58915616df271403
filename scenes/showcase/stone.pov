// A page of text in stone. Each letter is cut by a conical chisel that is led along its strokes: the groove of a straight stroke is
// two cones and the wedge between them. The letters are strokes on a grid of our own, so no font is needed.
//
//     strahl render scenes/showcase/stone.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 5 }

// Half the width of a groove, and its depth: half the width makes walls of 45 degrees, as in old inscriptions.
#declare Broad = 0.066;
#declare Deep = 0.075;
// How far the chisel starts above the stone, so that the groove is open.
#declare Above = 0.05;

// A stroke from A to B, in the plane of the page (x, y); the page's surface is z = 0, the stone is behind it.
#macro Stroke(A, B)
  #local Reach = Broad * (Deep + Above) / Deep;
  #local From = <A.x, A.y, 0>;
  #local To = <B.x, B.y, 0>;
  cone { From + Deep * z, 0, From - Above * z, Reach }
  cone { To + Deep * z, 0, To - Above * z, Reach }
  #local Along = To - From;
  #if (vlength(Along) > 0.001)
    #local U = vnormalize(Along);
    #local V = vcross(z, U);
    // A wedge: all between two slanted planes, the surface and the two ends.
    intersection {
      plane { vnormalize(V * Deep + z * Broad), 0 translate Deep * z + From }
      plane { vnormalize(-V * Deep + z * Broad), 0 translate Deep * z + From }
      box { <0, -1, -Above>, <vlength(Along), 1, Deep> matrix <U.x, U.y, 0, V.x, V.y, 0, 0, 0, 1, From.x, From.y, 0> }
      bounded_by { box { <-Reach, -Reach, -Above>, <vlength(Along) + Reach, Reach, Deep> matrix <U.x, U.y, 0, V.x, V.y, 0, 0, 0, 1, From.x, From.y, 0> } }
    }
  #end
#end

// An arc of an ellipse around C with half axes R, from angle T0 to T1 in degrees, in Steps strokes.
#macro Arc(C, R, T0, T1, Steps)
  #for (I, 0, Steps - 1)
    #local P = radians(T0 + (T1 - T0) * I / Steps);
    #local Q = radians(T0 + (T1 - T0) * (I + 1) / Steps);
    Stroke(C + <R.x * cos(P), R.y * sin(P)>, C + <R.x * cos(Q), R.y * sin(Q)>)
  #end
#end

// Widths of the letters, of a height of 1: Roman capitals are circles, squares and half squares.
#macro Width(Letter)
  #local Wide = 0.6;
  #switch (asc(Letter))
    #case (asc("I")) #local Wide = 0.0; #break
    #case (asc(".")) #local Wide = 0.0; #break
    #case (asc(",")) #local Wide = 0.06; #break
    #case (asc(" ")) #local Wide = 0.26; #break
    #case (asc("E")) #case (asc("F")) #case (asc("L")) #case (asc("S")) #local Wide = 0.42; #break
    #case (asc("B")) #case (asc("P")) #case (asc("R")) #local Wide = 0.46; #break
    #case (asc("K")) #case (asc("T")) #case (asc("Y")) #local Wide = 0.56; #break
    #case (asc("A")) #case (asc("H")) #case (asc("N")) #case (asc("U")) #case (asc("V")) #local Wide = 0.66; #break
    #case (asc("C")) #case (asc("D")) #case (asc("G")) #local Wide = 0.68; #break
    #case (asc("M")) #local Wide = 0.82; #break
    #case (asc("O")) #case (asc("Q")) #local Wide = 0.9; #break
    #case (asc("W")) #local Wide = 1.0; #break
  #end
  Wide
#end

#macro Strokes(Letter)
  #local W = Width(Letter);
  #switch (asc(Letter))
    #case (asc("A")) Stroke(<0, 0>, <W / 2, 1>) Stroke(<W / 2, 1>, <W, 0>) Stroke(<0.19 * W, 0.36>, <0.81 * W, 0.36>) #break
    #case (asc("B")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 1>, <0.2, 1>) Arc(<0.2, 0.77>, <0.2, 0.23>, 90, -90, 8)
      Stroke(<0, 0.54>, <0.22, 0.54>) Arc(<0.22, 0.27>, <0.24, 0.27>, 90, -90, 8) Stroke(<0, 0>, <0.22, 0>) #break
    #case (asc("C")) Arc(<0.5, 0.5>, <0.5, 0.5>, 52, 308, 18) #break
    #case (asc("D")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 1>, <0.2, 1>) Arc(<0.2, 0.5>, <0.48, 0.5>, 90, -90, 14) Stroke(<0, 0>, <0.2, 0>) #break
    #case (asc("E")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 1>, <W, 1>) Stroke(<0, 0.53>, <0.85 * W, 0.53>) Stroke(<0, 0>, <W, 0>) #break
    #case (asc("F")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 1>, <W, 1>) Stroke(<0, 0.53>, <0.85 * W, 0.53>) #break
    #case (asc("G")) Arc(<0.5, 0.5>, <0.5, 0.5>, 52, 314, 18) Stroke(<0.5 + 0.5 * cos(radians(314)), 0.5 + 0.5 * sin(radians(314))>, <0.847, 0.42>) Stroke(<0.6, 0.42>, <0.847, 0.42>) #break
    #case (asc("H")) Stroke(<0, 0>, <0, 1>) Stroke(<W, 0>, <W, 1>) Stroke(<0, 0.53>, <W, 0.53>) #break
    #case (asc("I")) Stroke(<0, 0>, <0, 1>) #break
    #case (asc("K")) Stroke(<0, 0>, <0, 1>) Stroke(<0.05, 0.47>, <W, 1>) Stroke(<0.16, 0.58>, <W, 0>) #break
    #case (asc("L")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 0>, <W, 0>) #break
    #case (asc("M")) Stroke(<0, 0>, <0.1, 1>) Stroke(<0.1, 1>, <W / 2, 0.1>) Stroke(<W / 2, 0.1>, <W - 0.1, 1>) Stroke(<W - 0.1, 1>, <W, 0>) #break
    #case (asc("N")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 1>, <W, 0>) Stroke(<W, 0>, <W, 1>) #break
    #case (asc("O")) Arc(<0.45, 0.5>, <0.47, 0.5>, 0, 360, 24) #break
    #case (asc("P")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 1>, <0.22, 1>) Arc(<0.22, 0.74>, <0.24, 0.26>, 90, -90, 8) Stroke(<0, 0.48>, <0.22, 0.48>) #break
    #case (asc("R")) Stroke(<0, 0>, <0, 1>) Stroke(<0, 1>, <0.2, 1>) Arc(<0.2, 0.75>, <0.23, 0.25>, 90, -90, 8) Stroke(<0, 0.5>, <0.2, 0.5>) Stroke(<0.2, 0.5>, <0.52, 0>) #break
    #case (asc("S")) Arc(<0.21, 0.765>, <0.21, 0.235>, 35, 270, 10) Arc(<0.21, 0.265>, <0.22, 0.265>, 90, -145, 10) #break
    #case (asc("T")) Stroke(<0, 1>, <W, 1>) Stroke(<W / 2, 0>, <W / 2, 1>) #break
    #case (asc("U")) Stroke(<0, 1>, <0, 0.33>) Arc(<W / 2, 0.33>, <W / 2, 0.33>, 180, 360, 12) Stroke(<W, 0.33>, <W, 1>) #break
    #case (asc("V")) Stroke(<0, 1>, <W / 2, 0>) Stroke(<W / 2, 0>, <W, 1>) #break
    #case (asc("W")) Stroke(<0, 1>, <W / 4, 0>) Stroke(<W / 4, 0>, <W / 2, 1>) Stroke(<W / 2, 1>, <3 * W / 4, 0>) Stroke(<3 * W / 4, 0>, <W, 1>) #break
    #case (asc("Y")) Stroke(<0, 1>, <W / 2, 0.5>) Stroke(<W, 1>, <W / 2, 0.5>) Stroke(<W / 2, 0.5>, <W / 2, 0>) #break
    #case (asc(".")) Stroke(<0, 0.03>, <0, 0.031>) #break
    #case (asc(",")) Stroke(<0.06, 0.04>, <0, -0.14>) #break
  #end
#end

#declare Gap = 0.27;
#macro LineWidth(Text)
  #local Sum = 0;
  #for (I, 1, strlen(Text))
    #local Sum = Sum + Width(substr(Text, I, 1)) + Gap;
  #end
  (Sum - Gap)
#end

#declare Half = 16;     // half the width of the slab
#declare Pitch = 1.6;   // from line to line
#declare Thick = 0.6;

// One line of the page. The stone is cut into a tile for each letter: the tiles meet exactly, and no ray has to try the strokes of
// letters it is far from.
#macro Line(Text, Row)
  #local Low = -Row * Pitch - 0.3;
  #local High = Low + Pitch;
  #local Pen = -LineWidth(Text) / 2;
  #local Left = -Half;
  #for (I, 1, strlen(Text))
    #local Letter = substr(Text, I, 1);
    #local Right = Pen + Width(Letter) + Gap / 2;
    #if (I = strlen(Text))
      #local Right = Half;
    #end
    #if (asc(Letter) = asc(" "))
      box { <Left, Low, 0>, <Right, High, Thick> }
    #else
      difference {
        box { <Left, Low, 0>, <Right, High, Thick> }
        union { Strokes(Letter) translate <Pen, -Row * Pitch, 0> }
      }
    #end
    #local Pen = Pen + Width(Letter) + Gap;
    #local Left = Right;
  #end
#end

// What the words say, drawn: an eye, its ray, the ball it meets, and the sun.
#macro Drawing()
  Arc(<-5.1, -0.55>, <1, 0.98>, 34, 146, 12)
  Arc(<-5.1, 0.55>, <1, 0.98>, 214, 326, 12)
  Arc(<-5.1, 0>, <0.27, 0.27>, 0, 360, 12)
  Stroke(<-4.0, -0.05>, <-0.86, -0.36>)
  Arc(<0, -0.3>, <0.62, 0.62>, 0, 360, 20)
  Stroke(<0.68, 0.02>, <3.7, 0.12>)
  Arc(<4.95, 0.16>, <0.42, 0.42>, 0, 360, 16)
  #for (I, 0, 11)
    #local T = radians(30 * I + 3);
    Stroke(<4.95 + 0.66 * cos(T), 0.16 + 0.66 * sin(T)>, <4.95 + 0.98 * cos(T), 0.16 + 0.98 * sin(T)>)
  #end
#end

#declare Page = union {
  Line("ONE RAY GOES OUT", 0)
  Line("AND ASKS OF ALL", 1)
  Line("THINGS THAT IT MEETS", 2)
  Line("WHO GAVE YOU LIGHT", 3)
  difference {
    box { <-Half, -3 * Pitch - 2.6, 0>, <Half, -3 * Pitch - 0.3, Thick> }
    union { Drawing() translate (-3 * Pitch - 1.42) * y }
  }
  box { <-Half, Pitch - 0.3, 0>, <Half, Pitch + 5, Thick> }
  box { <-Half, -3 * Pitch - 5, 0>, <Half, -3 * Pitch - 2.6, Thick> }
}

#declare Limestone = texture {
  pigment {
    granite
    turbulence 0.4
    color_map {
      [0.0 srgb <0.80, 0.72, 0.58>]
      [0.4 srgb <0.86, 0.79, 0.66>]
      [0.7 srgb <0.78, 0.69, 0.54>]
      [1.0 srgb <0.66, 0.56, 0.42>]
    }
    scale 3
  }
  normal { granite 0.12 scale 0.7 }
  finish { ambient 0.03 diffuse 0.85 }
}
// Stains that rain has left, thin over the stone.
texture {
  pigment {
    bozo
    turbulence 0.7
    octaves 5
    color_map {
      [0.00 srgbt <0.25, 0.22, 0.16, 0.55>]
      [0.35 srgbt <0.35, 0.30, 0.22, 0.9>]
      [0.55 srgbt <1, 1, 1, 1>]
    }
    scale <1.6, 3.5, 1.6>
  }
  finish { ambient 0.03 diffuse 0.85 }
}

object { Page texture { Limestone } }

camera {
  location <-2.8, -5.4, -13.9>
  right x * image_width / image_height
  angle 62
  look_at <-0.35, -2.95, 0>
}
background { srgb <0.05, 0.04, 0.035> }
// Evening sun that grazes the stone from the upper left: grooves live by their shadows.
light_source {
  <-16, 8, -5.5>, rgb <2.3, 1.9, 1.38>
  area_light 1.2 * x, 1.2 * y, 5, 5 adaptive 1 circular orient
}
light_source { <9, 3, -12>, rgb <0.11, 0.14, 0.2> }
