#version 3.7;
#declare A=array[2][2]{{1,2},{3,4}} #declare D=dictionary{.a:1,["b"]:x} #declare S=spline{cubic_spline 0,<0,0,0>,1,<1,2,3>,2,<0,1,0>}
#declare F=function(x,y){select(x,y,0,1)+sum(i,1,3,i*x)+max(x,y)} #debug str(F(1,2),0,3) #debug vstr(3,S(0.5),",",0,3)
#declare R=seed(1); #for(I,0,3,1) #declare A[mod(I,2)][0]=rand(R); #end
#macro M(X,optional Y) #ifdef(local.Y) #local Z=Y; #else #local Z=X; #end Z*2 #end #declare B=M(1,); #undef B
#switch(A[0][0]) #case(1) #debug "one" #break #range(2,3) #debug "more" #else #debug concat("a",chr(66),str(1.5,5,-1)) #end
#fopen H "o.txt" write #write(H,1,",",<1,2,3>,",\"s\"") #fclose H #fopen H "o.txt" read #while(defined(H)) #read(H,Q) #end #fclose H
#declare (U,V)=(1,2); #if(strcmp("a","b")<0 & !(1=2) | 0) #warning "x" #end #include "a.inc"
#debug substr("abcdef",2,3) #debug vstr(5,vrotate(<1,2,3>,45*y)+vcross(x,y)*vlength(z)," ",3,2) #declare X=(A[1][1]>2?x.y:pi);
