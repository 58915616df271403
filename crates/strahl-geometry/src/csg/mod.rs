//! Constructive solid geometry: trees of solids, of any depth.
//!
//! A ray sees a solid as a list of spans (Roth, "Ray casting for modeling solids", 1982). A tree asks its leaves for their
//! [`Crossings`](crate::Crossings), and every operation combines the sorted lists of its operands in one sweep; no hit is
//! ever tested against the other operands point by point.
//!
//! * [`CsgNode`] describes a tree, [`Csg`] is the compiled tree: inversions pushed down to the leaves, nested equal operations
//!   flattened, everything in flat lists that are traversed without recursion.
//! * `compile` makes the one from the other, `evaluate` traverses the tree for a ray, `sweep` combines lists, `half_spaces`
//!   intersects all planes of an intersection in one pass.
//! * `first` finds the first surface without lists, if no two crossings are close together: `course` finds the crossings that
//!   matter, `timeline` goes through them. `small` does the same for trees of a few simple leaves,
//!   with a `table` of their `states`, `one_span` for intersections and `merged` for merges among them; `packet` searches
//!   those of convex solids for four rays side by side, `together` tests boxes and leaves of larger ones and of merges for the rays of a packet,
//!   `lines` combines them ray by ray.

mod boxes;
mod compile;
mod course;
mod evaluate;
mod first;
mod half_spaces;
mod leaf;
mod lines;
mod merged;
mod one_span;
mod packet;
mod small;
mod solid;
mod states;
mod sweep;
mod table;
mod tighten;
mod timeline;
mod together;
mod tree;
mod within;

pub use solid::Csg;
pub use together::{PacketRanges, PacketTree};
pub use tree::{CsgNode, Operands};

pub(crate) use evaluate::Workspace;

#[cfg(test)]
mod first_tests;
#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod gem_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod together_tests;
