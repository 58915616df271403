//! Sets defined by iterated functions.

mod julia;

pub use julia::{HypercomplexFunction, Julia, JuliaAlgebra, JuliaOptions, QuaternionFunction};
