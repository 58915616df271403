#declare P=pigment{bozo color_map{[0 rgb 0][0.5 color rgbt <1,0,0,0.5>][1 rgb 1]} turbulence 0.5 octaves 3 scale 2 warp{repeat x flip y}}
#declare T=texture{pigment{P} normal{bumps 0.3 slope_map{[0 <0,1>][1 <1,0>]}} finish{phong 1 reflection{0.1,1 fresnel on} ambient rgb 0.2}}
#default{finish{ambient 0.1}}
sphere{0,1 texture{checker texture{T} texture{pigment{brick rgb 1,rgb 0 mortar 0.1}}}}
box{0,1 texture{gradient x texture_map{[0 T][1 pigment{rgb 1}]}} texture{pigment{rgbf <1,1,1,0.9>}} interior{ior 1.5 fade_distance 1 fade_power 2}}
plane{y,0 pigment{average pigment_map{[1 P][2 wood]}} normal{average normal_map{[1 ripples][2 facets]}} material{texture{T}}}
sphere{0,1 pigment{function{sin(x)*f_noise3d(x,y,z)} color_map{[0 rgb 0][1 rgb 1]}} finish{irid{0.3}}}
fog{distance 10 rgb 1} sky_sphere{pigment{gradient y}} background{rgb 0.1}
camera{location -5*z look_at 0 angle 40 right x*4/3} light_source{<1,2,-3>,1 area_light x,y,3,3 adaptive 1 jitter spotlight point_at 0 radius 5}
global_settings{assumed_gamma 1 max_trace_level 5}
