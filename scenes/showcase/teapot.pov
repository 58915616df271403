// The teapot that Martin Newell designed in Utah in 1975, of its 32 bicubic patches: its outline is smooth at any size, and rays pass through none of its
// seams. Its control points are published data.
//
//     strahl render scenes/showcase/teapot.pov +W1280 +H720 +A0.3
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 6 }

camera {
  location <3.6, 4.2, -9.6>
  right x * image_width / image_height
  angle 40
  look_at <0.15, 1.25, 0>
}

light_source {
  <-7, 11, -8>, rgb <1.05, 1.0, 0.92>
  area_light 2 * x, 2 * z, 5, 5 adaptive 1 circular orient
}
light_source { <9, 7, -4>, rgb <0.22, 0.27, 0.36> shadowless }

sky_sphere {
  pigment {
    gradient y
    color_map { [0.0 srgb <0.92, 0.90, 0.86>] [0.2 srgb <0.62, 0.72, 0.84>] [0.5 srgb <0.24, 0.36, 0.55>] [0.8 srgb <0.10, 0.17, 0.32>] }
  }
}

#declare Porcelain = texture {
  pigment { srgb <0.07, 0.24, 0.50> }
  finish { ambient 0.04 diffuse 0.75 specular 0.8 roughness 0.004 reflection { 0.05, 0.55 falloff 3 } }
}

#macro Patch(Points)
  bicubic_patch {
    type 1 u_steps 4 v_steps 4
    #local I = 0;
    #while (I < 16) Points[I] #local I = I + 1; #end
  }
#end

// A quarter of a round part, and its three copies. Each row is <radius, height, how far the inner control points reach out, in parts of the radius>.
#macro Round(A, B, C, D)
  #local Rows = array[4] { A, B, C, D }
  #local Turn = 0;
  #while (Turn < 4)
    // Quarter turns by exact numbers, so that common borders are the same curve.
    #local Cos = (mod(Turn, 2) = 0 ? 1 - Turn : 0);
    #local Sin = (mod(Turn, 2) = 1 ? 2 - Turn : 0);
    #local Points = array[16]
    #local J = 0;
    #while (J < 4)
      #local R = Rows[J].x;
      #local In = R * Rows[J].z;
      #local Row = array[4] { <R, 0>, <R, In>, <In, R>, <0, R> }
      #local I = 0;
      #while (I < 4)
        #local P = Row[I];
        #local Points[4 * J + I] = <P.u * Cos - P.v * Sin, Rows[J].y, P.u * Sin + P.v * Cos>;
        #local I = I + 1;
      #end
      #local J = J + 1;
    #end
    Patch(Points)
    #local Turn = Turn + 1;
  #end
#end

// A piece of a tube, and its mirror image. Each row is two points of the outline, and half the width.
#macro Tube(Outline, Width, First)
  #local Side = -1;
  #while (Side < 2)
    #local Points = array[16]
    #local J = 0;
    #while (J < 4)
      #local A = Outline[First + J][0];
      #local B = Outline[First + J][1];
      #local W = Width[First + J] * Side;
      #local Points[4 * J] = <A.u, A.v, 0>;
      #local Points[4 * J + 1] = <A.u, A.v, W>;
      #local Points[4 * J + 2] = <B.u, B.v, W>;
      #local Points[4 * J + 3] = <B.u, B.v, 0>;
      #local J = J + 1;
    #end
    Patch(Points)
    #local Side = Side + 2;
  #end
#end

#declare Handle = array[7][2] {
  { <-1.6, 2.025>, <-1.5, 2.25> },
  { <-2.3, 2.025>, <-2.5, 2.25> },
  { <-2.7, 2.025>, <-3, 2.25> },
  { <-2.7, 1.8>, <-3, 1.8> },
  { <-2.7, 1.575>, <-3, 1.35> },
  { <-2.5, 1.125>, <-2.65, 0.9375> },
  { <-2, 0.9>, <-1.9, 0.6> }
}
#declare HandleWidth = array[7] { 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3 }
#declare Spout = array[7][2] {
  { <1.7, 1.425>, <1.7, 0.6> },
  { <2.6, 1.425>, <3.1, 0.825> },
  { <2.3, 2.1>, <2.4, 2.025> },
  { <2.7, 2.4>, <3.3, 2.4> },
  { <2.8, 2.475>, <3.525, 2.49375> },
  { <2.9, 2.475>, <3.45, 2.5125> },
  { <2.8, 2.4>, <3.2, 2.4> }
}
#declare SpoutWidth = array[7] { 0.66, 0.66, 0.25, 0.25, 0.25, 0.15, 0.15 }

union {
  // Rim, body, bottom.
  Round(<1.4, 2.4, 0.56>, <1.3375, 2.53125, 0.56>, <1.4375, 2.53125, 0.56>, <1.5, 2.4, 0.56>)
  Round(<1.5, 2.4, 0.56>, <1.75, 1.875, 0.56>, <2, 1.35, 0.56>, <2, 0.9, 0.56>)
  Round(<2, 0.9, 0.56>, <2, 0.45, 0.56>, <1.5, 0.225, 0.56>, <1.5, 0.15, 0.56>)
  Round(<1.5, 0.15, 0.56>, <1.5, 0.075, 0.56>, <1.425, 0, 0.56>, <0, 0, 0>)
  // Knob and lid.
  Round(<0, 3.15, 0>, <0.8, 3.15, 0.5625>, <0, 2.85, 0>, <0.2, 2.7, 0.56>)
  Round(<0.2, 2.7, 0.56>, <0.4, 2.55, 0.56>, <1.3, 2.55, 0.56>, <1.3, 2.4, 0.56>)
  Tube(Handle, HandleWidth, 0)
  Tube(Handle, HandleWidth, 3)
  Tube(Spout, SpoutWidth, 0)
  Tube(Spout, SpoutWidth, 3)
  rotate -24 * y
  texture { Porcelain }
}

// A table of tiles that mirrors a little.
plane {
  y, 0
  texture {
    pigment { checker srgb <0.80, 0.72, 0.60>, srgb <0.52, 0.40, 0.30> scale 1.4 rotate 20 * y translate 0.3 * x }
    finish { ambient 0.05 diffuse 0.7 reflection { 0.04, 0.3 falloff 2 } }
  }
}
fog { distance 240 color srgb <0.92, 0.90, 0.86> }
