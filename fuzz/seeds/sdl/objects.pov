sphere{0,1 translate x} box{-1,1 rotate 30*y} cone{0,1,y,0.5 open} torus{1,0.3} plane{y,-1 hollow} disc{0,y,1,0.5}
#declare A=union{sphere{0,1} cylinder{0,y,0.3} scale 2}
difference{object{A} box{0,2 inverse} clipped_by{plane{x,0}} bounded_by{clipped_by} no_shadow}
intersection{object{A rotate z} merge{object{A} sphere{x,1}} pigment{rgb 1} interior{ior 1.5}}
mesh{triangle{0,x,y} smooth_triangle{0,z,x,z,y,z texture{pigment{rgb 1}}} inside_vector z}
mesh2{vertex_vectors{3,<0,0,0>,<1,0,0>,<0,1,0>} normal_vectors{3,z,z,z} uv_vectors{3,<0,0>,<1,0>,<0,1>} texture_list{1,texture{pigment{rgb x}}} face_indices{1,<0,1,2>,0}}
polygon{4,<0,0>,<1,0>,<0,1>,<0,0>} quadric{<1,1,1>,<0,0,0>,<0,0,0>,-1} light_group{light_source{0,1} object{A} global_lights off}
#debug str(inside(A,<0,0,0>),0,0) #declare N=x; #debug vstr(3,trace(A,<0,5,0>,-y,N),",",0,3) #debug vstr(3,max_extent(A),",",0,3)
