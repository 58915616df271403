//! Surfaces given by data or functions: height fields, isosurfaces and parametric surfaces.

mod container;
mod height_field;
mod isosurface;
mod octree;
mod parametric;
mod workspace;

pub use container::Container;
pub(crate) use container::Passage;
pub use height_field::HeightField;
pub use isosurface::{Isosurface, IsosurfaceOptions};
pub(crate) use octree::{Octree, Visitor};
pub use parametric::{Parametric, ParametricOptions};
