//! Shapes swept by curves: prisms, letters, lathes, surfaces of revolution, and what spheres cover on their way.
//!
//! The curves are pieces of degree 3 at most in Bézier form, kept under a hierarchy of boxes along the curve, so that a ray
//! looks at few of many pieces.

mod curve;
mod extrusion;
mod glyph;
mod lathe;
mod meridian;
mod outline;
mod prism;
mod revolution;
mod round;
mod runs;
mod sor;
mod spans;
mod sphere_sweep;
mod turned;

pub use curve::Spline;
pub use glyph::Glyph;
pub use lathe::Lathe;
pub use outline::{Outline, OutlineBuilder};
pub use prism::{Prism, PrismSweep};
pub use sor::Sor;
pub use sphere_sweep::{SphereSweep, SweepSpline};
