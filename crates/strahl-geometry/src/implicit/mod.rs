//! Surfaces given by data or functions: height fields, isosurfaces of functions and of samples, parametric surfaces.

mod container;
mod grid_isosurface;
mod height_field;
mod isosurface;
mod octree;
mod parametric;
mod slopes;
mod workspace;

pub use container::Container;
pub(crate) use container::Passage;
pub use grid_isosurface::{GridIsosurface, GridOptions};
pub use height_field::HeightField;
pub use isosurface::{Isosurface, IsosurfaceOptions};
pub(crate) use octree::{Cell, Content, Octree, Visitor};
pub use parametric::{Parametric, ParametricOptions};
use strahl_math::Interval;

/// The rough range of a search that finds all crossings exactly: no parameter is in it. Of crossings in a rough range an approximate place is
/// enough.
pub(crate) const EXACT: Interval = Interval {
    min: f64::INFINITY,
    max: f64::NEG_INFINITY,
};
