//! Sets that iterated functions make.

mod julia;

pub use julia::{HypercomplexFunction, Julia, JuliaAlgebra, JuliaOptions, QuaternionFunction};
