//! Free-form surfaces: patches of polynomials or rational functions in two parameters.

mod bezier;
mod bicubic;
mod border;
#[cfg(test)]
mod border_tests;
mod degree;
mod elements;
mod frame;
mod graze;
mod hull;
mod leaf;
mod net;
mod newton;
mod nurbs;
mod piece;
mod search;
mod settle;
#[cfg(test)]
mod shadow;
mod subdivision;
#[cfg(test)]
mod tests;
mod tree;
mod winding;

pub use bicubic::BicubicPatch;
pub use nurbs::{Nurbs, NurbsBrep, NurbsCurve, NurbsData, TrimLoop};
pub use subdivision::{Subdivision, SubdivisionData, SubdivisionScheme};
