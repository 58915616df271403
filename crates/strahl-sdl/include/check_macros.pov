// Calls every macro of the include library once with plain arguments; a part of check.sh.
#version 3.7;
global_settings { assumed_gamma 1 radiosity { } }
#include "stdinc.inc"
#include "arrays.inc"
#include "debug.inc"
#include "glass.inc"
#include "rad_def.inc"
#include "screen.inc"
#include "sunpos.inc"
#include "textures.inc"
box { -1, 1 pigment { rgb 1 } }

#macro Close(Name, A, B)
   #if (vlength((A) - (B)) > 1e-4) #error concat("check_macros: ", Name, " is wrong") #end
#end
#macro Same(Name, A, B)
   #if (abs((A) - (B)) > 1e-4) #error concat("check_macros: ", Name, " is wrong") #end
#end

// colors
Close("CH2RGB", CH2RGB(30), <1, 0.5, 0>)
#declare C = CHSL2RGB(<200, 0.5, 0.3>);
Close("CHSL2RGB", <C.red, C.green, C.blue>, <0.15, 0.35, 0.45>)
#declare C = CHSV2RGB(<200, 0.5, 0.3>);
Same("CHSV2RGB", C.blue, 0.3)
#declare C = CRGB2HSL(rgb <0.2, 0.5, 0.3>);
Same("CRGB2HSL", C.red, 140)
#declare C = CRGB2HSV(rgb <0.2, 0.5, 0.3>);
Same("CRGB2HSV", C.green, 0.6)
#declare C = Convert_Color("HSL", "HSV", <140, 0.5, 0.5>);
Same("Convert_Color", C.red, 140)
Same("CRGB2H", CRGB2H(rgb <0.2, 0.5, 0.3>, 0.5, 0.3), 140)

// math
#declare F = function (x, y, z) { x*x + y*z }
#declare G = fn_Gradient(F)
#declare H = fn_Gradient_Directional(F, y)
#declare D = fn_Divergence(F, F, F)
#declare A = array[6] {1, 5, 2, 2, 8, -1}
Same("Interpolate", Interpolate(0.5, 0, 1, 0, 10, 2), 2.5)
Same("Mean", Mean(A), 17/6)
Same("Std_Dev", Std_Dev(A, Mean(A)), sqrt(305)/6)
GetStats(A)
Same("GetStats", StatisticsArray[3], 8)
Histogram(A, 3)
Same("Histogram", HistogramArray[0][1], 2)
Close("VSqr", VSqr(<1, 2, 3>), <1, 4, 9>)
Close("VPow", VPow(<1, 2, 3>, 2), <1, 4, 9>)
#declare C = VPow5D(<1, 2, 3, 4, 5>, 2);
Same("VPow5D", C.transmit, 25)
#declare C = VNormalize5D(<0, 0, 0, 0, 5>);
Same("VNormalize5D", C.transmit, 1)
Same("VEq", VEq(x, x), 1)
Same("VEq5D", VEq5D(<1, 2, 3, 4, 5>, <1, 2, 3, 4, 6>), 0)
Same("VZero", VZero(x - x), 1)
Same("VLength5D", VLength5D(<1, 2, 3, 4, 5>), sqrt(55))
Same("VAngleD", VAngleD(x, x + y), 45)
Same("VRotationD", VRotationD(x, y, -z), -90)
Same("VDist", VDist(x, -x), 2)
Close("VPerp_To_Vector", VPerp_To_Vector(x), -y)
Close("VPerp_To_Plane", VPerp_To_Plane(x, y), z)
Close("VPerp_Adjust", VPerp_Adjust(x + y, y), x)
Close("VProject_Plane", VProject_Plane(x + y, y), x)
Close("VProject_Axis", VProject_Axis(x + y, 2*y), y)
Same("VMin", VMin(<3, 1, 2>), 1)
Same("VMax", VMax(<3, 1, 2>), 3)
Close("VWith_Len", VWith_Len(3*x, 2), 2*x)
SetGradientAccuracy(0.001)
Same("fn_Gradient", G(1, 2, 3), sqrt(17))
Same("fn_Gradient_Directional", H(1, 2, 3), 3)
Same("fn_Divergence", D(1, 2, 3), 7)
Close("vGradient", vGradient(F, <1, 2, 3>), <2, 3, 2>)
Close("vCurl", vCurl(F, F, F, <1, 2, 3>), <1, 0, -1>)
Same("Divergence", Divergence(F, F, F, <1, 2, 3>), 7)
Same("Gradient_Length", Gradient_Length(F, <1, 2, 3>), sqrt(17))
Same("Gradient_Directional", Gradient_Directional(F, <1, 2, 3>, y), 3)
#declare C = eval_pigment(pigment { rgb <0.1, 0.2, 0.3> }, <1, 2, 3>);
Same("eval_pigment", C.blue, 0.3)

// transforms
#declare B = box { <1, 2, 3>, <4, 6, 9> }
#declare S = spline { linear_spline -1, -x, 0, <0, 0, 0>, 1, x, 2, 2*x }
Close("Shear_Trans", vtransform(<1, 2, 3>, transform { Shear_Trans(y, z, x) }), <3, 1, 2>)
Close("Matrix_Trans", vtransform(<1, 2, 3>, transform { Matrix_Trans(x, y, z, x) }), <2, 2, 3>)
Close("vinv_transform", vinv_transform(<2, 2, 3>, transform { Matrix_Trans(x, y, z, x) }), <1, 2, 3>)
Close("Axial_Scale_Trans", vtransform(<1, 2, 3>, transform { Axial_Scale_Trans(2*x, 3) }), <3, 2, 3>)
Close("Axis_Rotate_Trans", vtransform(x, transform { Axis_Rotate_Trans(z, 90) }), y)
Close("Rotate_Around_Trans", vtransform(x, transform { Rotate_Around_Trans(180*z, 2*x) }), 3*x)
Close("Reorient_Trans", vtransform(x, transform { Reorient_Trans(x, y) }), y)
Close("Point_At_Trans", vtransform(y, transform { Point_At_Trans(3*z) }), z)
#declare C = object { B Center_Trans(B, x + y) }
Close("Center_Trans", min_extent(C), <-1.5, -2, 3>)
#declare C = object { B Align_Trans(B, -y, <0, 0, 0>) }
Close("Align_Trans", min_extent(C), <1, 0, 3>)
Close("Spline_Trans", vtransform(z, transform { Spline_Trans(S, 0.5, y, 0.1, 0) }), 1.5*x)

// strings and arrays
#if (strcmp(VStr(<1, 2, 3>), concat("<", vstr(3, <1, 2, 3>, ",", 0, -1), ">")) != 0) #error "check_macros: VStr is wrong" #end
#declare T = concat(CRGBStr(Red, 0, 2), CRGBFTStr(Red, 0, 2), Str(1), VStr2D(<1, 2>), Vstr2D(<1, 2>, 0, 2), Vstr(x, 0, 2),
   Triangle_Str(x, y, z), Smooth_Triangle_Str(x, x, y, y, z, z));
Same("Parse_String", Parse_String("1 + 2*3"), 7)
Sort_Array(A)
Reverse_Array(A)
Same("Sort_Array", A[0], 8)
Sort_Partial_Array(A, 1, 3)
Same("Sort_Partial_Array", A[1], 2)
Resize_Array(A, 9)
Same("Resize_Array", dimension_size(A, 1), 9)
#declare A = array[2][2][2] {{{0, 1}, {1, 0}}, {{0, 1}, {0, 1}}}
ARRAYS_WriteDF3(A, "check.df3", 8)

// rand: the mean of many
#declare R = seed(1);
#declare A = array[1] {5}
Same("Rand_Array_Item", Rand_Array_Item(A, R), 5)
#declare N = 400;
#macro Average(Name, Expected, Tolerance, Macro)
   #local Sum = 0;
   #local I = 0;
   #while (I < N)
      #local Sum = Sum + Parse_String(Macro)/N;
      #local I = I + 1;
   #end
   #if (abs(Sum - (Expected)) > Tolerance) #error concat("check_macros: the mean of ", Name, " is ", str(Sum, 0, 3)) #end
#end
Average("SRand", 0, 0.2, "SRand(R)")
Average("RRand", 3.5, 0.2, "RRand(2, 5, R)")
Average("Rand_Normal", 1, 0.4, "Rand_Normal(1, 2, R)")
Average("Rand_Gauss", 1, 0.4, "Rand_Gauss(1, 2, R)")
Average("Rand_Gamma", 7.5, 1, "Rand_Gamma(2.5, 3, R)")
Average("Rand_Beta", 0.4, 0.1, "Rand_Beta(2, 3, R)")
Average("Rand_Chi_Square", 4, 1, "Rand_Chi_Square(4, R)")
Average("Rand_Tri", 2, 0.2, "Rand_Tri(0, 4, 2, R)")
Average("Rand_Erlang", 6, 1, "Rand_Erlang(2, 3, R)")
Average("Rand_Exp", 0.5, 0.1, "Rand_Exp(2, R)")
Average("Rand_Bernoulli", 0.3, 0.1, "Rand_Bernoulli(0.3, R)")
Average("Prob", 0.3, 0.1, "Prob(0.3, R)")
Average("Rand_Binomial", 3, 0.3, "Rand_Binomial(10, 0.3, R)")
Average("Rand_Geo", 7/3, 0.7, "Rand_Geo(0.3, R)")
Average("Rand_Poisson", 4, 0.4, "Rand_Poisson(3, R)")
Average("Rand_Weibull", 2*0.893, 0.3, "Rand_Weibull(2, 3, R)")
#declare C = Rand_Cauchy(1, 2, R) + Rand_Student(4, R) + Rand_F_Dist(3, 4, R) + Rand_Lognormal(1, 0.5, R) + Rand_Pareto(2, R) + Rand_Spline(S, R);
#declare C = VRand(R) + VRand_In_Box(x, y, R) + VRand_In_Sphere(R) + VRand_In_Obj(B, R);
Same("VRand_On_Sphere", vlength(VRand_On_Sphere(R)), 1)

// shapes
#declare P = <0, 0, 0>;
#declare Q = <0, 0, 0>;
Same("Isect", Isect(<2, 3, 0>, z, B, P), 1)
Same("IsectN", IsectN(<2, 3, 0>, z, B, P, Q), 1)
Close("IsectN", Q, -z)
Extents(B, P, Q)
Close("Extents", Q, <4, 6, 9>)
union {
   Center_Object(B, x) Align_Object(B, x, y) Wedge(50) Wedge(180) Wedge(230) Spheroid(x, <1, 2, 3>)
   Supertorus(1, 0.4, 0.5, 0.3, 0.01, 2) Supercone(-y, 1, 0.5, y, 0.3, 0.8) Connect_Spheres(x, 1, 5*x, 2)
   Wire_Box_Union(-x, x + y + z, 0.1) Wire_Box_Merge(-x, x + y + z, 0.1) Wire_Box(-x, x + y + z, 0.1, 0)
   Round_Box_Union(-x, x + y + z, 0.1) Round_Box_Merge(-x, x + y + z, 0.1) Round_Box(-x, x + y + z, 0.5, 0)
   Round_Cylinder_Union(-x, x, 1, 0.1) Round_Cylinder_Merge(-x, x, 1, 0.1) Round_Cylinder(-x, x, 0.5, 0.5, 0)
   Round_Cone_Union(-x, 1, x, 0.5, 0.1) Round_Cone_Merge(-x, 1, x, 0.5, 0.1) Round_Cone(-x, 0.2, x, 0.5, 0.1, 0)
   Round_Cone2_Union(-x, 1, x, 0.5) Round_Cone2_Merge(-x, 1, x, 0.5) Round_Cone2(-x, 0.2, x, 0.5, 0)
   Round_Cone3_Union(-x, 1, x, 0.5) Round_Cone3_Merge(-x, 1, x, 0.5) Round_Cone3(-x, 0.2, x, 0.5, 0)
   mesh { Quad(0*x, x, x + y, y) Smooth_Quad(0*x, z, x, z, x + y, z, y, z) }
   HF_Square(F, 1, 1, <5, 5>, 1, "", -1, <1, 1, 1>) HF_Sphere(F, 1, 0, <5, 5>, 0, "", 0, 1, 0.2)
   HF_Cylinder(F, 1, 0, <5, 5>, 1, "", -y, y, 1, 0.2) HF_Torus(F, 1, 1, <5, 5>, 0, "", 1, 0.3, 0.2)
   pigment { rgb 1 }
}
HF_Square(F, 1, 0, <2, 2>, 1, "check.mesh", -1, <1, 1, 1>)
mesh { #include "check.mesh" pigment { rgb 1 } }

// textures, glass, debug, the sun and the screen
sphere { 0, 1 pigment { Irregular_Bricks_Ptrn(0.1, 1, 0.5, 0.5) } }
sphere { 0, 1 pigment { Tiles_Ptrn() } }
sphere { 0, 1 pigment { Hex_Tiles_Ptrn() } }
sphere { 0, 1 pigment { Star_Ptrn(1, 5, 2) } interior { I_Glass_Exp(1) } }
sphere { 0, 1 pigment { rgbf 1 } interior { I_Glass_Sqr(1) } }
Debug_Inc_Stack()
Set_Debug(false)
Debug_Message("no")
Debug(false, "no")
Warning(false, "no")
Error(false, "no")
Close("SunPos", vnormalize(SunPos(2000, 6, 21, 12, 2, 0, 51.4667, 0)*x), vnormalize(SolarPosition.x*x))
Set_Camera(<0, 0, -9>, <0, 0, 0>, 50)
Set_Camera_Location(<0, 0, -8>)
Set_Camera_Look_At(x)
Set_Camera_Aspect(4, 3)
Set_Camera_Aspect_Ratio(1)
Set_Camera_Sky(y)
Set_Camera_Zoom(1)
Set_Camera_Angle(60)
Screen_Object(sphere { 0, 0.1 pigment { rgb 1 } }, <0, 0>, 0.02, true, 0.01)
Screen_Plane(texture { pigment { rgb 1 } }, 0.01, <0, 0>, <0.1, 0.1>)
Reset_Camera()
global_settings { radiosity { Rad_Settings(Radiosity_Debug, off, off) } }
