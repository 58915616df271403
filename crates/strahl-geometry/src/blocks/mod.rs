//! Four primitives of a kind side by side, for the leaves of an accelerator: one sequence of vector instructions finds those
//! that a ray may hit.
//!
//! Where a block decides, it performs the operations of the primitive's own test in the same order, so the results have the
//! same bits.

pub(crate) mod convex;
mod packet;
mod polygons;
mod spheres;
mod triangles;

pub use convex::{PacketRays, PacketSearch, PacketSpans};
pub use packet::{PacketLines, PacketShears};
pub use polygons::{PlaneHits, PolygonBlock};
pub use spheres::SphereBlock;
pub use triangles::{Coordinate, TriangleBlock};

use strahl_simd::Isa;

/// Primitives in a block.
pub const LANES: usize = strahl_accel::BLOCK;

/// The hits of a ray on the primitives of a block; the values of lanes without a hit have no meaning.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hits {
    /// Ray parameters.
    pub t: [f64; LANES],
    /// The primitives' own two numbers.
    pub uv: [[f64; LANES]; 2],
}

/// The scalar product, with the terms added in the order of the scalar code.
#[inline(always)]
pub(crate) fn dot<I: Isa>(isa: I, p: [I::F64x4; 3], q: [I::F64x4; 3]) -> I::F64x4 {
    let xy = isa.add(isa.mul(p[0], q[0]), isa.mul(p[1], q[1]));
    isa.add(xy, isa.mul(p[2], q[2]))
}
