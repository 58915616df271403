//! Sets defined by iterated functions, and terrains.

mod julia;
mod mandelbulb;
mod march;
mod menger;
mod orbit_search;
mod orbit_set;
mod terrain;

pub use julia::{HypercomplexFunction, Julia, JuliaAlgebra, JuliaOptions, QuaternionFunction};
pub use mandelbulb::Mandelbulb;
pub use menger::Menger;
pub use terrain::{Terrain, TerrainDetail, TerrainKind, TerrainOptions};
