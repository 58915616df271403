//! Real roots of polynomials.
//!
//! * [`quadratic`]: both roots without cancellation.
//! * [`Bernstein`]: all roots of a polynomial of any small degree on an interval, by sign variations in Bernstein
//!   form; no allocation, ascending, with rounding errors accounted for.
//! * [`find_root`]: the root of any function in a bracket, to the last bit; [`find_crossing`]: the same without derivatives.
//! * [`newton`]: that of a smooth function, with fewer calls; [`newton_of_four`]: of four side by side.

mod bernstein;
mod bracket;
mod newton;
mod quadratic;

pub use bernstein::{Bernstein, FourBernsteins, Isolated, RootCount, Roots, Window};
pub use bracket::{find_crossing, find_crossing_until, find_root};
pub use newton::{newton, newton_of_four};
pub use quadratic::quadratic;
