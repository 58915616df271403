//! Mathematical functions of points: built as a graph, compiled to a tape, evaluated at points, over batches of points,
//! over boxes (with an outward-rounded interval as result), on lines through boxes (with bounds of the derivative along them) and
//! with their gradient.
//!
//! * [`Graph`] builds a function of named parameters; [`Expr`] is a value in it.
//! * [`Function`] is the compiled function, [`Workspace`] the memory its evaluations use.
//! * [`Bounds`] is an interval that may contain NaN.
//! * [`internal`] has the functions of POV-Ray's `functions.inc`.
//! * [`ScalarField`] is what a function calls without knowing its formula: patterns, pigments, splines.
//!
//! A function means what POV-Ray 3.7's `function { }` means, measured with that program: comparisons are exact, anything but
//! zero is true, `select` takes NaN for positive, `mod` has the sign of the dividend, domain errors give NaN.
//!
//! Nothing runs without end: one evaluation takes at most so many operations as [`Graph::allow`] says. What takes more for
//! certain can't be built; a loop whose length is known only when it runs and that would take more is NaN.
//!
//! All ways to evaluate run the same instructions, so the value of a batch or of a gradient has the bits of the
//! value at the point, and bounds contain it. Transcendental functions are those of [`strahl_math::det`].

mod bounds;
mod build;
mod compile;
mod cost;
mod domain;
mod error;
mod field;
mod function;
mod graph;
pub mod internal;
pub mod limits;
mod op;
mod polynomial;
mod rate;
mod rounding;
mod run;
mod tape;

pub use bounds::Bounds;
pub use cost::Cost;
pub use error::FunctionError;
pub use field::{Rates, ScalarField};
pub use function::{Function, Workspace};
pub use graph::{Expr, Graph};
pub use op::{BinaryOp, UnaryOp};
pub use polynomial::{Region, Terms};
pub use rate::Rate;
