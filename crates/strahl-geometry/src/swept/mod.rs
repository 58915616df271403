//! Shapes swept by curves: prisms and letters.
//!
//! The curves are pieces of degree 3 at most in Bézier form, kept under a hierarchy of boxes along the curve, so that a ray
//! looks at few of many pieces.

mod curve;
mod extrusion;
mod glyph;
mod outline;
mod prism;
mod runs;
mod spans;

pub use curve::Spline;
pub use glyph::Glyph;
pub use outline::{Outline, OutlineBuilder};
pub use prism::{Prism, PrismSweep};
