// Space subdivision: a ray visits only the cells along its way, and ends at the first hit inside of the current cell.
//
// The scene walks a grid itself, in the manner of a 3-D Bresenham: from cell to cell through the face that is left first, the smallest
// t_k = (-D_k - n_k.p) / (n_k.d). The cells that the ray visits are drawn as glass; of all balls only those in them are tested (red).
//
//     strahl trace-ray scenes/lecture/12_space_subdivision.pov --size 320x180 --pixel 200,90 --accelerator grid
//     strahl trace-ray scenes/lecture/12_space_subdivision.pov --size 320x180 --pixel 200,90 --accelerator octree:traversal=trial-plane
//     strahl compare scenes/lecture/12_space_subdivision.pov --size 160x90 --sampling center --with list --with grid --with octree
//
// print the cells along the way of a primary ray, with the face by which it leaves each and the objects tested in it, and the costs of the
// structures for all rays. The trial exit plane is the one perpendicular to the largest component of d; `region` says where the ray meets it:
// 0 inside the cell's face, 1 to 4 beyond an edge, 5 to 8 beyond a corner.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { orthographic location <-5, 6.5, -9> right 7.6 * x * image_width / image_height up 7.6 * y look_at <3, 1.3, 1.8> }
light_source { <-8, 14, -10>, rgb 1 }
background { srgb <0.94, 0.95, 0.97> }

#declare From = <-0.9, 0.35, 0.25>;
#declare D = vnormalize(<1, 0.30, 0.42>);
#declare Cells = <6, 3, 4>;

// The cell that the ray enters first, and the parameters at which it crosses the next planes.
#declare T = (0 - From.x) / D.x;
#declare P = From + T * D;
#declare Cell = <0, int(P.y), int(P.z)>;
#declare Next = <T + 1 / D.x, T + (Cell.y + 1 - P.y) / D.y, T + (Cell.z + 1 - P.z) / D.z>;
#declare Step = <1 / D.x, 1 / D.y, 1 / D.z>;
#declare Visited = array[6][3][4];
#for (I, 0, 5) #for (J, 0, 2) #for (K, 0, 3) #declare Visited[I][J][K] = 0; #end #end #end

#while (Cell.x < Cells.x & Cell.y < Cells.y & Cell.z < Cells.z)
  #declare Visited[Cell.x][Cell.y][Cell.z] = 1;
  box {
    Cell + 0.01, Cell + 0.99
    pigment { rgbt <0.30, 0.60, 0.85, 0.72> }
    finish { ambient 0.15 diffuse 0.6 }
    no_shadow
  }
  #if (Next.x <= Next.y & Next.x <= Next.z)
    #declare Cell = Cell + x;
    #declare Next = Next + Step.x * x;
  #else
    #if (Next.y <= Next.z)
      #declare Cell = Cell + y;
      #declare Next = Next + Step.y * y;
    #else
      #declare Cell = Cell + z;
      #declare Next = Next + Step.z * z;
    #end
  #end
#end

// Balls in some of the cells.
#declare Dice = seed(11);
#for (I, 0, 5)
  #for (J, 0, 2)
    #for (K, 0, 3)
      #if (rand(Dice) < 0.42)
        sphere {
          <I + 0.5, J + 0.5, K + 0.5>, 0.16
          pigment { #if (Visited[I][J][K]) srgb <0.90, 0.20, 0.12> #else srgb <0.72, 0.73, 0.76> #end }
          finish { ambient 0.15 diffuse 0.7 phong 0.4 phong_size 30 }
        }
      #end
    #end
  #end
#end

// The edges of the grid, and the ray.
union {
  #for (J, 0, 3) #for (K, 0, 4) cylinder { <0, J, K>, <6, J, K>, 0.012 } #end #end
  #for (I, 0, 6) #for (K, 0, 4) cylinder { <I, 0, K>, <I, 3, K>, 0.012 } #end #end
  #for (I, 0, 6) #for (J, 0, 3) cylinder { <I, J, 0>, <I, J, 4>, 0.012 } #end #end
  pigment { srgb <0.45, 0.48, 0.55> }
  finish { ambient 0.3 diffuse 0.5 }
  no_shadow
}
union {
  cylinder { From, From + 8.2 * D, 0.04 }
  cone { From + 8.2 * D, 0.12, From + 8.6 * D, 0 }
  pigment { srgb <0.95, 0.65, 0.05> }
  finish { ambient 0.5 diffuse 0.5 }
  no_shadow
}
plane { y, -0.02 pigment { srgb <0.92, 0.92, 0.91> } finish { ambient 0.15 diffuse 0.75 } }
