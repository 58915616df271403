// In the style of ASE's exports, written for strahl: macros with a missing comma between parameters, a camera of many words whose
// direction is long and whose right is negative, and an area light.
#version 3.6;
#include "colors.inc"
#include "finish.inc"

global_settings {assumed_gamma 2.2 max_trace_level 6}
background {color White}
camera {orthographic
  right -16.00*x up 12.00*y
  direction 50.00*z
  location <0,0,50.00> look_at <0,0,0>}


light_source {<  2.00,   3.00,  40.00> color Gray80
  area_light <0.95, 0, 0>, <0, 0.80, 0>, 5, 4
  adaptive 1}
// no fog
#declare simple = finish {phong 0.7}
#declare pale = finish {ambient 0.5 diffuse 0.85 roughness 0.001 specular 0.200 }
#declare intermediate = finish {ambient 0.3 diffuse 0.6 specular 0.1 roughness 0.04}
#declare vmd = finish {ambient 0.0 diffuse 0.65 phong 0.1 phong_size 40.0 specular 0.5 }
#declare jmol = finish {ambient 0.2 diffuse 0.6 specular 1 roughness 0.001 metallic}
#declare ase2 = finish {ambient 0.05 brilliance 3 diffuse 0.6 metallic specular 0.7 roughness 0.04 reflection 0.15}
#declare ase3 = finish {ambient 0.15 brilliance 2 diffuse 0.6 metallic specular 1.0 roughness 0.001 reflection 0.0}
#declare glass = finish {ambient 0.05 diffuse 0.3 specular 1.0 roughness 0.001}
#declare glass2 = finish {ambient 0.01 diffuse 0.3 specular 1.0 reflection 0.25 roughness 0.001}
#declare Rcell = 0.050;
#declare Rbond = 0.100;

#macro atom(LOC, R, COL, TRANS, FIN)
  sphere{LOC, R texture{pigment{color COL transmit TRANS} finish{FIN}}}
#end
#macro constrain(LOC, R, COL, TRANS FIN)
union{torus{R, Rcell rotate 45*z texture{pigment{color COL transmit TRANS} finish{FIN}}}
     torus{R, Rcell rotate -45*z texture{pigment{color COL transmit TRANS} finish{FIN}}}
     translate LOC}
#end

cylinder {<-5.2000,-3.6000,-7.0000>, <-5.2000,-3.6000,-1.0000>, Rcell pigment {Black}}
cylinder {<-5.2000,-3.6000,-7.0000>, <-5.2000,3.6000,-7.0000>, Rcell pigment {Black}}
cylinder {<-5.2000,-3.6000,-7.0000>, <5.2000,-3.6000,-7.0000>, Rcell pigment {Black}}
cylinder {<-5.2000,-3.6000,-1.0000>, <-5.2000,3.6000,-1.0000>, Rcell pigment {Black}}
cylinder {<-5.2000,-3.6000,-1.0000>, <5.2000,-3.6000,-1.0000>, Rcell pigment {Black}}
cylinder {<-5.2000,3.6000,-7.0000>, <-5.2000,3.6000,-1.0000>, Rcell pigment {Black}}
cylinder {<-5.2000,3.6000,-7.0000>, <5.2000,3.6000,-7.0000>, Rcell pigment {Black}}
cylinder {<-5.2000,3.6000,-1.0000>, <5.2000,3.6000,-1.0000>, Rcell pigment {Black}}
cylinder {<5.2000,-3.6000,-7.0000>, <5.2000,-3.6000,-1.0000>, Rcell pigment {Black}}
cylinder {<5.2000,-3.6000,-7.0000>, <5.2000,3.6000,-7.0000>, Rcell pigment {Black}}
cylinder {<5.2000,-3.6000,-1.0000>, <5.2000,3.6000,-1.0000>, Rcell pigment {Black}}
cylinder {<5.2000,3.6000,-7.0000>, <5.2000,3.6000,-1.0000>, Rcell pigment {Black}}
atom(<-4.5500,-2.7000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #0 
atom(<-4.5500,-0.3000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #1 
atom(<-4.5500,2.1000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #2 
atom(<-1.9500,-2.7000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #3 
atom(<-1.9500,-0.3000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #4 
atom(<-1.9500,2.1000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #5 
atom(<0.6500,-2.7000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #6 
atom(<0.6500,-0.3000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #7 
atom(<0.6500,2.1000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #8 
atom(<3.2500,-2.7000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #9 
atom(<3.2500,-0.3000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #10 
atom(<3.2500,2.1000,-6.5000>, 1.16, rgb <0.80, 0.82, 0.85>, 0.0, jmol) // #11 
atom(<-3.2500,-1.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #12 
atom(<-3.2500,0.5000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #13 
atom(<-3.2500,2.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #14 
atom(<-0.6500,-1.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #15 
atom(<-0.6500,0.5000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #16 
atom(<-0.6500,2.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #17 
atom(<1.9500,-1.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #18 
atom(<1.9500,0.5000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #19 
atom(<1.9500,2.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #20 
atom(<4.5500,-1.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #21 
atom(<4.5500,0.5000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #22 
atom(<4.5500,2.9000,-4.5000>, 1.16, rgb <1.00, 0.82, 0.14>, 0.0, ase3) // #23 
atom(<-4.5500,-2.7000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #24 
atom(<-4.5500,-0.3000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #25 
atom(<-4.5500,2.1000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #26 
atom(<-1.9500,-2.7000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #27 
atom(<-1.9500,-0.3000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #28 
atom(<-1.9500,2.1000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #29 
atom(<0.6500,-2.7000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #30 
atom(<0.6500,-0.3000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #31 
atom(<0.6500,2.1000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #32 
atom(<3.2500,-2.7000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #33 
atom(<3.2500,-0.3000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #34 
atom(<3.2500,2.1000,-2.5000>, 1.16, rgb <0.78, 0.50, 0.20>, 0.0, intermediate) // #35 
atom(<  1.00,   0.60,   0.20>, 0.70, rgb <1.00, 0.05, 0.05>, 0.0, simple) // #36 
atom(<  2.10,   1.00,   0.60>, 0.50, rgb <0.95, 0.95, 0.95>, 0.3, glass) // #37 
cylinder {<  1.00,   0.60,   0.20>, <  1.55,   0.80,   0.40>, Rbond texture{pigment {color rgb <1.00, 0.05, 0.05> transmit 0.0} finish{ase2}}}
constrain(<  1.00,   0.60,   0.20>, 0.84, Black, 0.0 simple) // #36 
constrain(< -3.25,  -1.90,  -2.50>, 1.30, rgb <0.1, 0.3, 0.8>, 0.2 glass) // #1 
