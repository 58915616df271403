// Primary rays from one point: perspective projection.
//
// The ray of a pixel runs from the eye through the pixel, d = (p0 - e) / |p0 - e|. Columns of one height become shorter with the
// distance, and parallel lines meet.
//
//     strahl explain scenes/lecture/02_perspective.pov --size 320x180 --sampling center --pixel 40,120
//     strahl explain scenes/lecture/02_perspective.pov --size 320x180 --sampling center --pixel 280,120
//     strahl render scenes/lecture/02_perspective.pov --size 320x180 --shading depth -o depth.png
//
// show two primary rays, from the same eye in different directions, and how far each primary ray goes: what is brighter is farther away (the sky keeps its own colour).
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { perspective location <0, 2.2, -5.5> right x * image_width / image_height angle 52 look_at <0, 0.6, 2> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.72, 0.82, 0.93> }
// The floor: fields that fade into their mean colour far away, where they are smaller than pixels.
plane {
  y, 0
  pigment {
    cylindrical
    pigment_map { [0 rgb <0.555, 0.563, 0.552>] [0.6 checker srgb <0.55, 0.60, 0.66>, srgb <0.93, 0.91, 0.86> scale 1 / 20] }
    scale 20
  }
  finish { ambient 0.1 diffuse 0.75 }
}

#for (I, 0, 5)
  cylinder { <-1.6, 0, 0>, <-1.6, 1.5, 0>, 0.28 translate 1.8 * I * z pigment { srgb <0.80, 0.42, 0.25> } finish { ambient 0.1 diffuse 0.75 } }
  cylinder { <1.6, 0, 0>, <1.6, 1.5, 0>, 0.28 translate 1.8 * I * z pigment { srgb <0.25, 0.48, 0.62> } finish { ambient 0.1 diffuse 0.75 } }
#end
