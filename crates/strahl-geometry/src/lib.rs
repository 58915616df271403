//! Surfaces and solids, and their exact intersections with rays.
//!
//! * [`Primitive`]: anything a ray can hit. [`Solid`]: a primitive with an inside; what CSG combines.
//! * [`Shape`]: the table of all shapes, one enum generated from it.
//! * [`Csg`]: several solids combined into one, by trees of any depth.
//! * [`mod@conformance`]: tests that every primitive must pass.

pub mod algebraic;
pub mod blocks;
mod bounded;
pub mod conformance;
pub mod csg;
pub mod fractal;
pub mod implicit;
pub mod mesh;
pub mod patch;
mod primitive;
pub mod primitives;
mod shape;
mod spans;
pub mod swept;

pub use algebraic::*;
pub use bounded::Bounded;
pub use csg::*;
pub use fractal::*;
pub use implicit::*;
pub use mesh::*;
pub use patch::*;
pub use primitive::{GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint};
pub use primitives::*;
pub use shape::Shape;
pub use spans::{Crossing, Crossings, Side};
pub use swept::*;
