//! Four primitives of a kind side by side, for the leaves of an accelerator: one pass of vector instructions finds out which of
//! them a ray may hit.
//!
//! Where a block decides, it computes what the primitive's own test computes, operation by operation, so the answers have the
//! same bits.

mod spheres;
mod triangles;

pub use spheres::SphereBlock;
pub use triangles::{Coordinate, TriangleBlock};

/// Primitives in a block.
pub const LANES: usize = strahl_accel::BLOCK;
