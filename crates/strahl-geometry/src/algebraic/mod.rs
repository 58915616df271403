//! Algebraic surfaces: where a polynomial of any degree, or a sum of them, vanishes.
//!
//! All of them substitute the ray into the polynomial and isolate the roots of the result in Bernstein form
//! ([`strahl_math::roots::Bernstein`]): certified, ascending, without the tolerances of Sturm sequences.

mod blob;
mod event;
mod extent;
mod gauge;
mod line;
mod polynomial;
mod superellipsoid;
mod terms;

pub(crate) use blob::Pieces;
pub use blob::{Blob, BlobComponent};
pub(crate) use event::{Event, Question};
pub use polynomial::Polynomial;
pub use superellipsoid::Superellipsoid;
