//! Flat primitives and what is built of them: triangles, polygons, meshes, and solids bounded by them.
//!
//! All of them decide hits in the ray's own projection ([`RayShear`]), where a corner that several pieces share has one and the
//! same image. No ray slips through between two pieces.

mod axes;
mod brep;
#[cfg(test)]
mod brep_tests;
mod closed;
#[cfg(test)]
mod crack_tests;
mod data;
mod edge_runs;
mod indexed;
mod inside_map;
mod pass;
mod polygon;
#[cfg(test)]
mod polygon_tests;
#[cfg(test)]
pub(crate) mod samples;
mod shear;
mod triangle;
mod triangulate;
mod walk;

pub use brep::Brep;
pub use data::MeshData;
pub use indexed::TriangleMesh;
pub use polygon::{PlaneHit, Polygon, fan_triangles};
pub(crate) use shear::{Axis, LOST_DIGITS, intersect_sheared};
pub use shear::{RayShear, TriangleHit, intersect_triangle};
pub(crate) use triangle::combine;
pub use triangle::{SmoothTriangle, Triangle};
pub use triangulate::triangulate;
