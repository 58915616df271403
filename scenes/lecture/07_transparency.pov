// Transparency rays by Snell's law: sin a1 : sin a2 = eta2 : eta1.
//
// From the left a ball of index 1, which bends nothing, one of water, 1.33, one of glass, 1.5, and a bubble of air in a block of glass,
// where the roles of the two sides are exchanged.
//
//     strahl explain scenes/lecture/07_transparency.pov --size 320x180 --sampling center --pixel 182,95
//
// names the indices of both sides, the angles and Fresnel's F at every surface of the ball of glass.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { location <0, 1.8, -7.4> right x * image_width / image_height angle 58 look_at <0.1, 0.75, 0> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.72, 0.82, 0.93> }
// The floor: fields that fade into their mean colour far away, where they are smaller than pixels.
plane {
  y, 0
  pigment {
    cylindrical
    pigment_map { [0 rgb <0.555, 0.563, 0.552>] [0.5 checker srgb <0.55, 0.60, 0.66>, srgb <0.93, 0.91, 0.86> scale 0.5 / 10] }
    scale 10
  }
  finish { ambient 0.1 diffuse 0.75 }
}

#declare Clear = finish { ambient 0 diffuse 0.03 phong 0.8 phong_size 200 reflection { 0, 1 fresnel on } conserve_energy }
#macro Ball(X, Index)
  sphere { <X, 0.72, 0>, 0.72 pigment { rgbf <0.97, 0.98, 1, 0.97> } finish { Clear } interior { ior Index } }
#end
Ball(-2.5, 1)
Ball(-0.9, 1.33)
Ball(0.7, 1.5)
difference {
  box { <-0.75, 0, -0.75>, <0.75, 1.5, 0.75> }
  sphere { <0, 0.75, 0>, 0.5 }
  rotate 20 * y
  translate <2.5, 0, 0.2>
  pigment { rgbf <0.97, 1, 0.98, 0.97> }
  finish { Clear }
  interior { ior 1.5 }
}
