//! Shapes swept by curves: prisms, letters, lathes, surfaces of revolution, and sphere sweeps.
//!
//! The curves consist of Bézier pieces of degree 3 at most, under a hierarchy of boxes along the curve, so that a ray tests few
//! of many pieces.

mod curve;
mod extrusion;
mod four_rays;
mod glyph;
mod hyperbola;
mod lathe;
mod meridian;
mod outline;
mod prism;
mod revolution;
mod round;
mod runs;
mod sextic;
mod sor;
mod spans;
mod sphere_sweep;
mod turned;
#[cfg(test)]
mod zoom_tests;

pub use curve::Spline;
pub(crate) use four_rays::{FourFirstHits, FourHits};
pub use glyph::Glyph;
pub use lathe::Lathe;
pub use outline::{Outline, OutlineBuilder};
pub use prism::{CLOSING_DISTANCE, Prism, PrismSweep};
pub use sor::Sor;
pub use sphere_sweep::{SphereSweep, SweepSpline};
