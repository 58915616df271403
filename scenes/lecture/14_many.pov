// Why acceleration: 1,000 balls on a picture of 1,000 by 1,000 pixels are a thousand million tests for the primary rays alone.
//
// Change `Side` to have more: 30 are 27,000 balls. `--accelerator list` tests all of them for every ray.
//
//     strahl compare scenes/lecture/14_many.pov --declare Side=20 --size 64x36 --sampling center --with list --with bvh
//
// shows the difference for 8,000 balls on a small picture: tests per ray, and seconds.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
#ifndef (Side) #declare Side = 10; #end
camera { location <-1.1, 1.5, -2.2> right x * image_width / image_height angle 56 look_at <0.05, 0, 0> }
light_source { <-5, 8, -6>, rgb 1 }
background { srgb <0.94, 0.95, 0.97> }

#for (I, 0, Side - 1)
  #for (J, 0, Side - 1)
    #for (K, 0, Side - 1)
      sphere {
        (<I, J, K> + 0.5) / Side - 0.5, 0.42 / Side
        pigment { srgb <0.15 + 0.8 * I / Side, 0.2 + 0.6 * J / Side, 0.9 - 0.7 * K / Side> }
        finish { ambient 0.12 diffuse 0.75 phong 0.5 phong_size 40 reflection 0.1 }
      }
    #end
  #end
#end
