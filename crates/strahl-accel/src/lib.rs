//! Acceleration structures: they find the primitives that a ray may meet, nearest first where they can.
//!
//! This crate knows boxes and ids, no shapes. Every structure keeps one promise, the **conservative culling contract**:
//! it may skip a primitive only if the ray certainly misses the primitive's box within the current range, or if that box
//! certainly starts behind `t_max` (a box that starts exactly at `t_max` is visited: ties are decided by ids, not by the order
//! of visits). Hence the choice of structure changes the speed, never the picture.

mod any;
mod beam;
mod boxes;
mod bvh;
mod bvh8;
mod cells;
mod cull;
mod grid;
mod leaf;
mod list;
mod moved;
mod octree;
mod packet;
mod parameters;
mod shapes;
mod sixteen;
mod spheres;
mod traversal;
mod walk;

pub use any::{AcceleratorKind, AnyAccelerator, UnknownAccelerator};
pub use beam::Beam;
pub use bvh::{BuildOptions, Bvh2};
pub use bvh8::{Build, Bvh8, Bvh8Parameters, Content};
pub use grid::{Grid, GridParameters, Grids};
pub use leaf::{BLOCK, Leaf, NO_PRIMITIVE};
pub use list::List;
pub use octree::{Octree, OctreeParameters, Split, Traversal};
pub use packet::{PACKET, Packet, PacketVisitor, lanes_of};
pub use parameters::{NoParameters, Parameter, Parameters};
pub use shapes::{Boxes, Shapes, cut_box};
pub use sixteen::{SIXTEEN_REACH, SixteenBoxes, SixteenSlabs};
pub use spheres::{Grouping, Spheres, SpheresParameters};
pub use strahl_simd::{Level, UnknownLevel};
pub use traversal::{Accelerator, Exit, Place, Step, TraversalStats, Visitor};
