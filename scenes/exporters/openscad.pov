// In the style of OpenSCAD's exports, written for strahl: nothing but polygons, z upwards, and global settings twice.
#version 3.7;
global_settings { assumed_gamma 1 }
global_settings { max_trace_level 5 }
#declare MATERIAL = finish { diffuse 0.7 ambient 0.15 specular 0.2 roughness 0.05 };
polygon { 5, 
<20, 0, 8>,
<16.1803, 11.7557, 8>,
<8.8992, 6.4656, 8>,
<11, 0, 8>,
<20, 0, 8>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<20, 0, 0>,
<16.1803, 11.7557, 0>,
<16.1803, 11.7557, 8>,
<20, 0, 8>,
<20, 0, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<8.8992, 6.4656, 0>,
<11, 0, 0>,
<11, 0, 8>,
<8.8992, 6.4656, 8>,
<8.8992, 6.4656, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<16.1803, 11.7557, 0>,
<8.8992, 6.4656, 0>,
<8.8992, 6.4656, 12>,
<16.1803, 11.7557, 12>,
<16.1803, 11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<16.1803, 11.7557, 12>,
<6.1803, 19.0211, 12>,
<3.3992, 10.4616, 12>,
<8.8992, 6.4656, 12>,
<16.1803, 11.7557, 12>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<16.1803, 11.7557, 0>,
<6.1803, 19.0211, 0>,
<6.1803, 19.0211, 12>,
<16.1803, 11.7557, 12>,
<16.1803, 11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<3.3992, 10.4616, 0>,
<8.8992, 6.4656, 0>,
<8.8992, 6.4656, 12>,
<3.3992, 10.4616, 12>,
<3.3992, 10.4616, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<6.1803, 19.0211, 0>,
<3.3992, 10.4616, 0>,
<3.3992, 10.4616, 12>,
<6.1803, 19.0211, 12>,
<6.1803, 19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<6.1803, 19.0211, 8>,
<-6.1803, 19.0211, 8>,
<-3.3992, 10.4616, 8>,
<3.3992, 10.4616, 8>,
<6.1803, 19.0211, 8>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<6.1803, 19.0211, 0>,
<-6.1803, 19.0211, 0>,
<-6.1803, 19.0211, 8>,
<6.1803, 19.0211, 8>,
<6.1803, 19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-3.3992, 10.4616, 0>,
<3.3992, 10.4616, 0>,
<3.3992, 10.4616, 8>,
<-3.3992, 10.4616, 8>,
<-3.3992, 10.4616, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-6.1803, 19.0211, 0>,
<-3.3992, 10.4616, 0>,
<-3.3992, 10.4616, 12>,
<-6.1803, 19.0211, 12>,
<-6.1803, 19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-6.1803, 19.0211, 12>,
<-16.1803, 11.7557, 12>,
<-8.8992, 6.4656, 12>,
<-3.3992, 10.4616, 12>,
<-6.1803, 19.0211, 12>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-6.1803, 19.0211, 0>,
<-16.1803, 11.7557, 0>,
<-16.1803, 11.7557, 12>,
<-6.1803, 19.0211, 12>,
<-6.1803, 19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-8.8992, 6.4656, 0>,
<-3.3992, 10.4616, 0>,
<-3.3992, 10.4616, 12>,
<-8.8992, 6.4656, 12>,
<-8.8992, 6.4656, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-16.1803, 11.7557, 0>,
<-8.8992, 6.4656, 0>,
<-8.8992, 6.4656, 12>,
<-16.1803, 11.7557, 12>,
<-16.1803, 11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-16.1803, 11.7557, 8>,
<-20, 0, 8>,
<-11, 0, 8>,
<-8.8992, 6.4656, 8>,
<-16.1803, 11.7557, 8>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-16.1803, 11.7557, 0>,
<-20, 0, 0>,
<-20, 0, 8>,
<-16.1803, 11.7557, 8>,
<-16.1803, 11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-11, 0, 0>,
<-8.8992, 6.4656, 0>,
<-8.8992, 6.4656, 8>,
<-11, 0, 8>,
<-11, 0, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-20, 0, 0>,
<-11, 0, 0>,
<-11, 0, 12>,
<-20, 0, 12>,
<-20, 0, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-20, 0, 12>,
<-16.1803, -11.7557, 12>,
<-8.8992, -6.4656, 12>,
<-11, 0, 12>,
<-20, 0, 12>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-20, 0, 0>,
<-16.1803, -11.7557, 0>,
<-16.1803, -11.7557, 12>,
<-20, 0, 12>,
<-20, 0, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-8.8992, -6.4656, 0>,
<-11, 0, 0>,
<-11, 0, 12>,
<-8.8992, -6.4656, 12>,
<-8.8992, -6.4656, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-16.1803, -11.7557, 0>,
<-8.8992, -6.4656, 0>,
<-8.8992, -6.4656, 12>,
<-16.1803, -11.7557, 12>,
<-16.1803, -11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-16.1803, -11.7557, 8>,
<-6.1803, -19.0211, 8>,
<-3.3992, -10.4616, 8>,
<-8.8992, -6.4656, 8>,
<-16.1803, -11.7557, 8>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-16.1803, -11.7557, 0>,
<-6.1803, -19.0211, 0>,
<-6.1803, -19.0211, 8>,
<-16.1803, -11.7557, 8>,
<-16.1803, -11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-3.3992, -10.4616, 0>,
<-8.8992, -6.4656, 0>,
<-8.8992, -6.4656, 8>,
<-3.3992, -10.4616, 8>,
<-3.3992, -10.4616, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-6.1803, -19.0211, 0>,
<-3.3992, -10.4616, 0>,
<-3.3992, -10.4616, 12>,
<-6.1803, -19.0211, 12>,
<-6.1803, -19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-6.1803, -19.0211, 12>,
<6.1803, -19.0211, 12>,
<3.3992, -10.4616, 12>,
<-3.3992, -10.4616, 12>,
<-6.1803, -19.0211, 12>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-6.1803, -19.0211, 0>,
<6.1803, -19.0211, 0>,
<6.1803, -19.0211, 12>,
<-6.1803, -19.0211, 12>,
<-6.1803, -19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<3.3992, -10.4616, 0>,
<-3.3992, -10.4616, 0>,
<-3.3992, -10.4616, 12>,
<3.3992, -10.4616, 12>,
<3.3992, -10.4616, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<6.1803, -19.0211, 0>,
<3.3992, -10.4616, 0>,
<3.3992, -10.4616, 12>,
<6.1803, -19.0211, 12>,
<6.1803, -19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<6.1803, -19.0211, 8>,
<16.1803, -11.7557, 8>,
<8.8992, -6.4656, 8>,
<3.3992, -10.4616, 8>,
<6.1803, -19.0211, 8>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<6.1803, -19.0211, 0>,
<16.1803, -11.7557, 0>,
<16.1803, -11.7557, 8>,
<6.1803, -19.0211, 8>,
<6.1803, -19.0211, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<8.8992, -6.4656, 0>,
<3.3992, -10.4616, 0>,
<3.3992, -10.4616, 8>,
<8.8992, -6.4656, 8>,
<8.8992, -6.4656, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<16.1803, -11.7557, 0>,
<8.8992, -6.4656, 0>,
<8.8992, -6.4656, 12>,
<16.1803, -11.7557, 12>,
<16.1803, -11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<16.1803, -11.7557, 12>,
<20, 0, 12>,
<11, 0, 12>,
<8.8992, -6.4656, 12>,
<16.1803, -11.7557, 12>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<16.1803, -11.7557, 0>,
<20, 0, 0>,
<20, 0, 12>,
<16.1803, -11.7557, 12>,
<16.1803, -11.7557, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<11, 0, 0>,
<8.8992, -6.4656, 0>,
<8.8992, -6.4656, 12>,
<11, 0, 12>,
<11, 0, 0>
texture { pigment { color rgbf <0.6, 0.75, 0.2, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<20, 0, 0>,
<11, 0, 0>,
<11, 0, 12>,
<20, 0, 12>,
<20, 0, 0>
texture { pigment { color rgbf <0.97, 0.84, 0.17, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-5, -5, 0>,
<5, -5, 0>,
<5, -5, 16>,
<-5, -5, 16>,
<-5, -5, 0>
texture { pigment { color rgbf <0.3, 0.55, 0.85, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<5, -5, 0>,
<5, 5, 0>,
<5, 5, 16>,
<5, -5, 16>,
<5, -5, 0>
texture { pigment { color rgbf <0.3, 0.55, 0.85, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<-5, 5, 0>,
<-5, -5, 0>,
<-5, -5, 16>,
<-5, 5, 16>,
<-5, 5, 0>
texture { pigment { color rgbf <0.3, 0.55, 0.85, 0> } }
finish { MATERIAL }
}
polygon { 5, 
<5, 5, 0>,
<-5, 5, 0>,
<-5, 5, 16>,
<5, 5, 16>,
<5, 5, 0>
texture { pigment { color rgbf <0.3, 0.55, 0.85, 0> } }
finish { MATERIAL }
}
polygon { 4, 
<-5, -5, 16>,
<5, -5, 16>,
<0, 0, 24>,
<-5, -5, 16>
texture { pigment { color rgbf <0.9, 0.35, 0.25, 0> } }
finish { MATERIAL }
}
polygon { 4, 
<5, -5, 16>,
<5, 5, 16>,
<0, 0, 24>,
<5, -5, 16>
texture { pigment { color rgbf <0.9, 0.35, 0.25, 0> } }
finish { MATERIAL }
}
polygon { 4, 
<5, 5, 16>,
<-5, 5, 16>,
<0, 0, 24>,
<5, 5, 16>
texture { pigment { color rgbf <0.9, 0.35, 0.25, 0> } }
finish { MATERIAL }
}
polygon { 4, 
<-5, 5, 16>,
<-5, -5, 16>,
<0, 0, 24>,
<-5, 5, 16>
texture { pigment { color rgbf <0.9, 0.35, 0.25, 0> } }
finish { MATERIAL }
}
light_source { <-70, -60, 110> color rgb <1, 1, 1> }
light_source { <90, -40, 60> color rgb <0.3, 0.3, 0.35> }
camera {
  location <-42, -62, 56>
  up <0, 0, 1>
  right <1.3333, 0, 0>
  sky <0, 0, 1>
  angle 40
  look_at <0, 0, 7>
}
background { color rgb <1, 1, 0.9> }
