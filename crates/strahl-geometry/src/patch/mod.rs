//! Free-form surfaces: patches of polynomials or rational functions in two parameters.

mod bezier;
mod bicubic;
mod border;
#[cfg(test)]
mod border_tests;
mod net;
mod nurbs;
mod search;
mod settle;
#[cfg(test)]
mod tests;
mod tree;

pub use bicubic::BicubicPatch;
pub use nurbs::{Nurbs, NurbsCurve, NurbsData, TrimLoop};
